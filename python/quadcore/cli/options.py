"""Options that several commands share, and the flight they describe."""

from __future__ import annotations

import argparse
import re
from typing import Any, Callable, Sequence

from .._core import InputError, engines
from ..control import laws, references
from ..model import resources
from ..simulation.engines import ENGINE
from ..simulation.flight_plan import FlightPlan
from ..simulation.scenarios import NONE
from ..studies.axes import parse_axis
from ..studies.guidance import Guidance
from ..support import option_values
from ..support.values import SPAWN

SPAWNED = "{:g},{:g},{:g}".format(*SPAWN)
"""Where a flight begins unless told, as --spawn takes it."""


def subparser(commands: Any, name: str, summary: str, action: Callable[..., None]) -> Any:
    """Parser of one command, which calls `action` with the parsed arguments."""
    parser = commands.add_parser(name, help=summary, description=summary, allow_abbrev=False)
    # "-1,0,10" is a value; argparse takes it for an option unless it looks like a number.
    parser._negative_number_matcher = re.compile(r"^-[\d.]")
    parser.set_defaults(action=action)
    return parser


def add_model(
    parser: argparse.ArgumentParser, nargs: str | None = None, default: str | None = None
) -> None:
    """Add MODEL and the options that change it; `nargs` and `default` as argparse has them."""
    shipped = "URDF or xacro file, or a shipped model: " + ", ".join(resources.shipped("urdf"))
    parser.add_argument(
        "model",
        metavar="MODEL",
        nargs=nargs,
        default=default,
        help=shipped if default is None else f"{shipped} ({default})",
    )
    add_changes(parser)


def add_changes(parser: argparse.ArgumentParser) -> None:
    """Add the options that change a model."""
    parser.add_argument(
        "--set",
        metavar="PLUGIN.TAG=VALUE",
        type=option_values.assignment(r"([^=]+\.[^.=]+)=(.+)", "PLUGIN.TAG=VALUE"),
        action="append",
        default=[],
        help="give a plugin's tag another value, or LINK.mass, LINK.ixx ... LINK.izz, xacro.ARG; "
        "repeatable",
    )
    parser.add_argument(
        "--xacro",
        metavar="ARG:=VALUE",
        type=option_values.assignment(r"([^:=]+):=(.*)", "ARG:=VALUE"),
        action="append",
        default=[],
        help="value of an argument of the xacro file; repeatable",
    )
    parser.add_argument(
        "--ignore",
        metavar="NAME",
        action="append",
        default=[],
        help="leave out a foreign plugin (its name or file name), element, or model of the world; "
        "repeatable",
    )


def add_flight(
    parser: argparse.ArgumentParser,
    engine: str | list[str] = ENGINE,
    log_every: int | None = 1,
    flown: Sequence[tuple[str, str]] = tuple(engines()),
    seconds: float | None = 10.0,
    begins: str = SPAWNED,
) -> None:
    """Add the options of everything that flies; some differ between commands.

    `engine` is the default; where it is a list, several may be given. Without `seconds` there is no
    --duration. `begins` says where flights begin without --spawn.
    """
    names = [name for name, _ in flown]
    summaries = "; ".join(f"{name}: {summary}" for name, summary in flown)
    if isinstance(engine, list):
        parser.add_argument(
            "--engine",
            metavar="LIST",
            type=option_values.several(names),
            default=engine,
            help=f"{summaries} ({','.join(engine)})",
        )
    else:
        parser.add_argument(
            "--engine", choices=names, default=engine, help=f"{summaries} ({engine})"
        )
    add_world(parser)
    parser.add_argument(
        "--dt", metavar="S", type=option_values.positive, help="step in s (the world's)"
    )
    if seconds is not None:
        parser.add_argument(
            "--duration",
            metavar="S",
            type=option_values.positive,
            default=seconds,
            help=f"time to fly in s ({seconds:g})",
        )
    parser.add_argument(
        "--seed",
        metavar="N",
        type=option_values.integer(0, 2**64 - 1),
        default=0,
        help="seed of all noise (0)",
    )
    parser.add_argument(
        "--spawn",
        metavar="X,Y,Z[,ROLL,PITCH,YAW]",
        type=option_values.pose,
        help=f"start pose of the frame in m and rad ({begins})",
    )
    parser.add_argument(
        "--log-every",
        metavar="N",
        type=option_values.integer(1),
        default=log_every,
        help=f"log each N-th step ({log_every or 'each hundredth of a second'})",
    )
    parser.add_argument("--quiet", action="store_true", help="print warnings and errors only")


def add_world(parser: argparse.ArgumentParser) -> None:
    """Add the option that names a world."""
    known = ", ".join(resources.shipped("worlds"))
    parser.add_argument(
        "--world", metavar="FILE", help=f"world file, or a shipped world: {known} (empty)"
    )


def add_commands(parser: argparse.ArgumentParser, default: str = "") -> None:
    """Add the option that names an open-loop flight; `default` says what is flown without."""
    parser.add_argument(
        "--commands",
        metavar="FILE",
        help=f"rotor speeds to fly, .csv, .mat or .bag: t,w1..wn (rad/s){default}",
    )


def add_vary(parser: argparse.ArgumentParser, more: str = "") -> None:
    """Add the option that spans a grid; `more` may be varied."""
    parser.add_argument(
        "--vary",
        metavar="PLUGIN.TAG=VALUES",
        type=option_values.assignment(r"([^=]+)=(.*)", "PLUGIN.TAG=VALUES"),
        action="append",
        default=[],
        help="a,b,c or FIRST:LAST:COUNT or log:FIRST:LAST:COUNT; PLUGIN.TAG,PLUGIN.TAG=... gives "
        "several tags the same value; LINK.mass, LINK.ixx ... LINK.izz, xacro.ARG and world too"
        f"{more}; repeatable: a grid",
    )


def add_controller(parser: argparse.ArgumentParser) -> None:
    """Add the options that name a flight in closed loop."""
    parser.add_argument(
        "--controller",
        metavar="LAW|GAINS.yaml|MODULE:CLASS",
        help=f"what flies: one of {', '.join(laws.NAMES)}, perhaps with parameters, LAW:KEY=VALUE,"
        "...; a file of gains; or a class or function of your own",
    )
    parser.add_argument(
        "--reference",
        metavar="NAME[:KEY=VALUE,...]|FILE",
        help=f"where to: one of {', '.join(references.NAMES)}, or a file with columns t,x,y,z "
        "(hover at the spawn); without --spawn a flight begins in its full state",
    )
    add_timing(parser)


def add_timing(parser: argparse.ArgumentParser) -> None:
    """Add the options that say when a controller is asked, and heard."""
    parser.add_argument(
        "--controller-rate",
        metavar="HZ",
        type=option_values.positive,
        help="calls per second (the law's, 500)",
    )
    parser.add_argument(
        "--delay",
        metavar="S",
        type=option_values.not_negative,
        help="from a call to the motors, s (the law's, 0)",
    )


def add_scenario(parser: argparse.ArgumentParser) -> None:
    """Add the option that says what befalls the vehicle."""
    parser.add_argument(
        "--scenario",
        metavar="FILE",
        help="what befalls the vehicle: a file, or a shipped scenario: "
        + f"{', '.join([NONE, *resources.shipped('config/scenarios')])} ({NONE})",
    )


def add_wrenches(parser: argparse.ArgumentParser) -> None:
    """Add the option that asks for wrenches."""
    parser.add_argument(
        "--wrenches", action="store_true", help="log each force and torque on the vehicle, too"
    )


def add_log_topics(parser: argparse.ArgumentParser) -> None:
    """Add the option that names topics to log."""
    parser.add_argument(
        "--log-topics",
        metavar="NAME,NAME",
        type=option_values.names,
        default=[],
        help="topics of plugins to log, too: columns NAME.FIELD",
    )


def add_jobs(parser: argparse.ArgumentParser) -> None:
    """Add the option that limits the processes."""
    parser.add_argument(
        "--jobs", metavar="N", type=option_values.integer(1), help="processes (one per core)"
    )


def model_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Simulation` that `add_model` asked for."""
    return {
        "model": arguments.model,
        "parameters": unique("--set", arguments.set),
        "xacro_args": unique("--xacro", arguments.xacro),
        "ignore": arguments.ignore,
    }


def flight_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Simulation` that `add_flight` asked for."""
    given = {name: getattr(arguments, name) for name in ("engine", "world", "dt", "seed", "spawn")}
    return {**given, "spawn": arguments.spawn or SPAWN}


def flight_plan(arguments: argparse.Namespace) -> FlightPlan:
    """Describe the flight that the options asked for."""
    plan = FlightPlan.of(
        **model_arguments(arguments),
        **flight_arguments(arguments),
        duration=arguments.duration,
        commands=arguments.commands,
        scenario=arguments.scenario,
        log_every=arguments.log_every,
        topics=tuple(arguments.log_topics),
    )
    guidance = Guidance(
        spawn=arguments.spawn, vehicles=[plan.model.name], **guidance_arguments(arguments)
    )
    return guidance.onto(plan)


def guidance_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Guidance` that `add_controller` asked for."""
    names = ("controller", "reference", "controller_rate", "delay")
    given = {name: getattr(arguments, name) for name in names}
    if arguments.controller is None:
        for name, value in given.items():
            if value is not None:
                raise InputError(f"--{name.replace('_', '-')} needs a --controller; name one")
    elif arguments.commands is not None:
        raise InputError("a flight takes --commands or a --controller; give one of them")
    return given


def varied(arguments: argparse.Namespace) -> dict[str, Any]:
    """Values of each axis that `add_vary` asked for."""
    given = unique("--vary", arguments.vary)
    return {axis.name: axis.values for axis in (parse_axis(*pair) for pair in given.items())}


def changes_told(arguments: argparse.Namespace) -> dict[str, str]:
    """Say what `add_changes` asked for, for a report."""
    return {
        **{f"set {key}": value for key, value in arguments.set},
        **{f"xacro {key}": value for key, value in arguments.xacro},
        **({"ignored": ", ".join(arguments.ignore)} if arguments.ignore else {}),
    }


def unique(option: str, pairs: list[tuple[str, str]]) -> dict[str, str]:
    """Make a dictionary of pairs; raise `InputError` if a key comes twice."""
    found: dict[str, str] = {}
    for key, value in pairs:
        if key in found:
            raise InputError(f"{option}: {key} is given twice; keep one")
        found[key] = value
    return found
