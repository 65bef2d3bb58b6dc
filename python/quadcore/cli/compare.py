"""``quadcore compare``: the same flight with several models or parameters."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .._core import InputError, QuadcoreError
from ..report.decimation import decimate
from ..simulation.engines import ENGINE
from ..simulation.log import Log
from ..studies.compare.compare import fly_plan
from ..studies.compare.output import (
    FILES,
    format_values,
    log_name,
    pick_drawn,
    remove_logs,
    summarise,
    write,
)
from ..studies.compare.plan import Plan
from ..studies.compare.result import Comparison
from ..studies.options import CompareOptions
from ..studies.output_folder import output_folder
from ..studies.table import choose_display_unit, format_number
from ..support import parse
from ..support.output_files import make_folder
from ..support.values import SPAWN
from . import options, terminal
from .command_checks import warn_of_commands
from .failed_flights import report_failures
from .interrupted_output import keep_partial_output
from .options_file import planned

_ROWS = 40  # on the terminal
_FEW = 20  # logs that --out writes unasked


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "compare", "Fly the same with several models or parameters.", compare
    )
    options.add_model(parser, nargs="+", changes=False)
    options.add_vary(parser, f", engine{options.CONTROLLER_KEYS}")
    options.add_study(parser, CompareOptions, ENGINE)
    options.add_commands(parser)
    options.add_controller(parser)
    parser.add_argument(
        "--against",
        metavar="N",
        type=parse.integer(1),
        help="number of the flight that the others are compared with (the first that flies)",
    )
    options.add_out(parser, f"report, table, plots and, of up to {_FEW} flights, logs")
    options.add_wrenches(parser)
    parser.add_argument("--logs", action="store_true", help="every log in --out, however many")


def compare(arguments: argparse.Namespace) -> None:
    """Print how the models differ, fly them, and print how the flights differ."""
    arguments, plan = planned(arguments, _plan)
    if arguments.against is not None and arguments.against > len(plan):
        raise InputError(f"--against {arguments.against}: there are {len(plan)} flights")
    with output_folder(arguments.out, FILES):  # after the flights would be too late
        _compare(arguments, plan)


def _compare(arguments: argparse.Namespace, plan: Plan) -> None:
    out = arguments.out
    _warn_of_commands(plan)
    if not arguments.quiet:
        _show_models(plan)

    def put(flown: Comparison, plots: bool = False) -> list[Path]:
        if out is None:
            return []
        flight = _flight(arguments, plan)
        return write(flown, plan, flight, out, plots, _has_logs(arguments, plan))

    with keep_partial_output("comparison", out, put), terminal.progress(
        arguments.quiet
    ) as progress:
        comparison = fly_plan(
            plan,
            _keeper(arguments, plan),
            progress,
            None if arguments.against is None else arguments.against - 1,
        )
    files = put(comparison, not arguments.no_plots)
    if not arguments.quiet:
        _show_flights(plan, comparison, files)
    report_failures(
        comparison.table["failure"].tolist(),
        comparison.refused,
        lambda i: f"no. {i + 1} ({plan.make_label(plan[i])})",
    )


def _plan(arguments: argparse.Namespace) -> Plan:
    if arguments.reference is not None and arguments.reference.isdigit():
        number = arguments.reference
        raise InputError(
            f"--reference {number}: names where to fly; the number of the flight that the others "
            f"are compared with is --against {number}"
        )
    if arguments.logs and arguments.out is None:
        raise InputError("--logs needs --out")
    if arguments.wrenches and arguments.out is None:
        raise InputError("--wrenches needs --out, where the logs are")
    plan = Plan(
        arguments.model,
        options.varied(arguments),
        arguments.engine,
        options.guidance_of(arguments),
        options.read(arguments, CompareOptions),
        arguments.commands,
        arguments.wrenches,
    )
    if len(plan) == 1 and not plan.axes:
        raise InputError("one model and nothing varied; name another model, or use --vary")
    return plan


def _warn_of_commands(plan: Plan) -> None:
    if plan.control.is_closed_loop:
        return
    first = plan.make_plan(plan[0])
    try:
        simulation = first.simulation()
    except QuadcoreError:  # a row of the table, with its reason
        return
    warn_of_commands(simulation, first)


def _has_logs(arguments: argparse.Namespace, plan: Plan) -> bool:
    return arguments.logs or len(plan) <= _FEW


def _keeper(arguments: argparse.Namespace, plan: Plan) -> Any:
    """Make what is done with each log: write it, and keep enough of some to draw."""
    out = arguments.out
    if out is None:
        return None
    to_draw = set() if arguments.no_plots else set(pick_drawn(len(plan)))
    has_logs = _has_logs(arguments, plan)
    remove_logs(out)
    if has_logs:
        make_folder(out / "logs")

    def keep(row: int, log: Log) -> Log | None:
        if has_logs:
            log.to_csv(out / log_name(row, len(plan)))
        return decimate(log) if row in to_draw else None

    return keep


def _flight(arguments: argparse.Namespace, plan: Plan) -> dict[str, str]:
    """Describe what all flights share."""
    guided = plan.control.is_closed_loop
    shared = plan.options
    begins = "on the reference"
    if not plan.control.on_reference:
        begins = ", ".join(f"{part:g}" for part in shared.spawn or SPAWN)
    told = {
        "commands": None if guided else arguments.commands or "none",
        "controller": arguments.controller,
        "reference": arguments.reference,
        "controller_rate": shared.controller_rate,
        "delay": shared.delay,
        "scenario": shared.scenario,
        "duration": f"{shared.duration:g} s",
        "engine": arguments.engine,
        "world": shared.world,
        "dt": shared.dt,
        "seed": shared.seed,
        "seeds": shared.seeds if shared.seeds > 1 else None,
        "spawn": begins,
    }
    return {
        **{
            name: str(value)
            for name, value in told.items()
            if value not in (None, 0) and name not in plan.design.names
        },
        **options.changes_told(arguments),
    }


def _show_models(plan: Plan) -> None:
    console = terminal.console()
    for model, found in plan.compare_models().items():
        console.print(f"{model} differs from {plan.models[0]} in")
        table = terminal.table("  what", "from", "to", "at", "and at")
        for d in found:
            table.add_row(f"  {d.what}", d.before, d.after, d.before_at or "-", d.after_at or "-")
        console.print(table if found else "  nothing that flies", "")
    if plan.axes:
        table = terminal.table("varied", "values", "as written")
        for axis in plan.axes:
            table.add_row(
                axis.name, format_values(axis.values), plan.format_written_value(axis) or "-"
            )
        console.print(table, "")


def _show_flights(plan: Plan, comparison: Comparison, files: list[Path]) -> None:
    console = terminal.console()
    whole = list(comparison.states)[:4]
    if comparison.against is not None:
        console.print(f"differences from no. {comparison.against + 1}, final / max")
    units = {state: choose_display_unit(comparison.states[state]) for state in whole}
    headings = [f"{state} ({unit})" for state, (unit, _) in units.items()]
    if plan.control.is_closed_loop:
        headings.insert(0, "to the reference (m), RMS / max")
    table, failures = terminal.table("no.", "variant", *headings), []
    for number, (row, variant) in enumerate(zip(comparison.table, plan), start=1):
        if number > _ROWS:
            table.add_row("...", f"{len(plan) - _ROWS} more")
            break
        cells = [
            " / ".join(format_number(row[f"{k}_{state}"] * factor) for k in ("final", "max"))
            for state, (_, factor) in units.items()
        ]
        if plan.control.is_closed_loop:
            errors = [format_number(row[f"{kind}_error"]) for kind in ("rms", "max")]
            cells.insert(0, " / ".join(errors))
        if row["failure"]:
            cells = ["failed"]
            failures.append(f"no. {number} ({plan.make_label(variant)}): {row['failure']}")
        table.add_row(str(number), plan.make_label(variant), *cells)
    console.print(table, "", *failures, summarise(comparison), sep="\n")
    for file in files:
        console.print(f"written {file}")
