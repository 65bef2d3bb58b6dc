"""``quadcore benchmark``: compare controllers by a fixed set of flights."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..studies.benchmark.definition import LATEST, VERSIONS, Definition
from ..studies.option_info import OUTPUT, STUDY
from ..studies.options import EvaluateOptions
from ..studies.output_folder import output_folder
from ..support import parse
from . import options, reading, terminal
from .failed_flights import report_failures
from .interrupted_output import keep_partial_output
from .parser import add_command, complete_from, find_group

if TYPE_CHECKING:
    from ..studies.benchmark.flights import Benchmark


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "benchmark",
        "Compare controllers by a fixed, versioned set of vehicles, references and scenarios.",
        run_benchmark,
        """
        quadcore benchmark --controller mine.py:Lee --out out/benchmark
        quadcore benchmark --controller mine.py:Lee --vehicle crazyflie --category fast,wind
        """,
    )
    latest = Definition()
    version = parser.add_argument(
        "version",
        metavar="VERSION",
        nargs="?",
        default=LATEST,
        help=f"version of the benchmark: {', '.join(VERSIONS)} (default: {LATEST})",
    )
    complete_from(version, VERSIONS)
    options.add_controllers(
        parser, "controllers (default: all built-in ones except those of firmware)"
    )
    for name, known in (("vehicle", list(latest.vehicles)), ("category", latest.categories)):
        chosen = find_group(parser, STUDY).add_argument(
            f"--{name}",
            metavar="A,B",
            type=parse.names,
            help=f"run a part of the benchmark: {', '.join(known)} (default: all)",
        )
        complete_from(chosen, known)
    options.add_options(parser, "time_limit", "processes", kind=EvaluateOptions)
    find_group(parser, OUTPUT).add_argument(
        "--out", metavar="DIR", type=Path, help="folder for page, results and record"
    )
    options.add_quiet(parser)


def run_benchmark(arguments: argparse.Namespace) -> None:
    """Simulate the flights, print the scores, and write the results."""
    from ..studies.benchmark.flights import fly_parts, make_parts
    from ..studies.benchmark.output import FILES, write

    definition = Definition(arguments.version)
    shared = reading.read_options(arguments, EvaluateOptions)
    parts = make_parts(
        definition, arguments.controller, arguments.vehicle, arguments.category, shared
    )
    out = arguments.out

    def write_files(found: Benchmark) -> list[Path]:
        return [] if out is None else write(found, out)

    with output_folder(out, FILES, "benchmark.json"):
        with keep_partial_output("benchmark", out, write_files), terminal.show_progress(
            arguments.quiet
        ) as progress:
            found = fly_parts(definition, parts, progress)
        files = write_files(found)
        if not arguments.quiet:
            _show(found, files)
    if all(row["failure"] for row in found.table):
        report_failures(
            [row["failure"] for row in found.table],
            sum(outcome.refused for outcome in found.outcomes),
            lambda i: _name_flight(found.table[i]),
        )


def _show(found: Benchmark, files: list[Path]) -> None:
    from ..studies.benchmark.output import list_results_notes, summarise
    from ..studies.benchmark.scores import make_score_table

    categories, rows = make_score_table(found.scores)
    console = terminal.make_console()
    console.print("median RMS tracking error (m) in each category")
    table = terminal.make_table("controller", *categories)
    for name, cells in rows:
        table.add_row(name, *cells)
    console.print(table)
    for note in list_results_notes(found):
        console.print(note)
    console.print(summarise(found))
    terminal.print_written(files)


def _name_flight(row: dict[str, Any]) -> str:
    names = (row[name] for name in ("controller", "model", "scenario", "reference"))
    return f"{', '.join(names)}, seed {row['seed']}"
