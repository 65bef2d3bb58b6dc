"""``quadcore evaluate``: measure controllers on references."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Sequence

from .._core import InputError
from ..simulation.engines import STUDY_ENGINE
from ..studies.option_info import STUDY
from ..studies.options import EvaluateOptions
from ..studies.output_folder import output_folder
from . import options, reading, terminal
from .failed_flights import report_failures
from .interrupted_output import keep_partial_output
from .options_file import make_plan
from .parser import add_command, find_group

if TYPE_CHECKING:
    from ..studies.evaluate.evaluate import Evaluation
    from ..studies.evaluate.plan import Plan

_ROWS = 40  # maximum number of rows on the terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "evaluate",
        "Simulate controllers on references, and measure their tracking errors.",
        evaluate_controllers,
        """
        quadcore evaluate --controller pd,geometric --reference spiral,circle --out out/controllers
        quadcore evaluate --controller mine.py,geometric --reference step --scenario none,gusty
        """,
    )
    options.add_combined(parser)
    options.add_vary(parser, f", scenario{options.CONTROLLER_KEYS}")
    options.add_study(parser, EvaluateOptions, [STUDY_ENGINE])
    find_group(parser, STUDY).add_argument(
        "--margins", action="store_true", help="also search for gain and delay margins"
    )
    options.add_out(parser, "page, tables and plots")


def evaluate_controllers(arguments: argparse.Namespace) -> None:
    """Simulate all combinations, print their errors, and write the results."""
    from ..studies.evaluate.output import FILES

    arguments, plan = make_plan(arguments, _make_plan)
    with output_folder(arguments.out, FILES, "evaluation.json"):
        _evaluate(arguments, plan)


def _evaluate(arguments: argparse.Namespace, plan: Plan) -> None:
    from ..studies.evaluate.evaluate import fly_plan
    from ..studies.evaluate.failure_causes import explain_failures
    from ..studies.evaluate.output import write

    out = arguments.out

    def write_files(flown: Evaluation, plots: bool = False) -> list[Path]:
        return write(flown, plan, out, plots) if out is not None else []

    with keep_partial_output("evaluation", out, write_files), terminal.show_progress(
        arguments.quiet
    ) as progress:
        evaluation = fly_plan(plan, progress, arguments.margins)
    files = write_files(evaluation, not arguments.no_plots)
    if not arguments.quiet:
        show(evaluation, files, [*plan.notes, *explain_failures(evaluation, plan)])
    report_failures(
        [row["failure"] for row in evaluation.table],
        sum(outcome.refused for outcome in evaluation.outcomes),
        lambda i: name_flight(evaluation.table[i]),
    )


def _make_plan(arguments: argparse.Namespace) -> Plan:
    from ..studies.evaluate.plan import Plan

    for name in ("controller", "reference"):
        if getattr(arguments, name) is None:
            raise InputError(f"no {name} is named. Name some with --{name}.")
    return Plan(
        arguments.controller,
        arguments.reference,
        arguments.engine,
        arguments.model,
        reading.read_axes(arguments),
        reading.read_options(arguments, EvaluateOptions),
    )


def show(evaluation: Evaluation, files: list[Path], notes: Sequence[str] = ()) -> None:
    """Print the tables and notes of an evaluation, and the paths of its files."""
    from ..studies.evaluate.output import list_notes, list_unstable_axes, summarise
    from ..studies.evaluate.summary_table import choose_columns, format_rows

    console = terminal.make_console()
    lines = format_rows(evaluation)
    shown = choose_columns(lines, evaluation.units)
    table = terminal.make_table(*shown.values(), "")
    for line in lines[:_ROWS]:
        table.add_row(*(line[name] for name in shown), line["best"])
    console.print(table)
    if evaluation.margins:
        console.print("", _make_margin_table(evaluation))
    if evaluation.loops:
        console.print("", _make_loop_table(evaluation))
    if len(lines) > _ROWS:
        console.print(f"{len(lines) - _ROWS} more combinations")
    for note in [*notes, *list_notes(evaluation)]:
        console.print(note)
    for cause in list_unstable_axes(evaluation):
        console.print(f"unstable: {cause}")
    console.print(summarise(evaluation))
    terminal.print_written(files)


def _make_margin_table(evaluation: Evaluation) -> Any:
    from ..studies.evaluate.output import format_margins

    table = terminal.make_table("controller", "gain", "delay (s)", "box, median / worst (m)")
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


def _make_loop_table(evaluation: Evaluation) -> Any:
    from ..studies.evaluate.loop_table import choose_headings, format_loops

    headings = choose_headings(evaluation.loops)
    table = terminal.make_table(*headings.values())
    for row in format_loops(evaluation.loops):
        table.add_row(*(row[name] for name in headings))
    return table


def name_flight(row: dict[str, Any]) -> str:
    """Name the flight in a row of the table."""
    return f"{row['controller']} on {row['reference']} in {row['engine']}, seed {row['seed']}"
