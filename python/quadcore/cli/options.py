"""Options that several commands share, and the flight they describe."""

from __future__ import annotations

import argparse
import math
import re
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Callable, Optional, Sequence, Type, TypeVar

from .._core import InputError, engines
from ..control import controllers, references
from ..model import resources
from ..simulation.engines import ENGINE, list_engines
from ..simulation.flight_plan import FlightPlan
from ..studies.axes import parse_axis
from ..studies.control_setup import ControlSetup
from ..studies.options import (
    SPAWNED,
    Names,
    OptionInfo,
    Options,
    change_option,
    describe_options,
    explain,
)
from ..support import parse
from ..support.values import SPAWN, Number

SHIPPED = "URDF or xacro file, or a shipped model: " + ", ".join(resources.shipped("urdf"))
Kind = TypeVar("Kind", bound=Options)


def subparser(commands: Any, name: str, summary: str, action: Callable[..., None]) -> Any:
    """Parser of one command, which calls `action` with the parsed arguments."""
    parser = commands.add_parser(name, help=summary, description=summary, allow_abbrev=False)
    # "-1,0,10" is a value; argparse takes it for an option unless it looks like a number.
    parser._negative_number_matcher = re.compile(r"^-[\d.]")
    parser.set_defaults(action=action)
    return parser


@dataclass(frozen=True)
class FlightOptions(Options):
    """Options of a single flight."""

    scenario: Optional[Names] = field(
        default=None, metadata=change_option("scenario", metavar="FILE", read=str)
    )
    seed: int = field(default=0, metadata=change_option("seed", meaning="seed of all noise"))
    log_every: Optional[int] = field(default=1, metadata=change_option("log_every", without=""))
    spawn: Optional[Sequence[Number]] = field(
        default=None, metadata=change_option("spawn", without=SPAWNED)
    )


CHANGES = ("parameters", "xacro_args", "ignore")
"""Options that change a model."""

CONTROLLER_KEYS = " and controller.KEY, its rate, delay or a parameter"


def add(
    parser: argparse.ArgumentParser,
    *names: str,
    kind: Type[Options] = FlightOptions,
    **defaults: Any,
) -> None:
    """Add options by their names in Python, or all; some with other defaults."""
    for each in fields(kind):
        about: OptionInfo = each.metadata["about"]
        if not about.flag or (names and each.name not in names):
            continue
        default = defaults.get(each.name, each.default)
        more = {"action": "append", "default": []} if about.repeats else {"default": default}
        parser.add_argument(
            f"--{about.flag}",
            metavar=about.metavar,
            type=about.read,
            help=explain(about, default) + ("; repeatable" if about.repeats else ""),
            **more,  # type: ignore[arg-type]
        )


def read(arguments: argparse.Namespace, kind: Type[Kind]) -> Kind:
    """Make the options that `add` asked for."""
    given: dict[str, Any] = {}
    for name, about in describe_options(kind).items():
        value = getattr(arguments, about.flag.replace("-", "_"), None)
        if about.flag and value is not None:
            is_mapping = about.repeats and about.read is not str
            given[name] = unique(f"--{about.flag}", value) if is_mapping else value
    return kind(**given)


def add_model(
    parser: argparse.ArgumentParser,
    nargs: str | None = None,
    default: str | None = None,
    changes: bool = True,
) -> None:
    """Add MODEL, perhaps with the options that change it; the others as argparse has them."""
    parser.add_argument(
        "model",
        metavar="MODEL",
        nargs=nargs,
        default=default,
        help=SHIPPED if default is None else f"{SHIPPED} ({default})",
    )
    if changes:
        add(parser, *CHANGES)


def add_engine(
    parser: argparse.ArgumentParser,
    default: str | list[str],
    flown: Sequence[tuple[str, str]] = tuple(engines()),
) -> None:
    """Add the option that names the engine, or several where the default is a list."""
    names = [name for name, _ in flown]
    summaries = "; ".join(f"{name}: {summary}" for name, summary in flown)
    kind: dict[str, Any] = {"choices": names}
    if isinstance(default, list):
        kind = {"metavar": "LIST", "type": parse.several(names)}
    written = ",".join(default) if isinstance(default, list) else default
    parser.add_argument("--engine", default=default, help=f"{summaries} ({written})", **kind)


def add_flight(
    parser: argparse.ArgumentParser,
    engine: str | list[str] = ENGINE,
    log_every: int | None = 1,
    flown: Sequence[tuple[str, str]] = tuple(engines()),
    has_end: bool = True,
) -> None:
    """Add the options of everything that flies once; some differ between commands."""
    add_engine(parser, engine, flown)
    timed = ("duration",) if has_end else ()
    add(parser, "world", "dt", *timed, "seed", "spawn", "log_every", log_every=log_every)
    add_quiet(parser)


def add_study(
    parser: argparse.ArgumentParser, kind: Type[Options], engine: str | list[str]
) -> None:
    """Add the options that all studies share."""
    add(parser, *CHANGES, kind=kind)
    add_engine(parser, engine, list_engines())
    add(parser, *(name for name in describe_options(kind) if name not in CHANGES), kind=kind)
    parser.add_argument(
        "--options",
        metavar="FILE.yaml",
        type=Path,
        help="file of options by name; those on the command line win",
    )
    add_quiet(parser)
    parser.set_defaults(parser=parser)


def add_combined(parser: argparse.ArgumentParser) -> None:
    """Add what `evaluate` and `sweep` combine: controllers, references, models."""
    parser.add_argument(
        "file", metavar="FILE.yaml", nargs="?", type=Path, help="the same as --options FILE.yaml"
    )
    parser.add_argument(
        "--controller",
        metavar="A,B",
        type=parse.several_calls,
        help=f"{', '.join(controllers.NAMES)}, optionally with parameters, NAME:KEY=VALUE,...; "
        "gains files; MODULE:CLASS",
    )
    parser.add_argument(
        "--reference",
        metavar="A,B",
        type=parse.several_calls,
        help=f"{', '.join(references.NAMES)}, NAME:KEY=VALUE,..., or files",
    )
    parser.add_argument(
        "--model",
        metavar="A,B",
        type=parse.names,
        default=["quadrotor"],
        help="vehicles, files or shipped (quadrotor)",
    )


def add_out(
    parser: argparse.ArgumentParser, what: str, plots: str = "plots", default: Path | None = None
) -> None:
    """Add the options that name the folder of the results and leave plots out."""
    told = f"write {what} here" + ("" if default is None else f" ({default})")
    parser.add_argument("--out", metavar="DIR", type=Path, default=default, help=told)
    parser.add_argument("--no-plots", action="store_true", help=f"no {plots} in --out")


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """Add the option that leaves only warnings and errors on the terminal."""
    parser.add_argument("--quiet", action="store_true", help="print warnings and errors only")


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
        type=parse.assignment(r"([^=]+)=(.*)", "PLUGIN.TAG=VALUES"),
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
        metavar="NAME|GAINS.yaml|MODULE:CLASS",
        help=f"controller: {', '.join(controllers.NAMES)}, optionally with parameters, "
        "NAME:KEY=VALUE,...; a gains file; or your own class or function",
    )
    parser.add_argument(
        "--reference",
        metavar="NAME[:KEY=VALUE,...]|FILE",
        help=f"where to: one of {', '.join(references.NAMES)}, or a file with columns t,x,y,z "
        "(hover at the spawn); without --spawn a flight begins in its full state",
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
        type=parse.names,
        default=[],
        help="topics of plugins to log, too: columns NAME.FIELD",
    )


def model_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Simulation` that `add_model` asked for."""
    return {
        "model": arguments.model,
        "parameters": unique("--set", arguments.set),
        "xacro_args": unique("--xacro", arguments.xacro),
        "ignore": arguments.ignore,
    }


def flight_plan(arguments: argparse.Namespace) -> FlightPlan:
    """Describe the flight that the options asked for; without --duration it has no end."""
    given = vars(arguments)
    plan = FlightPlan.of(
        **model_arguments(arguments),
        **{name: given[name] for name in ("engine", "world", "dt", "seed", "scenario")},
        spawn=arguments.spawn or SPAWN,
        duration=given.get("duration", math.inf),
        commands=given.get("commands"),
        log_every=arguments.log_every or 1,
        topics=tuple(given.get("log_topics", ())),
    )
    control = guidance_of(arguments) if "controller" in given else ControlSetup()
    return control.guide(plan) if control.is_closed_loop else plan


def guidance_of(arguments: argparse.Namespace) -> ControlSetup:
    """Make the control that `add_controller` asked for."""
    names = ("controller", "reference", "controller_rate", "delay")
    given = {name: getattr(arguments, name) for name in names}
    if arguments.controller is None:
        for name, value in given.items():
            if value is not None:
                raise InputError(f"--{name.replace('_', '-')} needs a --controller; name one")
    elif arguments.commands is not None:
        raise InputError("a flight takes --commands or a --controller; give one of them")
    return ControlSetup.single(**given, spawn=arguments.spawn)


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
