"""``quadcore info``: what a model is made of."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any

from rich.table import Table

from .. import resources
from .._core import InputError
from ..chapter2.vehicle import Vehicle
from ..simulation import Simulation
from . import options, terminal

_WIDE = 120  # columns


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "info", "Show a model's links, rotors, plugins and every parameter.", info
    )
    options.add_model(parser)
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
        console.print(f"  {plugin.filename}, loaded from {plugin.path}")
        for name, topic in simulation.topics.items():
            if topic.writer == plugin.name:
                console.print(f"  publishes topic {name}, {topic.kind}")
            if plugin.name in topic.readers:
                console.print(f"  takes topic {name}, {topic.kind}")
        # Lines that are searched stand alone; on a terminal the heading is in sight.
        prefix = "" if console.is_terminal else f"{plugin.name}."
        console.print(_parameters(plugin, prefix, console.width >= _WIDE), "")
    if arguments.vehicle is not None:
        if arguments.vehicle.suffix.lower() != ".mat":
            raise InputError(f"--vehicle {arguments.vehicle}: name a .mat file")
        Vehicle.of(simulation).to_mat(arguments.vehicle)
        console.print(f"written {arguments.vehicle}")
    if console.width < _WIDE:
        console.print("A wider terminal shows range, meaning and equation, too.")


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


def _parameters(plugin: Any, prefix: str, wide: bool) -> Table:
    explained = ("range", "meaning", "equation") if wide else ()
    table = terminal.table("parameter", "value", "unit", "default", "from", *explained)
    for parameter in plugin.parameters:
        table.add_row(
            prefix + parameter.name,
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
