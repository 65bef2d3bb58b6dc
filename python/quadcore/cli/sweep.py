"""``quadcore sweep``: simulate thousands of flights; can be resumed."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..simulation.engines import STUDY_ENGINE
from ..studies import tracking_metrics
from ..studies.distributions import DESIGNS, list_forms
from ..studies.option_info import OUTPUT, STUDY
from ..studies.options import SweepOptions
from ..studies.output_folder import output_folder
from ..studies.sweep import motion_metrics
from ..support import parse
from . import options, reading, terminal
from .failed_flights import report_failures
from .options_file import make_plan
from .parser import add_command, find_group

if TYPE_CHECKING:
    from ..studies.sweep.plan import Plan


_OUT = Path("out/sweep")
_HIDDEN = ("measure", "pawn_interval", "first_interval", "total_interval")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "sweep",
        "Simulate thousands of flights, and find what their results depend on.",
        sweep_flights,
        """
        quadcore sweep --controller geometric --reference spiral --samples 1000 \\
          --vary frame.mass=uniform:0.9:1.1 --out out/mass
        quadcore sweep --controller geometric --reference spiral --samples 1000 \\
          --vary frame.mass=uniform:0.9:1.1 --out out/mass --resume
        """,
    )
    study, output = find_group(parser, STUDY), find_group(parser, OUTPUT)
    options.add_combined(parser)
    options.add_commands(parser)
    distributions = f"; or a distribution, {', '.join(list_forms())}"
    options.add_vary(parser, f", scenario{options.CONTROLLER_KEYS}", distributions)
    study.add_argument(
        "--points", metavar="FILE.csv", help="table with a column for each axis, a row per point"
    )
    study.add_argument(
        "--samples",
        metavar="N",
        type=parse.integer(1),
        help="number of random samples of the axes with a distribution",
    )
    default = next(iter(DESIGNS))
    study.add_argument(
        "--design",
        choices=list(DESIGNS),
        default=default,
        help="; ".join(f"{name}: {meaning}" for name, (meaning, _) in DESIGNS.items())
        + f" (default: {default})",
    )
    options.add_study(parser, SweepOptions, [STUDY_ENGINE])
    study.add_argument(
        "--dask", metavar="ADDRESS", help="Dask scheduler that runs the flights, tcp://HOST:PORT"
    )
    options.add_out(parser, "page, table, summary and plots", default=_OUT)
    output.add_argument("--resume", action="store_true", help="continue the sweep in --out")
    output.add_argument(
        "--parquet", action="store_true", help="also write the rows as table.parquet"
    )
    output.add_argument(
        "--measure",
        metavar="NAME",
        help="metric of the plots and of the worst rows (default: "
        f"{next(iter(tracking_metrics.UNITS))}, or {next(iter(motion_metrics.UNITS))} with "
        "--commands)",
    )


def sweep_flights(arguments: argparse.Namespace) -> None:
    """Simulate the missing flights, and summarise all flights."""
    from ..studies.sweep.output import FILES, choose_metric, remove_sweep
    from ..studies.sweep.sweep import TABLE

    arguments, plan = make_plan(arguments, _make_plan)
    measure = choose_metric(plan, arguments.measure)
    document = "" if arguments.resume else "sweep.json"
    others = [name for name in FILES if name != TABLE]  # checked when they are read
    with output_folder(arguments.out, others, document):
        if not arguments.resume:
            remove_sweep(arguments.out)
        _sweep(arguments, plan, measure)


def _sweep(arguments: argparse.Namespace, plan: Plan, measure: str) -> None:
    from ..studies.sweep.output import write
    from ..studies.sweep.sweep import TABLE, fly_plan
    from ..studies.sweep.table import make_table

    out = arguments.out
    try:
        with terminal.show_progress(arguments.quiet) as progress:
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
        terminal.print_message(f"rows so far: {out / TABLE}. Add --resume to continue.")
        raise
    columns = make_table(rows)
    files = write(plan, columns, out, measure, not arguments.no_plots, arguments.jobs)
    if not arguments.quiet:
        _show(plan, columns, measure, files)
    _report_failures(columns)


def _make_plan(arguments: argparse.Namespace) -> Plan:
    from ..studies.sweep.plan import Plan, make_design

    design, shared = make_design(
        reading.collect_unique("--vary", arguments.vary),
        reading.read_options(arguments, SweepOptions),
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

    console = terminal.make_console()
    lines = [row for row in summarise_rows(plan, columns) if row["measure"] == measure]
    if lines:
        table = terminal.make_table(*lines[0], numbers=True)
        for row in lines:
            table.add_row(*(_write_cell(value, format_number) for value in row.values()))
        console.print(table, "")
    found = [row for row in compute_sensitivities(plan, columns) if row["measure"] == measure]
    if found:
        shown = [name for name in found[0] if name not in _HIDDEN]
        table = terminal.make_table(*shown, numbers=True)
        for row in found:
            table.add_row(*(_write_cell(row[name], format_number) for name in shown))
        console.print(table, "")
    console.print(count_rows(plan, columns))
    terminal.print_written(files)


def _write_cell(value: Any, format_number: Any) -> str:
    return format_number(value) if isinstance(value, float) else str(value)


def _report_failures(columns: Any) -> None:
    from ..studies.sweep.row_spec import REFUSED

    reasons = columns["failure"].tolist()
    refused = sum(reason.startswith(REFUSED) for reason in reasons)
    plain = [reason[len(REFUSED) :] if reason.startswith(REFUSED) else reason for reason in reasons]
    report_failures(plain, refused, lambda i: f"row {int(columns['row'][i])}")
