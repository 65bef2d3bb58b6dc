"""``quadcore info``: what a model is made of."""

from __future__ import annotations

import argparse
import os
import textwrap
from pathlib import Path
from typing import Any

from rich.table import Table

from .._core import InputError, parse_number
from ..model import resources
from ..simulation.simulation import Simulation
from ..support.output_files import atomic_write
from ..thesis.chapter2.vehicle import Vehicle
from . import options, terminal

_LONGEST = 100  # columns of a line that is read


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "info", "Show a model's links, rotors, plugins and every parameter.", info
    )
    options.add_model(parser)
    parser.add_argument(
        "--picture",
        metavar="FILE.png",
        type=Path,
        help="also draw frames, masses, boxes of inertia, and rotors with number and spin",
    )
    parser.add_argument(
        "--vehicle",
        metavar="FILE.mat",
        type=Path,
        help="also write what the mathematical model and the functions in matlab/ know of it",
    )


def info(arguments: argparse.Namespace) -> None:
    """Print the model as it would fly."""
    simulation = Simulation(**options.model_arguments(arguments))
    console = terminal.console()
    console.print(f"model {simulation.model.name}")
    console.print(f"engine {simulation.engine}: {simulation.method}\n")
    if simulation.ignored:
        console.print(f"ignored: {', '.join(simulation.ignored)}\n")
    for table in (_links(simulation), _body(simulation), _rotors(simulation)):
        console.print(table, "")
    for plugin in simulation.plugins:
        console.print(f"plugin {plugin.name}: {plugin.summary}")
        console.print(f"  {plugin.filename}, loaded from {plugin.path}", soft_wrap=True)
        for name, topic in simulation.topics.items():
            meaning = f"{topic.kind}: {topic.meaning}" if topic.meaning else topic.kind
            if topic.writer == plugin.name:
                console.print(f"  publishes topic {name}, {meaning}", soft_wrap=True)
            if plugin.name in topic.readers:
                console.print(f"  takes topic {name}, {meaning}", soft_wrap=True)
        if console.is_terminal:
            console.print(_told(plugin, min(console.width, _LONGEST)), "", soft_wrap=True, sep="\n")
        else:  # to be searched: a line has all that is known of a parameter
            console.print(_parameters(plugin), "")
    if arguments.picture is not None:
        _draw(simulation, arguments.picture)
        console.print(f"written {arguments.picture}")
    if arguments.vehicle is not None:
        if arguments.vehicle.suffix.lower() != ".mat":
            raise InputError(f"--vehicle {arguments.vehicle}: name a .mat file")
        Vehicle.of(simulation).to_mat(arguments.vehicle)
        console.print(f"written {arguments.vehicle}")


def _draw(simulation: Simulation, file: Path) -> None:
    """Draw the vehicle; raise `InputError` if the file cannot be written."""
    from ..report.plots import png  # matplotlib is slow to import
    from ..report.vehicle_plot import draw

    if file.suffix.lower() != ".png":
        raise InputError(f"--picture {file}: name a file that ends in .png, which it would hold")
    picture = png(draw(simulation))
    with atomic_write(file) as stream:
        stream.write(picture)


def _links(simulation: Simulation) -> Table:
    table = terminal.table("link", "mass (kg)")
    for link in simulation.model.links:
        table.add_row(link.name, f"{link.mass:.9g}")
    return table


def _body(simulation: Simulation) -> Table:
    table = terminal.table("whole vehicle", "")
    table.add_row("mass (kg)", f"{simulation.mass:.9g}")
    table.add_row("centre of mass (m, frame axes)", _numbers(simulation.center_of_mass))
    for i, row in enumerate(simulation.inertia):
        name = "inertia about it (kg m^2)" if i == 0 else ""
        table.add_row(name, _numbers(row))
    return table


def _rotors(simulation: Simulation) -> Table:
    table = terminal.table("rotor", "position in its parent link (m)", "axis")
    for joint in simulation.model.joints:
        table.add_row(joint.name, _numbers(joint.xyz), _numbers(joint.axis))
    return table


def _told(plugin: Any, width: int) -> str:
    """All of each parameter in a few lines, for a terminal; paths stay whole."""
    lines = []
    for parameter in plugin.parameters:
        # A unit belongs to a number: not to "off", but to what may be given instead.
        is_number = parse_number(parameter.value.partition(" ")[0]) is not None
        value, allowed = f"{parameter.value} {parameter.unit}", parameter.range
        if not is_number:
            value, allowed = parameter.value, f"{parameter.range} {parameter.unit}"
        default = "required" if parameter.default is None else f"default {parameter.default}"
        facts = (parameter.meaning, allowed.rstrip(), default, parameter.equation)
        lines.append(f"  {parameter.name}  {value}".rstrip())
        origin = "" if parameter.origin == "default" else _origin(parameter.origin)
        told = "; ".join(filter(None, (*facts, origin)))
        indent = " " * 6
        lines += textwrap.wrap(
            told, width, initial_indent=indent, subsequent_indent=indent,
            break_long_words=False, break_on_hyphens=False,
        )  # fmt: skip
    return "\n".join(lines)


def _parameters(plugin: Any) -> Table:
    explained = ("range", "meaning", "equation")
    table = terminal.table("parameter", "value", "unit", "default", "from", *explained)
    for parameter in plugin.parameters:
        table.add_row(
            f"{plugin.name}.{parameter.name}",
            parameter.value,
            parameter.unit,
            "required" if parameter.default is None else parameter.default,
            _origin(parameter.origin),
            *(getattr(parameter, name) for name in explained),
        )
    return table


def _origin(origin: str) -> str:
    if origin == "set":
        return "--set"
    shipped = f"{resources.root()}{os.sep}"
    return origin[len(shipped) :] if origin.startswith(shipped) else origin


def _numbers(values: Any) -> str:
    return " ".join(f"{value + 0.0:.9g}" for value in values)  # -0 is 0
