"""``quadcore sweep``: thousands of flights, resumable, on whatever executes them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..simulation.engines import STUDIED
from ..studies import tracking_metrics as of_guided
from ..studies.distributions import DESIGNS, list_forms
from ..studies.options import SweepOptions
from ..studies.output_folder import output_folder
from ..studies.sweep import motion_metrics
from ..support import parse
from . import options, terminal
from .failed_flights import report_failures
from .options_file import planned

if TYPE_CHECKING:
    from ..studies.sweep.plan import Plan


_OUT = Path("out/sweep")
_UNTOLD = ("measure", "first_interval", "total_interval")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "sweep", "Fly thousands of flights, and tell what they depend on.", sweep
    )
    options.add_combined(parser)
    options.add_commands(parser)
    options.add_vary(parser, f"{options.CONTROLLER_KEYS}; or drawn from {', '.join(list_forms())}")
    parser.add_argument(
        "--points", metavar="FILE.csv", help="rows are points of the axes that its header names"
    )
    parser.add_argument(
        "--samples",
        metavar="N",
        type=parse.integer(1),
        help="points of the axes that are drawn",
    )
    default = next(iter(DESIGNS))
    parser.add_argument(
        "--design",
        choices=list(DESIGNS),
        default=default,
        help="; ".join(f"{name}: {meaning}" for name, (meaning, _) in DESIGNS.items())
        + f" ({default})",
    )
    options.add_study(parser, SweepOptions, [STUDIED])
    parser.add_argument(
        "--dask", metavar="ADDRESS", help="fly on the cluster of this scheduler, tcp://HOST:PORT"
    )
    options.add_out(parser, "rows, sums, pictures and a page", "pictures", _OUT)
    parser.add_argument(
        "--resume", action="store_true", help="go on with the rows that are in --out"
    )
    parser.add_argument(
        "--parquet", action="store_true", help="write the rows as table.parquet, too"
    )
    parser.add_argument(
        "--measure",
        metavar="NAME",
        help="what is drawn, and what the worst rows are worst in "
        f"({next(iter(of_guided.UNITS))}; with --commands {next(iter(motion_metrics.UNITS))})",
    )


def sweep(arguments: argparse.Namespace) -> None:
    """Fly what is missing, and tell what came of it."""
    from ..studies.sweep.output import FILES, choose_metric

    arguments, plan = planned(arguments, _plan)
    measure = choose_metric(plan, arguments.measure)
    with output_folder(arguments.out, FILES):  # after the flights would be too late
        _sweep(arguments, plan, measure)


def _sweep(arguments: argparse.Namespace, plan: Plan, measure: str) -> None:
    from ..studies.sweep.output import write
    from ..studies.sweep.sweep import TABLE, fly_plan
    from ..studies.sweep.table import make_table

    out = arguments.out
    try:
        with terminal.progress(arguments.quiet) as progress:
            rows = fly_plan(
                plan,
                out,
                arguments.resume,
                arguments.parquet,
                arguments.jobs,
                dask=arguments.dask,
                progress=progress,
            )
    except KeyboardInterrupt:
        terminal.say(f"rows so far: {out / TABLE}; --resume flies the rest")
        raise
    columns = make_table(rows)
    files = write(plan, columns, out, measure, not arguments.no_plots)
    if not arguments.quiet:
        _show(plan, columns, measure, files)
    _report(columns)


def _plan(arguments: argparse.Namespace) -> Plan:
    from ..studies.sweep.plan import Plan, make_design

    design, shared = make_design(
        options.unique("--vary", arguments.vary),
        options.read(arguments, SweepOptions),
        arguments.points,
        arguments.design,
        arguments.samples,
    )
    return Plan(
        design,
        arguments.controller,
        arguments.reference,
        arguments.engine,
        arguments.model,
        shared,
        arguments.commands,
    )


def _show(plan: Plan, columns: Any, measure: str, files: list[Path]) -> None:
    from ..studies.sweep.output import count_rows, summarise_rows
    from ..studies.sweep.sensitivity import compute_sensitivities
    from ..studies.table import format_number

    console = terminal.console()
    lines = [row for row in summarise_rows(plan, columns) if row["measure"] == measure]
    if lines:
        make_table = terminal.table(*lines[0], numbers=True)
        for row in lines:
            make_table.add_row(*(_cell(value, format_number) for value in row.values()))
        console.print(make_table, "")
    found = [row for row in compute_sensitivities(plan, columns) if row["measure"] == measure]
    if found:
        shown = [name for name in found[0] if name not in _UNTOLD]
        make_table = terminal.table(*shown, numbers=True)
        for row in found:
            make_table.add_row(*(_cell(row[name], format_number) for name in shown))
        console.print(make_table, "")
    console.print(count_rows(plan, columns))
    for file in files:
        console.print(f"written {file}")


def _cell(value: Any, format_number: Any) -> str:
    return format_number(value) if isinstance(value, float) else str(value)


def _report(columns: Any) -> None:
    from ..studies.sweep.row_spec import REFUSED

    reasons = columns["failure"].tolist()
    refused = sum(reason.startswith(REFUSED) for reason in reasons)
    plain = [reason[len(REFUSED) :] if reason.startswith(REFUSED) else reason for reason in reasons]
    report_failures(plain, refused, lambda i: f"row {int(columns['row'][i])}")
