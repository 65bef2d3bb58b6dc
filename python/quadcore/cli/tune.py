"""``quadcore tune``: search for gains."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Sequence

from .._core import InputError
from ..control import controllers, gains
from ..model import resources
from ..simulation.engines import STUDY_ENGINE
from ..studies.flight_folder import DOCUMENT
from ..studies.option_info import CONTROLLER, OUTPUT, STUDY, VEHICLE
from ..studies.options import ControlOptions
from ..studies.output_folder import output_folder
from ..support import parse
from ..support.output_files import check_writable
from . import options, reading, terminal
from .command_checks import refuse_log_every
from .interrupted_output import keep_partial_output
from .options_file import make_plan
from .parser import add_command, complete_from, find_group

if TYPE_CHECKING:
    from ..studies.tune.problem import Problem


_YAML = (".yaml", ".yml")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "tune",
        "Search for gains of a controller, and test them on references that are held out.",
        tune_controller,
        """
        quadcore tune geometric hexarotor --budget 100 -o gains.yaml
        quadcore tune mine.py:Lee --free kx,kv -o mine.yaml
        """,
    )
    controller = parser.add_argument(
        "controller",
        metavar="CONTROLLER",
        help="controller, as for `quadcore run`; the search starts at its parameters",
    )
    model = parser.add_argument(
        "model", metavar="MODEL", nargs="*", default=["quadrotor"],
        help="URDF or xacro files, or built-in models (default: quadrotor)",
    )  # fmt: skip
    complete_from(controller, controllers.NAMES)
    complete_from(model, list(resources.list_shipped("urdf")))
    find_group(parser, OUTPUT).add_argument(
        "-o", metavar="GAINS.yaml", type=Path, help="gains file to write"
    )
    find_group(parser, OUTPUT).add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="folder for page, logs and, without -o, gains.yaml; or, if it ends in .yaml, the "
        "gains file",
    )
    group = find_group(parser, CONTROLLER)
    group.add_argument(
        "--reference",
        metavar="A,B",
        type=parse.several_calls,
        default=["spiral", "step"],
        help="references for the search, NAME, NAME:KEY=VALUE,... or files (default: spiral,step)",
    )
    group.add_argument(
        "--hold-out",
        metavar="A,B",
        type=parse.several_calls,
        default=["circle", "eight"],
        help="references for the test (default: circle,eight)",
    )
    find_group(parser, VEHICLE).add_argument(
        "--hold-out-model",
        metavar="A,B",
        type=parse.names,
        default=[],
        help="further models for the test, on all references (default: none)",
    )
    group.add_argument(
        "--only",
        "--free",
        metavar="A,B",
        type=parse.names,
        help="parameters to tune (default: all gains that are not zero; required for your own "
        "controller)",
    )
    find_group(parser, STUDY).add_argument(
        "--budget",
        metavar="N",
        type=parse.integer(1),
        default=300,
        help="minimum number of gain sets to try (default: 300)",
    )
    options.add_vary(parser, f", scenario{options.CONTROLLER_KEYS}")
    options.add_study(parser, ControlOptions, STUDY_ENGINE)
    options.add_format(parser)


def tune_controller(arguments: argparse.Namespace) -> None:
    """Search for gains, and print and write them."""
    from ..studies.tune.output import FILES

    arguments, problem = make_plan(arguments, _make_problem)
    folder = _find_folder(arguments)
    with output_folder(folder, FILES, DOCUMENT):
        _tune(arguments, problem, folder)


def _tune(arguments: argparse.Namespace, problem: Problem, folder: Optional[Path]) -> None:
    from ..studies.tune.output import write
    from ..studies.tune.tune import search_gains

    out = _find_gains_file(arguments)

    def write_gains(found: Any) -> None:
        gains.write(found.gains, out)

    with keep_partial_output(
        "tuning", out, write_gains, "best gains so far"
    ), terminal.show_progress(arguments.quiet, "tuning") as progress:
        found = search_gains(problem, arguments.budget, progress)
    write_gains(found)
    written = [out]
    if folder is not None:
        written += write(found, problem, folder)
    if not arguments.quiet:
        _show(found, written)


def _find_folder(arguments: argparse.Namespace) -> Optional[Path]:
    """Return the folder for the page, or None; ``--out`` may be the gains file."""
    out: Optional[Path] = arguments.out
    return None if out is None or out.suffix.lower() in _YAML else out


def _find_gains_file(arguments: argparse.Namespace) -> Path:
    from ..studies.tune.output import GAINS

    folder = _find_folder(arguments)
    out: Optional[Path] = arguments.o
    if out is None:
        out = arguments.out if folder is None else folder / GAINS
    if out is None:
        raise InputError("the gains have no file. Name it with -o GAINS.yaml.")
    if out.suffix.lower() not in _YAML:
        raise InputError(f"{out}: is not a YAML file. Name a file that ends in .yaml.")
    return out


def _make_problem(arguments: argparse.Namespace) -> Problem:
    from ..studies.tune.problem import Problem

    out = _find_gains_file(arguments)
    refuse_log_every(arguments, "tuning")
    if out.parent != _find_folder(arguments):  # the folder is created later
        check_writable(out)
    return Problem(
        arguments.controller,
        arguments.model,
        arguments.reference,
        arguments.hold_out,
        arguments.hold_out_model,
        arguments.only,
        arguments.engine,
        reading.read_axes(arguments),
        reading.read_options(arguments, ControlOptions),
    )


def _show(found: Any, written: Sequence[Path]) -> None:
    console = terminal.make_console()
    start = found.gains.history["start"]
    table = terminal.make_table("gain", "start", "found", numbers=True)
    for name, value in start.items():
        table.add_row(name, f"{value:.4g}", f"{found.gains.parameters[name]:.4g}")
    console.print(table, "")
    table = terminal.make_table("", "RMS error (m)", numbers=True)
    table.add_row("search, at the start", f"{found.start:.4g}")
    table.add_row("search", f"{found.error:.4g}")
    for label, error in found.held_out.items():
        table.add_row(f"held out: {label}", f"{error:.4g}")
    console.print(table)
    console.print(f"{len(found.evaluations)} gain sets tried, {found.refused} refused")
    terminal.print_written(written)
