"""``quadcore compare``: repeat one flight with several models or parameters."""

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
from ..studies.option_info import OUTPUT, STUDY
from ..studies.options import CompareOptions
from ..studies.output_folder import output_folder
from ..studies.table import choose_display_unit, format_number
from ..support import parse
from ..support.output_files import make_folder
from ..support.values import SPAWN
from . import options, reading, terminal
from .command_checks import warn_of_commands
from .failed_flights import report_failures
from .interrupted_output import keep_partial_output
from .options_file import make_plan
from .parser import add_command, find_group

_ROWS = 40  # maximum number of rows on the terminal
_FEW = 20  # maximum number of logs that --out writes without --logs


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "compare",
        "Repeat one flight with several models or parameters, and compare the flights.",
        compare_models,
        """
        quadcore compare quadrotor hexarotor --controller geometric --reference spiral
        quadcore compare quadrotor --vary engine=gazebo11,eigen --out out/engines
        """,
    )
    options.add_model(parser, nargs="+", changes=False)
    options.add_vary(parser, f", scenario, engine{options.CONTROLLER_KEYS}")
    options.add_study(parser, CompareOptions, ENGINE)
    options.add_commands(parser)
    options.add_controller(parser)
    find_group(parser, STUDY).add_argument(
        "--against",
        metavar="N",
        type=parse.integer(1),
        help="number of the baseline flight (default: the first that does not fail)",
    )
    options.add_out(parser, f"page, table, plots and, for up to {_FEW} flights, logs")
    options.add_wrenches(parser)
    find_group(parser, OUTPUT).add_argument(
        "--logs", action="store_true", help=f"write all logs, also of more than {_FEW} flights"
    )


def compare_models(arguments: argparse.Namespace) -> None:
    """Print the differences between the models, simulate them, and compare the flights."""
    arguments, plan = make_plan(arguments, _make_plan)
    if arguments.against is not None and arguments.against > len(plan):
        raise InputError(
            f"--against {arguments.against}: there are only {len(plan)} flights. "
            "Use a smaller number."
        )
    with output_folder(arguments.out, FILES, "comparison.json"):
        _compare(arguments, plan)


def _compare(arguments: argparse.Namespace, plan: Plan) -> None:
    out = arguments.out
    _warn_of_commands(plan)
    if not arguments.quiet:
        _show_models(plan)

    def write_files(flown: Comparison, plots: bool = False) -> list[Path]:
        if out is None:
            return []
        flight = _describe_flight(arguments, plan)
        return write(flown, plan, flight, out, plots, _writes_logs(arguments, plan))

    with keep_partial_output("comparison", out, write_files), terminal.show_progress(
        arguments.quiet
    ) as progress:
        comparison = fly_plan(
            plan,
            _make_keeper(arguments, plan),
            progress,
            None if arguments.against is None else arguments.against - 1,
        )
    files = write_files(comparison, not arguments.no_plots)
    if not arguments.quiet:
        _show_flights(plan, comparison, files)
    report_failures(
        comparison.table["failure"].tolist(),
        comparison.refused,
        lambda i: f"no. {i + 1} ({plan.make_label(plan[i])})",
    )


def _make_plan(arguments: argparse.Namespace) -> Plan:
    if arguments.reference is not None and arguments.reference.isdigit():
        number = arguments.reference
        raise InputError(
            f"--reference {number}: is not a reference. To choose the baseline flight, use "
            f"--against {number}."
        )
    if arguments.logs and arguments.out is None:
        raise InputError("--logs requires a folder. Add --out.")
    if arguments.wrenches and arguments.out is None:
        raise InputError("--wrenches requires a folder. Add --out.")
    plan = Plan(
        arguments.model,
        reading.read_axes(arguments),
        arguments.engine,
        reading.read_control(arguments),
        reading.read_options(arguments, CompareOptions),
        arguments.commands,
        arguments.wrenches,
    )
    if len(plan) == 1 and not plan.axes:
        raise InputError(
            "there is one model and nothing is varied. Name another model, or use --vary."
        )
    return plan


def _warn_of_commands(plan: Plan) -> None:
    if plan.control.is_closed_loop:
        return
    first = plan.make_plan(plan[0])
    try:
        simulation = first.simulation()
    except QuadcoreError:  # the table contains the reason
        return
    warn_of_commands(simulation, first)


def _writes_logs(arguments: argparse.Namespace, plan: Plan) -> bool:
    return arguments.logs or len(plan) <= _FEW


def _make_keeper(arguments: argparse.Namespace, plan: Plan) -> Any:
    """Make the function that writes each log, and keeps some logs for plots."""
    out = arguments.out
    if out is None:
        return None
    to_draw = set() if arguments.no_plots else set(pick_drawn(len(plan)))
    has_logs = _writes_logs(arguments, plan)
    remove_logs(out)
    if has_logs:
        make_folder(out / "logs")

    def keep(row: int, log: Log) -> Log | None:
        if has_logs:
            log.to_csv(out / log_name(row, len(plan)))
        return decimate(log) if row in to_draw else None

    return keep


def _describe_flight(arguments: argparse.Namespace, plan: Plan) -> dict[str, str]:
    """Describe the settings that all flights share."""
    guided = plan.control.is_closed_loop
    shared = plan.options
    begins = "on the reference"
    if not plan.control.on_reference:
        begins = ", ".join(f"{part:g}" for part in shared.spawn or SPAWN)
    settings = {
        "commands": None if guided else arguments.commands or "none",
        "controller": arguments.controller,
        "reference": arguments.reference,
        "controller_rate": shared.controller_rate,
        "delay": shared.delay,
        "scenario": shared.scenario,
        "wind": None if shared.wind is None else ",".join(f"{v:g}" for v in shared.wind),
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
            for name, value in settings.items()
            if value not in (None, 0) and name not in plan.design.names
        },
        **reading.describe_changes(arguments),
        **({"unsimulated": ", ".join(plan.unsimulated)} if plan.unsimulated else {}),
    }


def _show_models(plan: Plan) -> None:
    console = terminal.make_console()
    for model, found in plan.compare_models().items():
        console.print(f"{model} differs from {plan.models[0]}")
        table = terminal.make_table("  what", "from", "to", "at", "and at")
        for d in found:
            table.add_row(f"  {d.what}", d.before, d.after, d.before_at or "-", d.after_at or "-")
        console.print(table if found else "  in nothing that is simulated", "")
    if plan.axes:
        table = terminal.make_table("varied", "values", "as written")
        for axis in plan.axes:
            table.add_row(
                axis.name, format_values(axis.values), plan.format_written_value(axis) or "-"
            )
        console.print(table, "")


def _show_flights(plan: Plan, comparison: Comparison, files: list[Path]) -> None:
    console = terminal.make_console()
    whole = list(comparison.states)[:4]
    if comparison.against is not None:
        console.print(f"difference from no. {comparison.against + 1}, final / max")
    units = {state: choose_display_unit(comparison.states[state]) for state in whole}
    headings = [f"{state} ({unit})" for state, (unit, _) in units.items()]
    if plan.control.is_closed_loop:
        headings.insert(0, "tracking error (m), RMS / max")
    table, failures = terminal.make_table("no.", "variant", *headings), []
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
    terminal.print_written(files)
