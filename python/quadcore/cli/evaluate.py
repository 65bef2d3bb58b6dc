"""``quadcore evaluate``: how well controllers fly."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._core import InputError
from ..simulation.engines import STUDIED
from ..studies.options import EvaluateOptions
from ..studies.output_folder import output_folder
from . import options, terminal
from .failed_flights import report_failures
from .interrupted_output import keep_partial_output
from .options_file import planned

if TYPE_CHECKING:
    from ..studies.evaluate.evaluate import Evaluation
    from ..studies.evaluate.plan import Plan

_ROWS = 40  # on the terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "evaluate", "Fly controllers along references, and measure them.", evaluate
    )
    options.add_combined(parser)
    options.add_vary(parser, options.CONTROLLER_KEYS)
    options.add_study(parser, EvaluateOptions, [STUDIED])
    parser.add_argument(
        "--margins", action="store_true", help="search for gain and delay margins, too"
    )
    options.add_out(parser, "tables, pictures and a page", "pictures")


def evaluate(arguments: argparse.Namespace) -> None:
    """Fly everything, print how well, and write it."""
    from ..studies.evaluate.output import FILES

    arguments, plan = planned(arguments, _plan)
    with output_folder(arguments.out, FILES):  # after the flights would be too late
        _evaluate(arguments, plan)


def _evaluate(arguments: argparse.Namespace, plan: Plan) -> None:
    from ..studies.evaluate.evaluate import fly_plan
    from ..studies.evaluate.output import write

    out = arguments.out

    def put(flown: Evaluation, plots: bool = False) -> list[Path]:
        return write(flown, plan, out, plots) if out is not None else []

    with keep_partial_output("evaluation", out, put), terminal.progress(
        arguments.quiet
    ) as progress:
        evaluation = fly_plan(plan, progress, arguments.margins)
    files = put(evaluation, not arguments.no_plots)
    if not arguments.quiet:
        _show(evaluation, files)
    report_failures(
        [row["failure"] for row in evaluation.table],
        sum(outcome.refused for outcome in evaluation.outcomes),
        lambda i: _name(evaluation.table[i]),
    )


def _plan(arguments: argparse.Namespace) -> Plan:
    from ..studies.evaluate.plan import Plan

    for name in ("controller", "reference"):
        if getattr(arguments, name) is None:
            raise InputError(f"nothing to fly: name --{name}")
    return Plan(
        arguments.controller,
        arguments.reference,
        arguments.engine,
        arguments.model,
        options.varied(arguments),
        options.read(arguments, EvaluateOptions),
    )


def _show(evaluation: Evaluation, files: list[Path]) -> None:
    from ..studies.evaluate.output import list_unstable_axes, summarise
    from ..studies.evaluate.summary_table import choose_columns, format_rows

    console = terminal.console()
    lines = format_rows(evaluation)
    shown = choose_columns(lines)
    table = terminal.table(*shown.values(), "")
    for line in lines[:_ROWS]:
        table.add_row(*(line[name] for name in shown), line["best"])
    console.print(table)
    if evaluation.margins:
        console.print("", _margins(evaluation))
    if len(lines) > _ROWS:
        console.print(f"{len(lines) - _ROWS} more combinations")
    for cause in list_unstable_axes(evaluation):
        console.print(f"unstable: {cause}")
    console.print(summarise(evaluation))
    for file in files:
        console.print(f"written {file}")


def _margins(evaluation: Evaluation) -> Any:
    from ..studies.evaluate.output import format_margins

    table = terminal.table("controller", "gain", "delay (s)", "box, median / worst (m)")
    for row in format_margins(evaluation):
        if row["failure"]:
            table.add_row(row["controller"], row["failure"])
            continue
        gain, box = (
            " / ".join(row[name] or "-" for name in names)
            for names in (("gain_low", "gain_high"), ("box_median", "box_worst"))
        )
        table.add_row(row["controller"], gain, row["delay_margin"] or "-", box)
    return table


def _name(row: dict[str, Any]) -> str:
    return f"{row['controller']} on {row['reference']} in {row['engine']}, seed {row['seed']}"
