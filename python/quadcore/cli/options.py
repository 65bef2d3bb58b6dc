"""Options that several commands share, and the simulation they describe."""

from __future__ import annotations

import argparse
import math
import re
from typing import Any, Callable

from .._core import InputError, engines
from ..simulation import Simulation


def subparser(commands: Any, name: str, summary: str, action: Callable[..., None]) -> Any:
    """Parser of one command, which calls `action` with the parsed arguments."""
    parser = commands.add_parser(name, help=summary, description=summary, allow_abbrev=False)
    # "-1,0,10" is a value; argparse takes it for an option unless it looks like a number.
    parser._negative_number_matcher = re.compile(r"^-[\d.]")
    parser.set_defaults(action=action)
    return parser


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add MODEL and the options that change it."""
    parser.add_argument(
        "model", metavar="MODEL", help="URDF or xacro file, or a shipped model: quadrotor"
    )
    parser.add_argument(
        "--set",
        metavar="PLUGIN.TAG=VALUE",
        type=_assignment(r"([^=]+\.[^.=]+)=(.+)", "PLUGIN.TAG=VALUE"),
        action="append",
        default=[],
        help="give a plugin's tag another value; repeatable",
    )
    parser.add_argument(
        "--xacro",
        metavar="ARG:=VALUE",
        type=_assignment(r"([^:=]+):=(.*)", "ARG:=VALUE"),
        action="append",
        default=[],
        help="value of an argument of the xacro file; repeatable",
    )


def add_flight(parser: argparse.ArgumentParser) -> None:
    """Add the options of everything that flies."""
    names = [name for name, _ in engines()]
    summaries = "; ".join(f"{name}: {summary}" for name, summary in engines())
    parser.add_argument("--engine", choices=names, default="gazebo11", help=f"{summaries}")
    parser.add_argument("--world", metavar="FILE", help="world file or shipped world (empty)")
    parser.add_argument("--dt", metavar="S", type=_positive, help="step in s (the world's)")
    parser.add_argument(
        "--duration", metavar="S", type=_positive, default=10.0, help="time to fly in s (10)"
    )
    parser.add_argument(
        "--seed", metavar="N", type=_integer(0), default=0, help="seed of all noise (0)"
    )
    parser.add_argument(
        "--spawn",
        metavar="X,Y,Z[,ROLL,PITCH,YAW]",
        type=_pose,
        default=(0.0, 0.0, 10.0),
        help="start pose of the frame in m and rad (0,0,10)",
    )
    parser.add_argument(
        "--log-every", metavar="N", type=_integer(1), default=1, help="log each N-th step (1)"
    )
    parser.add_argument("--quiet", action="store_true", help="print warnings and errors only")


def model_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Simulation` that `add_model` asked for."""
    return {
        "model": arguments.model,
        "parameters": _unique("--set", arguments.set),
        "xacro_args": _unique("--xacro", arguments.xacro),
    }


def simulation(arguments: argparse.Namespace) -> Simulation:
    """Build the simulation that `add_model` and `add_flight` asked for."""
    return Simulation(
        **model_arguments(arguments),
        engine=arguments.engine,
        world=arguments.world,
        dt=arguments.dt,
        seed=arguments.seed,
        spawn=arguments.spawn,
    )


def _assignment(pattern: str, form: str) -> Callable[[str], tuple[str, str]]:
    def parse(text: str) -> tuple[str, str]:
        match = re.fullmatch(pattern, text, re.DOTALL)
        if match is None:
            raise argparse.ArgumentTypeError(f"'{text}' is not of the form {form}")
        return match.group(1), match.group(2)

    return parse


def _unique(option: str, pairs: list[tuple[str, str]]) -> dict[str, str]:
    values: dict[str, str] = {}
    for key, value in pairs:
        if key in values:
            raise InputError(f"{option}: {key} is given twice; keep one")
        values[key] = value
    return values


def _positive(text: str) -> float:
    value = _finite(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text} is not greater than 0")
    return value


def _finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    return value


def _integer(lowest: int) -> Callable[[str], int]:
    def parse(text: str) -> int:
        if not re.fullmatch(r"\d{1,18}", text) or int(text) < lowest:
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {lowest} on")
        return int(text)

    return parse


def _pose(text: str) -> tuple[float, ...]:
    values = tuple(_finite(part) for part in text.split(","))
    if len(values) not in (3, 6):
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form x,y,z[,roll,pitch,yaw]")
    return values
