"""``quadcore tune``: gains by search."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._core import InputError
from ..control import gains
from ..simulation.engines import STUDIED
from ..studies.options import Options
from ..support import parse
from ..support.output_files import check_writable
from . import options, terminal
from .command_checks import refuse_log_every
from .interrupted_output import keep_partial_output
from .options_file import planned

if TYPE_CHECKING:
    from ..studies.tune.problem import Problem


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "tune", "Search for gains of a law, judged on references held out.", tune
    )
    parser.add_argument(
        "law",
        metavar="LAW",
        help="as --controller of `quadcore run`: its parameters are where the search begins",
    )
    parser.add_argument(
        "model", metavar="MODEL", nargs="*", default=["quadrotor"], help="what flies (quadrotor)"
    )
    parser.add_argument(
        "-o", "--out", metavar="GAINS.yaml", type=Path, required=True, help="the file to write"
    )
    parser.add_argument(
        "--reference",
        metavar="A,B",
        type=parse.several_calls,
        default=["spiral", "step"],
        help="what is flown to tune, NAME, NAME:KEY=VALUE,... or files (spiral,step)",
    )
    parser.add_argument(
        "--hold-out",
        metavar="A,B",
        type=parse.several_calls,
        default=["circle", "eight"],
        help="what is flown to judge (circle,eight)",
    )
    parser.add_argument(
        "--hold-out-model",
        metavar="A,B",
        type=parse.names,
        default=[],
        help="models that fly everything to judge, too (none)",
    )
    parser.add_argument(
        "--only",
        metavar="NAME,NAME",
        type=parse.names,
        help="parameters to tune (all gains that are not zero)",
    )
    parser.add_argument(
        "--budget",
        metavar="N",
        type=parse.integer(1),
        default=300,
        help="gains to try, at least (300)",
    )
    options.add_vary(parser, options.CONTROLLER_KEYS)
    options.add_study(parser, Options, STUDIED)


def tune(arguments: argparse.Namespace) -> None:
    """Search, print what was found, and write it."""
    from ..studies.tune.tune import search_gains

    arguments, problem = planned(arguments, _problem)
    out = arguments.out

    def put(found: Any) -> None:
        gains.write(found.gains, out)

    with keep_partial_output("tuning", out, put, "the best so far"), terminal.progress(
        arguments.quiet, "tuning"
    ) as progress:
        found = search_gains(problem, arguments.budget, progress)
    put(found)
    if not arguments.quiet:
        _show(found, out)


def _problem(arguments: argparse.Namespace) -> Problem:
    from ..studies.tune.problem import Problem

    out = arguments.out
    if out.suffix.lower() not in (".yaml", ".yml"):
        raise InputError(f"{out}: name a file that ends in .yaml, which it would hold")
    refuse_log_every(arguments, "tuning")
    check_writable(out)
    return Problem(
        arguments.law,
        arguments.model,
        arguments.reference,
        arguments.hold_out,
        arguments.hold_out_model,
        arguments.only,
        arguments.engine,
        options.varied(arguments),
        options.read(arguments, Options),
    )


def _show(found: Any, out: Path) -> None:
    console = terminal.console()
    begun = found.gains.history["start"]
    table = terminal.table("gain", "start", "found", numbers=True)
    for name, value in begun.items():
        table.add_row(name, f"{value:.4g}", f"{found.gains.parameters[name]:.4g}")
    console.print(table, "")
    table = terminal.table("", "RMS error (m)", numbers=True)
    table.add_row("tuned on, at the start", f"{found.start:.4g}")
    table.add_row("tuned on", f"{found.error:.4g}")
    for label, error in found.held_out.items():
        table.add_row(f"held out: {label}", f"{error:.4g}")
    console.print(table)
    console.print(f"{len(found.evaluations)} tried, {found.refused} refused; written {out}")
