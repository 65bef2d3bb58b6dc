#!/usr/bin/env python3
"""Write docs/tags.md from quadcore's own tables of plugins, worlds and logs.

``scripts/document`` runs it. With --print, it writes the page to standard output.
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
from quadcore.model.overrides import LINK_VALUES

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "tags.md"

INTRODUCTION = """\
<!-- Written by scripts/document from the package's own tables: change those, not this file. -->
# Tags, worlds, engines, logs

This page lists all tags of plugins, elements of worlds, engines, columns of logs and topics.
To see the tables of a model with its values, and the line that set each, run `quadcore info MODEL`.
The [page on physics](physics.md) has the force laws of the tags, with their signs, frames and
points of application. Equation numbers and A.4-A.6 are those of the thesis.

An unknown, repeated or missing tag is an error, and so is a value that is out of its range or not
finite. The message has the file, the line, the plugin and the nearest known tag.

`--set PLUGIN.TAG=VALUE` (Python: `parameters={"PLUGIN.TAG": value}`) overrides the URDF. PLUGIN is
the `name` attribute of the plugin tag. `--set` also takes `LINK.NAME`, a [value of a
link](#links), and `xacro.ARG`, an argument of a xacro model. A name that fits two of these is an
error.
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
    "empty": "Gazebo's defaults without ground; the default world",
    "default": "the thesis' world: Gazebo's defaults with ground",
    "basic": "RotorS' world: ground, steps of 10 ms, a thousand sweeps of the solver",
    "forest": "150 trunks on the ground, as examples/make_forest.py 1 writes them",
    "landing_platform": "a platform of 1 m by 1 m on the ground, with its top at z = 0.5 m",
    "slalom": "six poles around the path of the reference eight",
    "window": "a wall at x = 3 m with a window of 1.5 m by 1.5 m around z = 10 m",
}


def write_plugin_sections(*simulations: qc.Simulation) -> Iterator[str]:
    """Write one section for each module of the simulations' plugins."""
    written = set()
    plugins = (plugin for simulation in simulations for plugin in simulation.plugins)
    for plugin in sorted(plugins, key=lambda plugin: plugin.name):
        if plugin.filename in written:
            continue
        written.add(plugin.filename)
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


def write_ignored_section() -> str:
    """Tabulate ignored elements and modules."""
    everything = _core.list_harmless_elements()
    elements = ((f"`<{u.name}>`", f"`<{u.parent}>`", u.what) for u in everything if u.parent)
    modules: dict[str, list[str]] = {}
    for element in everything:
        if not element.parent:
            modules.setdefault(element.what, []).append(f"`{element.name}`")
    return (
        "\n## Seen or sensed\n\n"
        "quadcore ignores elements without effect on the motion, with one warning that lists\n"
        "them, see [models.md](models.md#models-made-for-gazebo). Elements, with their parent:\n\n"
        + table(("element", "in", "what it is"), elements)
        + "\nModules of Gazebo, unless a plugin folder contains a library of that name:\n\n"
        + table(("output", "modules"), ((k, ", ".join(v)) for k, v in modules.items()))
    )


def write_reference_section() -> str:
    """Tabulate the tags of a <gazebo reference>."""
    tags = _core.gazebo_tags()
    felt = (
        (f"`{tag.name}`", tag.of, tag.unit, tag.default, tag.range, tag.meaning)
        for tag in tags
        if tag.affects
    )
    unfelt = ((f"`{tag.name}`", tag.of, tag.range, tag.meaning) for tag in tags if not tag.affects)
    return (
        "\n## Tags of `<gazebo reference>`\n\n"
        "These tags have an effect in the engines `gazebo11` and `ode`. The first eight are for\n"
        "contact. Of these, `eigen` uses `mu1`, `mu2`, `fdir1` and a `kp` that is softer than its\n"
        "springs, and warns about the others. It refuses `dampingFactor` and `turnGravityOff`. A\n"
        "value is the element's text or its attribute `value`. For references to a lumped link,\n"
        "see [models.md](models.md#lumping).\n\n"
        + table(("tag", "of a", "unit", "default", "range", "meaning"), felt)
        + "\nThese tags have no effect, as in Gazebo, within the given range:\n\n"
        + table(("tag", "of a", "range", "why"), unfelt)
    )


def write_link_section() -> str:
    """Tabulate the values of links."""
    rows = (
        (f"`LINK.{name}`", value.unit, f"`<{value.element}>` `{value.attribute}`", value.meaning)
        for name, value in LINK_VALUES.items()
    )
    return (
        "\n## Links\n\n"
        "Each link with an `<inertial>` has these values. The moments and products of inertia\n"
        "are those about the centre of mass. Its coordinates are in the axes of the link:\n\n"
        + table(("name", "unit", "in the URDF", "meaning"), rows)
    )


def write_world_section() -> str:
    """Tabulate the elements of a world, and the built-in worlds."""
    if set(WORLDS) != set(resources.list_shipped("worlds")):
        sys.exit(f"worlds: described are {list(WORLDS)}")
    rows = ((f"`{e.name}`", e.unit, e.default, e.range, e.meaning) for e in _core.world_elements())
    return (
        "\n## Worlds\n\n"
        "A world is an SDF file with one `<world>`. These elements have an effect. Others are\n"
        "ignored with a warning, as in Gazebo, unless their name resembles one of these. The page\n"
        "on [worlds](worlds.md) explains how models, saved states and versions are read.\n\n"
        + table(("element", "unit", "default", "range", "meaning"), rows)
        + "\nBuilt-in worlds:\n\n"
        + table(("world", "content"), ((f"`{name}`", what) for name, what in WORLDS.items()))
    )


def write_engine_section() -> str:
    """Tabulate the engines, the default first."""
    rows = ((f"`{name}`", summary) for name, summary in qc.engines())
    return (
        "\n## Engines\n\n"
        "Choose one with `--engine` (Python: `engine=`). [engines.md](engines.md) describes\n"
        "them and their default for each command.\n\n" + table(("engine", "method"), rows)
    )


def write_log_section(simulation: qc.Simulation) -> str:
    """Tabulate the columns of a log and the wrench terms."""
    named = [name for group in LOG for name in group.split()]
    named = named[: named.index("j1")] + [f"j{i}" for i in range(1, 1 + simulation.rotor_count)]
    if named != _core.log_columns(simulation.rotor_count):
        sys.exit(f"log columns: described are {named}")
    terms = ", ".join(f"`{term}`" for term in simulation.wrench_terms)
    return (
        "\n## Logs\n\n"
        "A CSV file has the fewest digits that read back exactly. A `.mat` file has vectors of\n"
        "the same names.\n\n"
        + table(("columns", "unit", "meaning"), ((f"`{k}`", *v) for k, v in LOG.items()))
        + "\nLogged topics follow (`--log-topics`, `sim.run(topics=...)`; `log.topics` in Python)\n"
        "in the columns `TOPIC.stamp` and `TOPIC.FIELD`, in `.mat` files in the fields of a\n"
        "struct `topic_TOPIC`. A row has the last message at its time, and NaN before the\n"
        "first one.\n"
        "\nLogged wrenches follow (`--wrenches`, `sim.run(wrenches=True)`; `log.wrenches` in\n"
        "Python) in the columns `wrench_NAME.fx` to `wrench_NAME.tz`, in `.mat` files in the\n"
        "rows of `wrench_NAME`. They are the force (N), then the torque (N m) about the\n"
        "vehicle's centre of mass, in frame axes, as they act from the logged state on. The\n"
        "built-in plugins have these wrenches:\n"
        f"{terms}.\n"
    )


def write_topic_section(simulation: qc.Simulation) -> str:
    """Tabulate the topics inside the core."""
    files = {plugin.name: f"`{plugin.filename}`" for plugin in simulation.plugins}
    rows = []
    for name, topic in simulation.topics.items():
        plugins = [f"published by {files[topic.writer]}"] if topic.writer else []
        plugins += [f"read by {files[reader]}" for reader in topic.readers]
        fields = " ".join(f"`{field}`" for field in topic.fields)
        rows.append((f"`{name}`", f"`{topic.kind}`", fields, ", ".join(plugins), topic.meaning))
    return (
        "\n## Topics\n\nMessages between plugins, and between them and Python or ROS; "
        "see [plugins.md](plugins.md#topics).\n"
        "These are the topics of the built-in quadrotor with every built-in plugin:\n\n"
        + table(("topic", "kind", "fields", "plugins", "meaning"), rows)
    )


# Plugins that the built-in quadrotor does not have, and their required tags.
FURTHER = {
    "barometer": "",
    "battery": "<fullVoltage>12.6</fullVoltage><emptyVoltage>9.9</emptyVoltage>"
    "<capacity>2.2</capacity><resistance>0.03</resistance>"
    "<faults>faults</faults>",
    "ceiling_effect": "",
    "controller": "<law>geometric</law>",
    "downwash": "",
    "fault": "<effectiveness>faults</effectiveness><detection>0.1</detection>",
    "gps": "",
    "ground_effect": "",
    "imu": "",
    "lidar": "<samples>3</samples>",
    "magnetometer": "",
    "payload": "<mass>0.1</mass>",
    "push": "",
    "range": "",
    "reference": "",
    "tachometer": "",
    "wind": "",
}


def make_vehicle(name: str, prefix: str, further: dict[str, str]) -> qc.Simulation:
    """Make a built-in vehicle with further plugins."""
    document = load_description(name, {})
    plugins = "".join(
        f'<gazebo><plugin name="{plugin}" filename="{prefix}{plugin}_plugin.so">{tags}</plugin>'
        "</gazebo>"
        for plugin, tags in further.items()
    )
    text = document.text.replace("</robot>", f"{plugins}</robot>")
    return qc.Simulation(_core.read_model(_core.Document(document.name, text, document.lines), []))


def write_rotors_sections() -> Iterator[str]:
    """Write the sections of RotorS' modules."""
    yield (
        "\n# Modules of RotorS\n\nThese modules have the names and tags of RotorS' modules, see\n"
        "[rotors.md](rotors.md).\n"
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # warns about the frame's inertia
        link = "<linkName>firefly/base_link</linkName>"
        further = {"gps": link, "magnetometer": link, "pressure": link, "wind": link}
        yield from write_plugin_sections(make_vehicle("firefly", "librotors_gazebo_", further))


def make_page() -> str:
    """Return the text of the page."""
    simulation = make_vehicle("quadrotor", "lib", FURTHER)
    other_motors = qc.Simulation("quadrotor", xacro_args={"motor": "first_order"})
    return "".join(
        [
            INTRODUCTION,
            *write_plugin_sections(simulation, other_motors),
            *write_rotors_sections(),
            write_link_section(),
            write_reference_section(),
            write_world_section(),
            write_ignored_section(),
            write_engine_section(),
            write_log_section(simulation),
            write_topic_section(simulation),
        ]
    )


def main() -> None:
    """Write the page."""
    if sys.argv[1:] == ["--print"]:
        sys.stdout.write(make_page())
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        PAGE.write_text(make_page(), encoding="utf-8")
        print(PAGE.relative_to(ROOT))


if __name__ == "__main__":
    main()
