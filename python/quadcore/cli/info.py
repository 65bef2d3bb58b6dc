"""``quadcore info``: show a model."""

from __future__ import annotations

import argparse
import math
import os
import textwrap
from pathlib import Path
from typing import Any, Dict

from rich.table import Table

from .._core import InputError, parse_number
from ..model import resources
from ..simulation.simulation import Simulation
from ..studies.evaluate.poles import describe_yaw_zero, find_yaw_zero
from ..studies.option_info import OUTPUT
from ..support.output_files import atomic_write
from ..thesis.chapter2.vehicle import Vehicle
from . import options, reading, terminal
from .list_names import list_entries, print_entries
from .parser import add_command, find_group

_LONGEST = 100  # maximum number of characters in a line

_FACTS = ("value", "unit", "default", "origin", "range", "meaning", "equation")
"""Attributes of a parameter that --json prints."""


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "info",
        "Show links, rotors, plugins and all parameters of a model; without MODEL, list models.",
        show_model,
        """
        quadcore info hummingbird
        quadcore info quadrotor --xacro sim_slow:=1 --picture quadrotor.png
        """,
    )
    options.add_model(parser, nargs="?")
    group = find_group(parser, OUTPUT)
    group.add_argument(
        "--picture",
        metavar="FILE.png",
        type=Path,
        help="drawing of frames, masses, equivalent inertia boxes, and rotors with their numbers "
        "and senses of rotation",
    )
    group.add_argument(
        "--vehicle",
        metavar="FILE.mat",
        type=Path,
        help="parameters of the mathematical model, for the functions in matlab/",
    )
    options.add_json(parser)


def show_model(arguments: argparse.Namespace) -> None:
    """Print the model with the changes that the options define."""
    if arguments.model is None:
        return _show_models(arguments)
    simulation = Simulation(**reading.read_model_arguments(arguments))
    if arguments.json:
        terminal.print_json(_describe(simulation))
    else:
        _print(simulation)
    written = []
    if arguments.picture is not None:
        _draw(simulation, arguments.picture)
        written.append(arguments.picture)
    if arguments.vehicle is not None:
        if arguments.vehicle.suffix.lower() != ".mat":
            raise InputError(
                f"--vehicle {arguments.vehicle}: is not a .mat file. Name a file that ends in .mat."
            )
        Vehicle.of(simulation).to_mat(arguments.vehicle)
        written.append(arguments.vehicle)
    if not arguments.json:
        terminal.print_written(written)


def _show_models(arguments: argparse.Namespace) -> None:
    for option in ("set", "xacro", "ignore", "picture", "vehicle"):
        if getattr(arguments, option):
            raise InputError(f"--{option} requires a MODEL. Name one.")
    entries = list_entries("models")
    if arguments.json:
        terminal.print_json(entries)
    else:
        print_entries(entries)


def _print(simulation: Simulation) -> None:
    console = terminal.make_console()
    console.print(f"model {simulation.model.name}")
    console.print(f"engine {simulation.engine}: {simulation.method}\n")
    if simulation.ignored:
        console.print(f"ignored: {', '.join(simulation.ignored)}\n")
    for table in (
        _make_link_table(simulation),
        _make_body_table(simulation),
        _make_rotor_table(simulation),
    ):
        console.print(table, "")
    yaw = describe_yaw_zero(find_yaw_zero(simulation))
    if yaw:
        console.print(f"{yaw[0].upper()}{yaw[1:]}\n")
    for plugin in simulation.plugins:
        console.print(f"plugin {plugin.name}: {plugin.summary}")
        console.print(f"  {plugin.filename}, loaded from {plugin.path}", soft_wrap=True)
        for name, topic in simulation.topics.items():
            meaning = f"{topic.kind}: {topic.meaning}" if topic.meaning else topic.kind
            if topic.writer == plugin.name:
                console.print(f"  publishes topic {name}, {meaning}", soft_wrap=True)
            if plugin.name in topic.readers:
                console.print(f"  reads topic {name}, {meaning}", soft_wrap=True)
        if console.is_terminal:
            text = _explain(plugin, min(console.width, _LONGEST))
            console.print(text, "", soft_wrap=True, sep="\n")
        else:  # one line per parameter, which `grep` can find
            console.print(_make_parameter_table(plugin), "")


def _describe(simulation: Simulation) -> Dict[str, Any]:
    """Describe the model as plain values."""
    model = simulation.model
    yaw_zero = find_yaw_zero(simulation)
    return {
        "model": model.name,
        "ignored": list(simulation.ignored),
        "links": [{"name": link.name, "mass": link.mass} for link in model.links],
        "mass": simulation.mass,
        "center_of_mass": simulation.center_of_mass.tolist(),
        "inertia": simulation.inertia.tolist(),
        "yaw_zero": yaw_zero if math.isfinite(yaw_zero) else None,
        "joints": [
            {"name": joint.name, "position": list(joint.xyz), "axis": list(joint.axis)}
            for joint in model.joints
        ],
        "plugins": [
            {
                "name": plugin.name,
                "summary": plugin.summary,
                "filename": plugin.filename,
                "path": plugin.path,
                "parameters": [
                    {"name": each.name, **{fact: getattr(each, fact) for fact in _FACTS}}
                    for each in plugin.parameters
                ],
            }
            for plugin in simulation.plugins
        ],
        "topics": [
            {
                "name": name,
                "kind": topic.kind,
                "meaning": topic.meaning,
                "writer": topic.writer,
                "readers": list(topic.readers),
            }
            for name, topic in simulation.topics.items()
        ],
    }


def _draw(simulation: Simulation, file: Path) -> None:
    """Draw the vehicle; raise `InputError` if the file cannot be written."""
    from ..report.plots import png  # matplotlib is slow to import
    from ..report.vehicle_plot import draw

    if file.suffix.lower() != ".png":
        raise InputError(f"--picture {file}: is not a PNG file. Name a file that ends in .png.")
    picture = png(draw(simulation))
    with atomic_write(file) as stream:
        stream.write(picture)


def _make_link_table(simulation: Simulation) -> Table:
    table = terminal.make_table("link", "mass (kg)")
    for link in simulation.model.links:
        table.add_row(link.name, f"{link.mass:.9g}")
    return table


def _make_body_table(simulation: Simulation) -> Table:
    table = terminal.make_table("whole vehicle", "")
    table.add_row("mass (kg)", f"{simulation.mass:.9g}")
    table.add_row("centre of mass (m, frame axes)", _join_numbers(simulation.center_of_mass))
    for i, row in enumerate(simulation.inertia):
        name = "inertia about it (kg m^2)" if i == 0 else ""
        table.add_row(name, _join_numbers(row))
    return table


def _make_rotor_table(simulation: Simulation) -> Table:
    table = terminal.make_table("rotor", "position in its parent link (m)", "axis")
    for joint in simulation.model.joints:
        table.add_row(joint.name, _join_numbers(joint.xyz), _join_numbers(joint.axis))
    return table


def _explain(plugin: Any, width: int) -> str:
    """Explain each parameter in a few lines for a terminal, without breaking paths."""
    lines = []
    for parameter in plugin.parameters:
        # A unit belongs to numbers: if the value is text such as "off", show it with the range.
        is_number = parse_number(parameter.value.partition(" ")[0]) is not None
        value, allowed = f"{parameter.value} {parameter.unit}", parameter.range
        if not is_number:
            value, allowed = parameter.value, f"{parameter.range} {parameter.unit}"
        default = "required" if parameter.default is None else f"default {parameter.default}"
        facts = (parameter.meaning, allowed.rstrip(), default, parameter.equation)
        lines.append(f"  {parameter.name}  {value}".rstrip())
        origin = "" if parameter.origin == "default" else _shorten_origin(parameter.origin)
        indent = " " * 6
        lines += textwrap.wrap(
            "; ".join(filter(None, (*facts, origin))),
            width, initial_indent=indent, subsequent_indent=indent,
            break_long_words=False, break_on_hyphens=False,
        )  # fmt: skip
    return "\n".join(lines)


def _make_parameter_table(plugin: Any) -> Table:
    explained = ("range", "meaning", "equation")
    table = terminal.make_table("parameter", "value", "unit", "default", "from", *explained)
    for parameter in plugin.parameters:
        table.add_row(
            f"{plugin.name}.{parameter.name}",
            parameter.value,
            parameter.unit,
            "required" if parameter.default is None else parameter.default,
            _shorten_origin(parameter.origin),
            *(getattr(parameter, name) for name in explained),
        )
    return table


def _shorten_origin(origin: str) -> str:
    if origin == "set":
        return "--set"
    built_in = f"{resources.find_root()}{os.sep}"
    return origin[len(built_in) :] if origin.startswith(built_in) else origin


def _join_numbers(values: Any) -> str:
    return " ".join(f"{value + 0.0:.9g}" for value in values)  # adding 0.0 turns -0 into 0
