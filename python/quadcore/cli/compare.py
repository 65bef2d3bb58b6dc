"""``quadcore compare``: the same flight with several models or parameters."""

from __future__ import annotations

import argparse
from itertools import islice
from pathlib import Path
from typing import Any

from .._core import InputError, QuadcoreError
from ..report.thinning import thinned
from ..simulation.log import Log
from ..studies.compare.compare import fly
from ..studies.compare.output import FILES, drawn, listed, log_name, remove_logs, summary, write
from ..studies.compare.plan import Plan
from ..studies.compare.result import Comparison
from ..studies.folder import output_folder
from ..studies.table import number_text, shown_in
from ..support import option_values
from ..support.files import make_folder
from . import options, terminal
from .failures import failure
from .kept import kept
from .unmeant import warn_of_commands

_ROWS = 40  # on the terminal
_FEW = 20  # logs that --out writes unasked


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "compare", "Fly the same with several models or parameters.", compare
    )
    options.add_model(parser, nargs="+")
    options.add_vary(parser, " and engine")
    options.add_flight(parser)
    options.add_commands(parser)
    options.add_controller(parser)
    options.add_scenario(parser)
    options.add_jobs(parser)
    parser.add_argument(
        "--against",
        metavar="N",
        type=option_values.integer(1),
        help="number of the flight that the others are compared with (the first that flies)",
    )
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help=f"write report, table, plots and, of up to {_FEW} flights, logs here",
    )
    options.add_wrenches(parser)
    parser.add_argument("--logs", action="store_true", help="every log in --out, however many")
    parser.add_argument("--no-plots", action="store_true", help="no plots in --out")


def compare(arguments: argparse.Namespace) -> None:
    """Print how the models differ, fly them, and print how the flights differ."""
    plan = _plan(arguments)
    if arguments.against is not None and arguments.against > plan.count:
        raise InputError(f"--against {arguments.against}: there are {plan.count} flights")
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

    with kept("comparison", out, put), terminal.progress(arguments.quiet) as progress:
        comparison = fly(
            plan,
            _keeper(arguments, plan),
            arguments.jobs,
            progress,
            None if arguments.against is None else arguments.against - 1,
        )
    files = put(comparison, not arguments.no_plots)
    if not arguments.quiet:
        _show_flights(plan, comparison, files)
    _report_failures(plan, comparison)


def _plan(arguments: argparse.Namespace) -> Plan:
    axes = options.varied(arguments)
    if arguments.reference is not None and arguments.reference.isdigit():
        number = arguments.reference
        raise InputError(
            f"--reference {number}: names where to fly; the number of the flight that the others "
            f"are compared with is --against {number}"
        )
    if len(arguments.model) == 1 and not axes:
        raise InputError("one model and nothing varied; name another model, or use --vary")
    if arguments.logs and arguments.out is None:
        raise InputError("--logs needs --out")
    if arguments.wrenches and arguments.out is None:
        raise InputError("--wrenches needs --out, where the logs are")
    model = options.model_arguments(arguments)
    return Plan(
        model.pop("model"),
        axes,
        arguments.commands,
        arguments.duration,
        arguments.log_every,
        {
            **model,
            **options.flight_arguments(arguments),
            "spawn": arguments.spawn,
            "scenario": arguments.scenario,
            "wrenches": arguments.wrenches,
        },
        options.guidance_arguments(arguments),
    )


def _warn_of_commands(plan: Plan) -> None:
    if plan.guidance.is_given:
        return
    first = plan.flight(next(iter(plan)))
    try:
        simulation = first.simulation()
    except QuadcoreError:  # a row of the table, with its reason
        return
    warn_of_commands(simulation, first)


def _has_logs(arguments: argparse.Namespace, plan: Plan) -> bool:
    return arguments.logs or plan.count <= _FEW


def _keeper(arguments: argparse.Namespace, plan: Plan) -> Any:
    """Make what is done with each log: write it, and keep enough of some to draw."""
    out = arguments.out
    if out is None:
        return None
    to_draw = set() if arguments.no_plots else set(drawn(plan.count))
    has_logs = _has_logs(arguments, plan)
    remove_logs(out)
    if has_logs:
        make_folder(out / "logs")

    def keep(row: int, log: Log) -> Log | None:
        if has_logs:
            log.to_csv(out / log_name(row, plan.count))
        return thinned(log) if row in to_draw else None

    return keep


def _flight(arguments: argparse.Namespace, plan: Plan) -> dict[str, str]:
    """Describe what all flights share."""
    guided = plan.guidance.is_given
    given = options.flight_arguments(arguments)
    begins = ", ".join(f"{part:g}" for part in given.pop("spawn"))
    if guided and arguments.spawn is None and arguments.reference is not None:
        begins = "on the reference"
    shared = {
        "commands": None if guided else arguments.commands or "none",
        **options.guidance_arguments(arguments),
        "scenario": arguments.scenario,
        "duration": f"{arguments.duration:g} s",
        **given,
        "spawn": begins,
    }
    varied = [axis.name for axis in plan.axes]
    return {
        **{
            name: str(value)
            for name, value in shared.items()
            if value not in (None, 0) and name not in varied
        },
        **options.changes_told(arguments),
    }


def _show_models(plan: Plan) -> None:
    console = terminal.console()
    for model, found in plan.differences().items():
        console.print(f"{model} differs from {plan.names[0]} in")
        table = terminal.table("  what", "from", "to", "at", "and at")
        for d in found:
            table.add_row(f"  {d.what}", d.before, d.after, d.before_at or "-", d.after_at or "-")
        console.print(table if found else "  nothing that flies", "")
    if plan.axes:
        table = terminal.table("varied", "values", "as written")
        for axis in plan.axes:
            table.add_row(axis.name, listed(axis.values), plan.as_written(axis) or "-")
        console.print(table, "")


def _show_flights(plan: Plan, comparison: Comparison, files: list[Path]) -> None:
    console = terminal.console()
    whole = list(comparison.states)[:4]
    if comparison.against is not None:
        console.print(f"differences from no. {comparison.against + 1}, final / largest")
    units = {state: shown_in(comparison.states[state]) for state in whole}
    headings = [f"{state} ({unit})" for state, (unit, _) in units.items()]
    if plan.guidance.is_given:
        headings.insert(0, "to the reference (m), RMS / largest")
    table, failures = terminal.table("no.", "variant", *headings), []
    for number, (row, variant) in enumerate(zip(comparison.table, plan), start=1):
        if number > _ROWS:
            table.add_row("...", f"{plan.count - _ROWS} more")
            break
        cells = [
            " / ".join(number_text(row[f"{k}_{state}"] * factor) for k in ("final", "largest"))
            for state, (_, factor) in units.items()
        ]
        if plan.guidance.is_given:
            errors = [number_text(row[f"{kind}_error"]) for kind in ("rms", "largest")]
            cells.insert(0, " / ".join(errors))
        if row["failure"]:
            cells = ["failed"]
            failures.append(f"no. {number} ({plan.label(variant)}): {row['failure']}")
        table.add_row(str(number), plan.label(variant), *cells)
    console.print(table, "", *failures, summary(comparison), sep="\n")
    for file in files:
        console.print(f"written {file}")


def _report_failures(plan: Plan, comparison: Comparison) -> None:
    failed = [row for row, failure in enumerate(comparison.table["failure"]) if failure]
    if failed:
        first = failed[0]
        label = plan.label(next(islice(plan, first, None)))
        told = f"no. {first + 1} ({label}): {comparison.table['failure'][first]}"
        raise failure(len(failed), plan.count, comparison.refused, told)
