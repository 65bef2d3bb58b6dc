"""``quadcore measure``: measure recorded flights on a reference."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .._core import InputError, parse_number
from ..control import references
from ..formats import FORMATS
from ..simulation.engines import STUDY_ENGINE
from ..studies.option_info import CONTROLLER, STUDY
from ..studies.options import MeasureOptions
from ..studies.output_folder import output_folder
from ..support import parse
from . import evaluate, options, reading, terminal
from .failed_flights import report_failures
from .interrupted_output import keep_partial_output
from .options_file import make_plan
from .parser import add_command, complete_from, find_group


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "measure",
        "Measure the tracking errors of recorded flights, next to simulated ones.",
        measure_logs,
        """
        quadcore measure flight.bag --reference circle --controller geometric --out out/measured
        quadcore measure pd=one.ulg pd=two.ulg --reference path.csv --align find --model iris
        """,
    )
    parser.add_argument(
        "log",
        metavar="[LABEL=]LOG",
        nargs="+",
        help=f"log to measure: {', '.join(FORMATS)}, or a recording of a real flight (ULog, "
        "Crazyflie micro-SD, blackbox, CSV, bag). Logs with the same LABEL are repetitions "
        "(default: the name of the file)",
    )
    group = find_group(parser, CONTROLLER)
    reference = group.add_argument(
        "--reference",
        metavar="NAME|FILE",
        help=f"reference of the flights: {', '.join(references.NAMES)}, with optional parameters, "
        "NAME:KEY=VALUE,...; or a file with columns t,x,y,z",
    )
    complete_from(reference, references.NAMES)
    options.add_controllers(parser, "controllers to simulate")
    options.add_model_option(parser)
    options.add_mapping(parser)
    find_group(parser, STUDY).add_argument(
        "--align",
        metavar="S|find,...",
        type=_read_alignments,
        default=[0.0],
        help="time in the log at which the reference begins, in seconds, for all logs or for each; "
        "find: the time with the minimum RMS tracking error (default: 0)",
    )
    options.add_study(parser, MeasureOptions, STUDY_ENGINE)
    options.add_out(parser, "page, tables and plots")


def measure_logs(arguments: argparse.Namespace) -> None:
    """Measure the logs, simulate controllers, print the errors, and write the results."""
    from ..studies.evaluate.measure import add_recordings, measure_plan
    from ..studies.evaluate.output import FILES, write

    arguments, plan = make_plan(arguments, _make_plan)
    out = arguments.out

    def write_files(flown: Any, plots: bool = False) -> list[Path]:
        return write(flown, plan, out, plots) if out is not None else []

    with output_folder(out, FILES, "evaluation.json"):
        with keep_partial_output(
            "evaluation", out, lambda found: write_files(add_recordings(found, plan))
        ), terminal.show_progress(arguments.quiet) as progress:
            evaluation = measure_plan(plan, progress)
        files = write_files(evaluation, not arguments.no_plots)
        if not arguments.quiet:
            evaluate.show(evaluation, files, plan.notes)
    report_failures(
        [row["failure"] for row in evaluation.table],
        sum(outcome.refused for outcome in evaluation.outcomes),
        lambda i: evaluate.name_flight(evaluation.table[i]),
    )


def _make_plan(arguments: argparse.Namespace) -> Any:
    from ..studies.evaluate.measure import MeasurePlan, Request

    if arguments.reference is None:
        raise InputError("no reference is named. Name that of the flights with --reference.")
    return MeasurePlan(
        Request(
            [_split_label(text) for text in arguments.log],
            arguments.reference,
            arguments.controller or (),
            arguments.model,
            arguments.engine,
            arguments.align,
            arguments.mapping,
        ),
        reading.read_options(arguments, MeasureOptions),
    )


def _split_label(text: str) -> tuple[str, Path]:
    label, is_given, file = text.partition("=")
    if not is_given or Path(text).exists():
        return Path(text).name, Path(text)
    return label, Path(file)


def _read_alignments(text: str) -> list[float | str]:
    found: list[float | str] = []
    for part in parse.names(text):
        number = parse_number(part)
        if number is None and part != "find":
            raise argparse.ArgumentTypeError(f"'{part}' is neither a number of seconds nor find")
        found.append(part if number is None else number)
    return found
