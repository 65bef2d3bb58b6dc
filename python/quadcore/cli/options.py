"""Options that several commands share."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Optional, Sequence, Type

from .._core import engines
from ..control import controllers, references
from ..formats.recordings import list_mappings
from ..model import resources
from ..model.overrides import LINK_NAMES
from ..report.drawing import FORMATS
from ..simulation.engines import ENGINE, list_engines
from ..simulation.scenarios import NONE
from ..studies.option_info import (
    CONTROLLER,
    FLIGHT,
    OUTPUT,
    STUDY,
    VEHICLE,
    OptionInfo,
    describe_options,
    explain,
)
from ..studies.options import SPAWNED, Names, Options, change_option
from ..support import parse
from ..support.arguments import FLAG
from ..support.values import Number
from .parser import complete_from, find_group

MODEL = "URDF or xacro file, or a built-in model: " + ", ".join(resources.list_shipped("urdf"))

CHANGES = ("parameters", "xacro_args", "ignore")
"""Options that change a model."""

CONTROLLER_KEYS = ", controller.KEY (rate, delay or a parameter)"


@dataclass(frozen=True)
class FlightOptions(Options):
    """Options of a single flight."""

    scenario: Optional[Names] = field(
        default=None,
        metadata=change_option(
            "scenario",
            metavar="FILE",
            meaning="scenario file or built-in scenario of disturbances and faults: "
            + ", ".join([NONE, *resources.list_shipped("config/scenarios")]),
            read=str,
        ),
    )
    seed: int = field(default=0, metadata=change_option("seed", meaning="seed of the noise"))
    log_every: Optional[int] = field(
        default=1, metadata=change_option("log_every", meaning="steps per logged row", without="")
    )
    spawn: Optional[Sequence[Number]] = field(
        default=None, metadata=change_option("spawn", without=SPAWNED)
    )


def add_mapping(parser: argparse.ArgumentParser) -> None:
    """Add the option that describes the columns of recordings of real flights."""
    action = find_group(parser, STUDY).add_argument(
        "--mapping",
        metavar="FILE",
        help="columns, units and frames of recordings of real flights: YAML file, or one of "
        + ", ".join(list_mappings())
        + " (default: the one that fits)",
    )
    complete_from(action, list_mappings())


def add_options(
    parser: argparse.ArgumentParser,
    *names: str,
    kind: Type[Options] = FlightOptions,
    **defaults: Any,
) -> None:
    """Add the named options, or all options of `kind`; `defaults` replaces default values."""
    for each in fields(kind):
        about: OptionInfo = each.metadata["about"]
        if not about.flag or (names and each.name not in names):
            continue
        if about.kind is FLAG:
            find_group(parser, about.group).add_argument(
                f"--{about.flag}", action="store_true", help=about.meaning
            )
            continue
        default = defaults.get(each.name, each.default)
        more = {"action": "append", "default": []} if about.repeats else {"default": default}
        action = find_group(parser, about.group).add_argument(
            f"--{about.flag}",
            metavar=about.metavar,
            type=about.read,
            help=explain(about, default) + ("; repeatable" if about.repeats else ""),
            **more,
        )
        if each.name in _COMPLETIONS:
            complete_from(action, _COMPLETIONS[each.name])


_COMPLETIONS = {
    "world": list(resources.list_shipped("worlds")),
    "scenario": [NONE, *resources.list_shipped("config/scenarios")],
}
"""Names of built-in files by option."""


def add_model(
    parser: argparse.ArgumentParser,
    nargs: str | None = None,
    default: str | None = None,
    changes: bool = True,
) -> None:
    """Add MODEL and, if `changes` is true, the options that change the model."""
    model = parser.add_argument(
        "model",
        metavar="MODEL",
        nargs=nargs,
        default=default,
        help=MODEL if default is None else f"{MODEL} (default: {default})",
    )
    complete_from(model, list(resources.list_shipped("urdf")))
    if changes:
        add_options(parser, *CHANGES)


def add_engine(
    parser: argparse.ArgumentParser,
    default: str | list[str],
    choices: Sequence[tuple[str, str]] = tuple(engines()),
) -> None:
    """Add the option for the engine, or for several engines if the default is a list."""
    names = [name for name, _ in choices]
    kind: dict[str, Any] = {"choices": names}
    if isinstance(default, list):
        kind = {"metavar": "A,B", "type": parse.several(names)}
    written = ",".join(default) if isinstance(default, list) else default
    action = find_group(parser, FLIGHT).add_argument(
        "--engine",
        default=default,
        help=f"engine that moves the vehicle; see `quadcore list engines` (default: {written})",
        **kind,
    )
    complete_from(action, names)


def add_flight(
    parser: argparse.ArgumentParser,
    engine: str | list[str] = ENGINE,
    log_every: int | None = 1,
    choices: Sequence[tuple[str, str]] = tuple(engines()),
    has_end: bool = True,
) -> None:
    """Add the options that all commands for single flights share."""
    add_engine(parser, engine, choices)
    timed = ("duration",) if has_end else ()
    add_options(parser, "world", "dt", *timed, "seed", "spawn", "log_every", log_every=log_every)
    add_quiet(parser)


def add_study(
    parser: argparse.ArgumentParser, kind: Type[Options], engine: str | list[str]
) -> None:
    """Add the options that all studies share."""
    add_options(parser, *CHANGES, kind=kind)
    add_engine(parser, engine, list_engines())
    add_options(
        parser, *(name for name in describe_options(kind) if name not in CHANGES), kind=kind
    )
    find_group(parser, STUDY).add_argument(
        "--options",
        metavar="FILE.yaml",
        type=Path,
        help="YAML file of options; command-line options override it",
    )
    add_quiet(parser)
    parser.set_defaults(parser=parser)


def add_combined(parser: argparse.ArgumentParser) -> None:
    """Add the options with the values that `evaluate` and `sweep` combine."""
    parser.add_argument(
        "file", metavar="FILE.yaml", nargs="?", type=Path, help="same as --options FILE.yaml"
    )
    add_controllers(parser, "controllers")
    reference = find_group(parser, CONTROLLER).add_argument(
        "--reference",
        metavar="A,B",
        type=parse.several_calls,
        help=f"references (trajectories): {', '.join(references.NAMES)}, each with optional "
        "parameters, NAME:KEY=VALUE,...; or files with columns t,x,y,z",
    )
    model = find_group(parser, VEHICLE).add_argument(
        "--model",
        metavar="A,B",
        type=parse.names,
        default=["quadrotor"],
        help="URDF or xacro files, or built-in models (default: quadrotor)",
    )
    complete_from(reference, references.NAMES)
    complete_from(model, list(resources.list_shipped("urdf")))


def add_controllers(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Add the option for several controllers."""
    action = find_group(parser, CONTROLLER).add_argument(
        "--controller",
        metavar="A,B",
        type=parse.several_calls,
        help=f"{meaning}: {_CONTROLLERS}",
    )
    complete_from(action, controllers.NAMES)


def add_model_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for a single vehicle."""
    model = find_group(parser, VEHICLE).add_argument(
        "--model", metavar="MODEL", default="quadrotor", help=f"{MODEL} (default: quadrotor)"
    )
    complete_from(model, list(resources.list_shipped("urdf")))


_CONTROLLERS = (
    f"{', '.join(controllers.NAMES)}, each with optional parameters, NAME:KEY=VALUE,...; or a "
    "gains file. Your own class or plugin is FILE.py[:NAME], MODULE:NAME or FILE.so"
)


def add_controller(parser: argparse.ArgumentParser) -> None:
    """Add the options for a closed-loop flight."""
    group = find_group(parser, CONTROLLER)
    controller = group.add_argument(
        "--controller",
        metavar="NAME|GAINS.yaml|FILE.py",
        help=f"controller: {_CONTROLLERS}",
    )
    reference = group.add_argument(
        "--reference",
        metavar="NAME|FILE",
        help=f"reference (trajectory): {', '.join(references.NAMES)}, each with optional "
        "parameters, NAME:KEY=VALUE,...; or a file with columns t,x,y,z. Without --spawn, a flight "
        "starts in the full state of the reference (default: hover at the spawn)",
    )
    complete_from(controller, controllers.NAMES)
    complete_from(reference, references.NAMES)


def add_commands(parser: argparse.ArgumentParser, default: str = "") -> None:
    """Add the option for an open-loop flight; `default` describes flights without it."""
    find_group(parser, FLIGHT).add_argument(
        "--commands",
        metavar="FILE",
        help="rotor speed commands in rad/s, columns t,w1..wn of a .csv, .mat or .bag file"
        f"{default}",
    )


_VALUES = "A,B,C or FIRST:LAST:COUNT or log:FIRST:LAST:COUNT"


def add_vary(parser: argparse.ArgumentParser, more: str = "", values: str = "") -> None:
    """Add the option for a grid; `more` describes other axes, `values` other kinds of values."""
    find_group(parser, STUDY).add_argument(
        "--vary",
        metavar="PLUGIN.TAG=VALUES",
        type=parse.assignment(r"([^=]+)=(.*)", "PLUGIN.TAG=VALUES"),
        action="append",
        default=[],
        help=f"values of a tag: {_VALUES}{values}. PLUGIN.TAG,PLUGIN.TAG=... gives several tags "
        f"the same value. Other axes: {LINK_NAMES}, xacro.ARG, world"
        f"{more}; repeatable; several make a grid",
    )


def add_out(
    parser: argparse.ArgumentParser,
    contents: str,
    plots: str = "plots",
    default: Path | None = None,
) -> None:
    """Add the options for the folder of the results and for omitting plots."""
    group = find_group(parser, OUTPUT)
    written = "" if default is None else f" (default: {default})"
    group.add_argument(
        "--out", metavar="DIR", type=Path, default=default, help=f"folder for {contents}{written}"
    )
    group.add_argument("--no-plots", action="store_true", help=f"write no {plots}")
    add_format(parser)


def add_format(parser: argparse.ArgumentParser) -> None:
    """Add the option for the formats of plot files."""
    find_group(parser, OUTPUT).add_argument(
        "--format",
        metavar="A,B",
        type=parse.several(FORMATS),
        default=[FORMATS[0]],
        help=f"formats of the plot files: {', '.join(FORMATS)} (default: {FORMATS[0]}); pages "
        "contain SVG; with pdf, their plots can be saved as PDF",
    )


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """Add the option that suppresses everything but warnings and errors."""
    find_group(parser, OUTPUT).add_argument(
        "--quiet", action="store_true", help="print warnings and errors only"
    )


def add_json(parser: argparse.ArgumentParser) -> None:
    """Add the option that prints JSON."""
    find_group(parser, OUTPUT).add_argument(
        "--json", action="store_true", help="print JSON instead of tables"
    )


def add_wrenches(parser: argparse.ArgumentParser) -> None:
    """Add the option that logs wrenches."""
    find_group(parser, OUTPUT).add_argument(
        "--wrenches", action="store_true", help="log each force and torque on the vehicle"
    )


def add_log_topics(parser: argparse.ArgumentParser) -> None:
    """Add the option that logs topics."""
    find_group(parser, OUTPUT).add_argument(
        "--log-topics",
        metavar="A,B",
        type=parse.names,
        default=[],
        help="topics of plugins to log in columns TOPIC.FIELD",
    )
