"""Conversion of parsed arguments to options, models, flights and axes."""

from __future__ import annotations

import argparse
import math
from typing import Any, Type, TypeVar

from .._core import InputError
from ..simulation.flight_plan import FlightPlan
from ..studies.axes import parse_axis
from ..studies.control_setup import ControlSetup
from ..studies.option_info import describe_options
from ..studies.options import Options
from ..support.values import SPAWN

Kind = TypeVar("Kind", bound=Options)


def read_options(arguments: argparse.Namespace, kind: Type[Kind]) -> Kind:
    """Make the options of a study."""
    given: dict[str, Any] = {}
    for name, about in describe_options(kind).items():
        value = getattr(arguments, about.flag.replace("-", "_"), None)
        if about.flag and value is not None:
            is_mapping = about.repeats and about.read is not str
            given[name] = collect_unique(f"--{about.flag}", value) if is_mapping else value
    return kind(**given)


def read_model_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of `Simulation` that describe the model."""
    return {
        "model": arguments.model,
        "parameters": collect_unique("--set", arguments.set),
        "xacro_args": collect_unique("--xacro", arguments.xacro),
        "ignore": arguments.ignore,
    }


def make_flight_plan(arguments: argparse.Namespace) -> FlightPlan:
    """Make the plan of a flight; without --duration it has no end."""
    given = vars(arguments)
    plan = FlightPlan.of(
        **read_model_arguments(arguments),
        **{name: given[name] for name in ("engine", "world", "dt", "seed", "scenario", "wind")},
        at=given.get("at"),
        spawn=arguments.spawn or SPAWN,
        duration=given.get("duration", math.inf),
        commands=given.get("commands"),
        log_every=arguments.log_every or 1,
        topics=tuple(given.get("log_topics", ())),
    )
    control = read_control(arguments) if "controller" in given else ControlSetup()
    return control.guide(plan) if control.is_closed_loop else plan


def read_control(arguments: argparse.Namespace) -> ControlSetup:
    """Make the controller and the reference, or an empty setup."""
    names = ("controller", "reference", "controller_rate", "delay")
    given = {name: getattr(arguments, name) for name in names}
    if arguments.controller is None:
        for name, value in given.items():
            if value is not None:
                raise InputError(
                    f"--{name.replace('_', '-')} requires a controller. Add --controller."
                )
    elif arguments.commands is not None:
        raise InputError("--commands and --controller exclude each other. Give one of them.")
    return ControlSetup.single(**given, spawn=arguments.spawn)


def read_axes(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the values of each varied axis by name."""
    given = collect_unique("--vary", arguments.vary)
    return {axis.name: axis.values for axis in (parse_axis(*pair) for pair in given.items())}


def describe_changes(arguments: argparse.Namespace) -> dict[str, str]:
    """Describe the changes of the model for a report."""
    return {
        **{f"set {key}": value for key, value in arguments.set},
        **{f"xacro {key}": value for key, value in arguments.xacro},
        **({"ignored": ", ".join(arguments.ignore)} if arguments.ignore else {}),
    }


def collect_unique(option: str, pairs: list[tuple[str, str]]) -> dict[str, str]:
    """Convert pairs to a dictionary; raise `InputError` if a key occurs twice."""
    found: dict[str, str] = {}
    for key, value in pairs:
        if key in found:
            raise InputError(f"{option}: {key} is given twice. Keep one.")
        found[key] = value
    return found
