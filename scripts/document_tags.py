#!/usr/bin/env python3
"""Write docs/tags.md from what quadcore itself says of its plugins, worlds and logs.

``scripts/document`` runs it. With --print the page goes to standard output instead.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Iterator

from markdown_table import table

import quadcore as qc
from quadcore import _core
from quadcore.model import resources
from quadcore.model.description import load_description

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "tags.md"

INTRODUCTION = """\
<!-- Written by scripts/document from the package's own tables: change those, not this file. -->
# Tags, worlds, engines, logs

`quadcore info MODEL` prints the tables of a model's own plugins with the values in effect and where
each was set. The force laws behind the tags, with their signs, frames and points of application,
are in [physics.md](physics.md). Equation numbers and A.4-A.6 are those of the thesis.

A tag that a plugin does not know, a repeated tag, a missing required tag, a value that is no finite
number or lies outside its range is an error that names file, line, plugin, tag and the nearest
known tag. `--set PLUGIN.TAG=VALUE` (Python: `parameters={"PLUGIN.TAG": value}`) overrides the URDF;
PLUGIN is the `name` attribute of the plugin tag. In the same place `LINK.mass`, `LINK.ixx`, `ixy`,
`ixz`, `iyy`, `iyz` and `izz` are what the link's `<inertial>` says (kg, kg m^2), and `xacro.ARG` an
argument of a xacro model; a name that two of these go by is an error.
"""

LOG = {
    "t": ("s", "time; the row at t is the state after the step that ends at t"),
    "x y z": ("m", "origin of the frame link, world axes"),
    "qx qy qz qw": ("", "orientation of the frame link in the world, unit quaternion"),
    "vx vy vz": ("m/s", "velocity of the frame link's origin, world axes"),
    "wx wy wz": ("rad/s", "angular velocity of the frame link, its own axes"),
    "j1 ... jn": ("rad/s", "velocity of each rotor joint as the engine has it, file order"),
}

WORLDS = {
    "empty": "Gazebo's defaults without ground; what there is unless another is named",
    "default": "the thesis': Gazebo's defaults with ground",
    "basic": "RotorS': ground, steps of 10 ms, a thousand sweeps of the solver",
}


def plugin_sections(*simulations: qc.Simulation) -> Iterator[str]:
    """One section for each module of the simulations' plugins."""
    told = set()
    plugins = (plugin for simulation in simulations for plugin in simulation.plugins)
    for plugin in sorted(plugins, key=lambda plugin: plugin.name):
        if plugin.filename in told:
            continue
        told.add(plugin.filename)
        yield f"\n## {plugin.filename}\n\n{_sentence(plugin.summary)}\n\n"
        yield table(
            ("tag", "unit", "default", "range", "meaning", "equation"),
            (
                (
                    f"`{tag.name}`" + (f" (also `{tag.alias}`)" if tag.alias else ""),
                    tag.unit,
                    "required" if tag.default is None else tag.default,
                    tag.range,
                    tag.meaning,
                    tag.equation,
                )
                for tag in plugin.parameters
            ),
        )


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:] + "."


def unfelt_section() -> str:
    """Tabulate what is passed over."""
    everything = _core.everything_unfelt()
    elements = ((f"`<{u.name}>`", f"`<{u.parent}>`", u.what) for u in everything if u.parent)
    modules: dict[str, list[str]] = {}
    for unfelt in everything:
        if not unfelt.parent:
            modules.setdefault(unfelt.what, []).append(f"`{unfelt.name}`")
    return (
        "\n## Seen or sensed\n\n"
        "What no vehicle feels is passed over with one warning that names all of it, see\n"
        "[models.md](models.md#models-made-for-gazebo). Elements, by the document and the element\n"
        "that they stand in:\n\n"
        + table(("element", "in", "what it is"), elements)
        + "\nModules of Gazebo, where no library of that name lies in a plugin folder:\n\n"
        + table(("what it tells", "modules"), ((k, ", ".join(v)) for k, v in modules.items()))
    )


def reference_section() -> str:
    """Tabulate what a <gazebo reference> may hold."""
    tags = _core.gazebo_tags()
    felt = (
        (f"`{tag.name}`", tag.of, tag.unit, tag.default, tag.range, tag.meaning)
        for tag in tags
        if tag.felt_by
    )
    unfelt = ((f"`{tag.name}`", tag.of, tag.range, tag.meaning) for tag in tags if not tag.felt_by)
    return (
        "\n## Tags of `<gazebo reference>`\n\n"
        "Felt by the engines `gazebo11` and `ode`. Of the first eight, those of contact, `eigen`\n"
        "feels `mu1`, `mu2`, `fdir1` and a `kp` that is softer than its springs; of the others it\n"
        "warns. It refuses `dampingFactor` and `turnGravityOff`. A value is the element's text or\n"
        "its attribute `value`. What a reference to a lumped link does:\n"
        "[models.md](models.md#lumping).\n\n"
        + table(("tag", "of a", "unit", "default", "range", "meaning"), felt)
        + "\nWithout effect, as in Gazebo, within the range given:\n\n"
        + table(("tag", "of a", "range", "why"), unfelt)
    )


def world_section() -> str:
    """Tabulate what a world may hold, and the shipped worlds."""
    if set(WORLDS) != set(resources.shipped("worlds")):
        sys.exit(f"worlds: described are {list(WORLDS)}")
    rows = ((f"`{e.name}`", e.unit, e.default, e.range, e.meaning) for e in _core.world_elements())
    return (
        "\n## Worlds\n\n"
        "An SDF file with one `<world>`. Of it these elements are read; any other is an error\n"
        "that names it, unless [nothing feels it](#seen-or-sensed).\n\n"
        + table(("element", "unit", "default", "range", "meaning"), rows)
        + "\nShipped, and known by name:\n\n"
        + table(("world", "what it is"), ((f"`{name}`", what) for name, what in WORLDS.items()))
    )


def engine_section() -> str:
    """Tabulate the engines, the default first."""
    rows = ((f"`{name}`", summary) for name, summary in qc.engines())
    return (
        "\n## Engines\n\n"
        "Chosen by `--engine` (Python: `engine=`); the first is the default. How they work:\n"
        "[engines.md](engines.md).\n\n" + table(("engine", "what it is"), rows)
    )


def log_section(simulation: qc.Simulation) -> str:
    """Tabulate the columns of a log and the wrench terms."""
    named = [name for group in LOG for name in group.split()]
    named = named[: named.index("j1")] + [f"j{i}" for i in range(1, 1 + simulation.rotor_count)]
    if named != _core.log_columns(simulation.rotor_count):
        sys.exit(f"log columns: described are {named}")
    terms = ", ".join(f"`{term}`" for term in simulation.wrench_terms)
    return (
        "\n## Logs\n\n"
        "CSV with the fewest digits that restore every bit; `.mat` holds vectors of the\n"
        "same names.\n\n"
        + table(("columns", "unit", "meaning"), ((f"`{k}`", *v) for k, v in LOG.items()))
        + "\nTopics that were asked for follow (`--log-topics`, `sim.run(topics=...)`;\n"
        "`log.topics` in Python): `TOPIC.stamp` and `TOPIC.FIELD`, in `.mat` the fields of a\n"
        "struct `topic_TOPIC`; the last message at that time, NaN before the first.\n"
        "\nWrenches, too, if they were asked for (`--wrenches`, `sim.run(wrenches=True)`;\n"
        "`log.wrenches` in Python): `wrench_NAME.fx` to `wrench_NAME.tz`, in `.mat` the rows of\n"
        "`wrench_NAME`; force (N), then torque (N m) about the vehicle's centre of mass, frame\n"
        f"axes, as they act from the logged state on. Those of the shipped plugins:\n{terms}.\n"
    )


def topic_section(simulation: qc.Simulation) -> str:
    """Tabulate the topics inside the core."""
    files = {plugin.name: f"`{plugin.filename}`" for plugin in simulation.plugins}
    rows = []
    for name, topic in simulation.topics.items():
        plugins = [f"published by {files[topic.writer]}"] if topic.writer else []
        plugins += [f"taken by {files[reader]}" for reader in topic.readers]
        fields = " ".join(f"`{field}`" for field in topic.fields)
        rows.append((f"`{name}`", f"`{topic.kind}`", fields, ", ".join(plugins), topic.meaning))
    return (
        "\n## Topics\n\nMessages between plugins, and between them and Python or ROS; "
        "see [plugins.md](plugins.md#topics).\n"
        "Those of the shipped quadrotor with every plugin that ships:\n\n"
        + table(("topic", "kind", "fields", "plugins", "meaning"), rows)
    )


# Plugins that the shipped quadrotor does not have, and the tags that they need.
FURTHER = {
    "barometer": "",
    "battery": "<fullVoltage>12.6</fullVoltage><emptyVoltage>9.9</emptyVoltage>"
    "<capacity>2.2</capacity><resistance>0.03</resistance>"
    "<faults>faults</faults>",
    "controller": "<law>geometric</law>",
    "fault": "<effectiveness>faults</effectiveness><detection>0.1</detection>",
    "gps": "",
    "ground_effect": "",
    "imu": "",
    "magnetometer": "",
    "payload": "<mass>0.1</mass>",
    "push": "",
    "reference": "",
    "wind": "",
}


def vehicle_with(name: str, prefix: str, further: dict[str, str]) -> qc.Simulation:
    """Make a shipped vehicle with further plugins."""
    document = load_description(name, {})
    plugins = "".join(
        f'<gazebo><plugin name="{plugin}" filename="{prefix}{plugin}_plugin.so">{tags}</plugin>'
        "</gazebo>"
        for plugin, tags in further.items()
    )
    text = document.text.replace("</robot>", f"{plugins}</robot>")
    return qc.Simulation(_core.read_model(_core.Document(document.name, text, document.lines), []))


def rotors_sections() -> Iterator[str]:
    """Sections of the modules that do what RotorS' do."""
    yield (
        "\n# Modules of RotorS\n\nThey have the names and the tags of RotorS' own:\n"
        "[rotors.md](rotors.md).\n"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its frame has an inertia that no body can have
        link = "<linkName>firefly/base_link</linkName>"
        further = {"gps": link, "magnetometer": link, "pressure": link, "wind": link}
        yield from plugin_sections(vehicle_with("firefly", "librotors_gazebo_", further))


def page() -> str:
    """Write out the whole page."""
    simulation = vehicle_with("quadrotor", "lib", FURTHER)
    other_motors = qc.Simulation("quadrotor", xacro_args={"motor": "first_order"})
    return "".join(
        [
            INTRODUCTION,
            *plugin_sections(simulation, other_motors),
            *rotors_sections(),
            reference_section(),
            world_section(),
            unfelt_section(),
            engine_section(),
            log_section(simulation),
            topic_section(simulation),
        ]
    )


def main() -> None:
    """Write the page."""
    if sys.argv[1:] == ["--print"]:
        sys.stdout.write(page())
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        PAGE.write_text(page(), encoding="utf-8")
        print(PAGE.relative_to(ROOT))


if __name__ == "__main__":
    main()
