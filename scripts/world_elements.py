"""What docs/tags.md says of worlds."""

from __future__ import annotations

import re
import sys
from typing import Iterator

from markdown_table import table

import quadcore as qc
from quadcore import _core
from quadcore.model import resources

SHIPPED = {
    "empty": "Gazebo's defaults without ground; what there is unless another is named",
    "default": "the thesis': Gazebo's defaults with ground",
    "basic": "RotorS': ground, steps of 10 ms, a thousand sweeps of the solver",
}

_FIELD = ("T", "`5.5645e-6 22.8758e-6 -42.3884e-6`")

# Every element a world may hold: unit, default, meaning. Which there are, and the range of each, is
# asked of the reader itself; one that is missing here or there fails the generator.
WORLD = {
    "gravity": ("m/s^2", "`0 0 -9.8`", "gravity in world axes"),
    "wind/linear_velocity": (
        "m/s",
        "`0 0 0`",
        "velocity of the air in world axes; `chapter2` only",
    ),
    "atmosphere": (
        "",
        "",
        "attribute `type`, if given, must be `adiabatic`; felt where a plugin's tag says so",
    ),
    "atmosphere/temperature": ("K", "288.15", "of the air at z = 0"),
    "atmosphere/temperature_gradient": ("K/m", "-0.0065", "its change with height"),
    "atmosphere/pressure": ("Pa", "101325", "of the air at z = 0"),
    "magnetic_field": (
        *_FIELD,
        "of the Earth in world axes, x east, y north, z up; for magnetometers",
    ),
    "spherical_coordinates/surface_model": ("", "`EARTH_WGS84`", "must be so"),
    "spherical_coordinates/world_frame_orientation": (
        "",
        "`ENU`",
        "must be so: x east, y north, z up",
    ),
    "spherical_coordinates/latitude_deg": (
        "deg",
        "0",
        "of the world's origin, positive north; for RotorS' satellite receiver",
    ),
    "spherical_coordinates/longitude_deg": ("deg", "0", "the same, positive east"),
    "spherical_coordinates/elevation": ("m", "0", "its height"),
    "spherical_coordinates/heading_deg": (
        "deg",
        "0",
        "by which the axes are turned; a satellite receiver takes 0 alone",
    ),
    "include/uri": (
        "",
        "",
        "`model://ground_plane`: solid ground at z = 0; `model://sun`: ignored; another is foreign",
    ),
    "plugin": ("", "", "a module that only senses or publishes, see below; another is foreign"),
    "model": ("", "", "a ground plane in line: static, one link; another is foreign"),
    "model/static": ("", "", "must be `true`"),
    "model/link/collision/geometry/plane/normal": ("", "`0 0 1`", "must be `0 0 1`"),
    "model/link/collision/geometry/plane/size": ("m", "", "ignored: the ground has no edge"),
    "model/link/visual": ("", "", "ignored"),
    "physics": ("", "", "attribute `type`, if given, must be `ode`; also written `physics:ode`"),
    "physics/gravity": ("m/s^2", "`0 0 -9.8`", "the same as `gravity`; only one of them"),
    "physics/magnetic_field": (
        *_FIELD,
        "the same as `magnetic_field`; only one of them",
    ),
    "physics/max_step_size": ("s", "0.001", "the step, unless `--dt` or `dt=` is given"),
    "physics/real_time_update_rate": (
        "1/s",
        "1000",
        "steps per second of wall clock, 0 = as fast as possible; for nodes that pace",
    ),
    "physics/updateRate": ("1/s", "1000", "the thesis' name of `real_time_update_rate`"),
    "physics/real_time_factor": (
        "",
        "1",
        "without effect, as in Gazebo; `real_time_update_rate` sets the pace",
    ),
    "physics/ode/solver/type": (
        "",
        "`quick`",
        "`quick` or `world`; in flight both give the same answer, see [gazebo.md](gazebo.md)",
    ),
    "physics/ode/solver/iters": ("", "50", "sweeps of the quick solver"),
    "physics/ode/solver/sor": ("", "1.3", "its over-relaxation"),
    "physics/ode/solver/use_dynamic_moi_rescaling": ("", "0", "must be `0`"),
    "physics/ode/constraints/erp": ("", "0.2", "part of a hinge's error that a step removes"),
    "physics/ode/constraints/cfm": ("", "0", "softness of the hinges"),
    "physics/ode/constraints/contact_max_correcting_vel": (
        "m/s",
        "100",
        "caps what a correction leaves of velocity: a contact's `maxVel`, in `gazebo11` also a "
        "hinge's, see [gazebo.md](gazebo.md#random-vehicles)",
    ),
}


def world_section() -> str:
    """Tabulate the elements that the reader accepts, each with the range that it states."""
    accepted = set(_accepted("", "world"))
    described = {f"/{path}" for path in WORLD}
    # physics:ode is physics under another name; a place without an entry must lead to one.
    missing = {
        path
        for path in accepted
        if not path.startswith("/physics:ode")
        and not any(d == path or d.startswith(path + "/") for d in described)
    }
    if missing or described - accepted:
        sys.exit(f"worlds: not described: {missing}; not read: {described - accepted}")
    if set(SHIPPED) != set(resources.shipped("worlds")):
        sys.exit(f"worlds: shipped, says this file, are {list(SHIPPED)}")
    rows = (
        (f"`{path}`", unit, default, _range(path), meaning)
        for path, (unit, default, meaning) in WORLD.items()
    )
    return (
        "\n## Worlds\n\n"
        "An SDF file with one `<world>`. Of it these elements are read; any other is an error\n"
        "that names it, unless [nothing feels it](#seen-or-sensed).\n\n"
        + table(("element", "unit", "default", "range", "meaning"), rows)
        + "\nShipped, and known by name:\n\n"
        + table(("world", "what it is"), ((f"`{name}`", what) for name, what in SHIPPED.items()))
    )


def _accepted(path: str, element: str) -> Iterator[str]:
    """Every path below `path`, from what the reader says to an element that it does not know."""
    message = _refusal(path, "<unknown/>")
    takes = re.search(rf"<{element}> takes ([^;]*)", message)
    for name in takes.group(1).split(", ") if takes else ():
        yield f"{path}/{name}"
        yield from _accepted(f"{path}/{name}", name)


def _range(path: str) -> str:
    found = re.search(r"write a number (.*)|must be a (whole number .*)", _refusal(path, "-1"))
    return (found.group(1) or found.group(2)) if found else ""


def _refusal(path: str, content: str) -> str:
    """Return what the reader says to `content` at `path`."""
    names = [name for name in path.split("/") if name]
    opened = "".join(f"<{name}>" for name in names)
    closed = "".join(f"</{name}>" for name in reversed(names))
    # The core reads a prefix as part of the name, so that physics:ode needs no namespace.
    text = f"<sdf><world>{opened}{content}{closed}</world></sdf>"
    try:
        _core.read_world(_core.Document("world", text))
    except qc.InputError as error:
        return str(error)
    return ""
