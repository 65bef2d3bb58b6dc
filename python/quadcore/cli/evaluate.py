"""``quadcore evaluate``: how well controllers fly."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._core import InputError
from ..simulation.engines import STUDIED, list_engines
from ..studies.folder import output_folder
from ..support import option_values
from . import combinations, options, terminal
from .failures import failure
from .kept import kept
from .options_file import OptionsFile

if TYPE_CHECKING:
    from ..studies.evaluate.evaluate import Evaluation
    from ..studies.evaluate.plan import Plan

_ROWS = 40  # on the terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "evaluate", "Fly controllers along references, and measure them.", evaluate
    )
    combinations.add(parser)
    options.add_vary(parser, " and controller.KEY, its rate, delay or a parameter of the laws")
    options.add_flight(
        parser,
        [STUDIED],
        log_every=None,
        flown=list_engines(),
        seconds=30.0,
        begins="on the reference",
    )
    options.add_timing(parser)
    parser.add_argument(
        "--margins", action="store_true", help="search for gain and delay margins, too"
    )
    parser.add_argument(
        "--time-limit",
        metavar="S",
        type=option_values.positive,
        default=300.0,
        help="of the wall clock for one flight, s (300)",
    )
    options.add_jobs(parser)
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="write tables, pictures and a page here"
    )
    parser.add_argument("--no-plots", action="store_true", help="no pictures in --out")
    parser.set_defaults(parser=parser)


def evaluate(arguments: argparse.Namespace) -> None:
    """Fly everything, print how well, and write it."""
    from ..studies.evaluate.output import FILES

    if arguments.file is None:
        plan = _plan(arguments)
    else:
        file = OptionsFile(Path(arguments.file), arguments.parser)
        arguments = file.beneath(arguments)
        with file.blamed():
            plan = _plan(arguments)
    with output_folder(arguments.out, FILES):  # after the flights would be too late
        _evaluate(arguments, plan)


def _evaluate(arguments: argparse.Namespace, plan: Plan) -> None:
    from ..studies.evaluate.evaluate import conduct
    from ..studies.evaluate.output import write

    out = arguments.out

    def put(flown: Evaluation, plots: bool = False) -> list[Path]:
        return write(flown, plan, out, plots) if out is not None else []

    with kept("evaluation", out, put), terminal.progress(arguments.quiet) as progress:
        evaluation = conduct(
            plan, arguments.time_limit, arguments.jobs, progress, arguments.margins
        )
    files = put(evaluation, not arguments.no_plots)
    if not arguments.quiet:
        _show(evaluation, files)
    _report_failures(evaluation)


def _plan(arguments: argparse.Namespace) -> Plan:
    from ..studies.evaluate.plan import Plan

    for name in ("controller", "reference"):
        if getattr(arguments, name) is None:
            raise InputError(f"nothing to fly: name --{name}")
    shared = {**options.model_arguments(arguments), **options.flight_arguments(arguments)}
    for name in ("model", "engine", "spawn"):  # of which there are several, or none
        shared.pop(name)
    return Plan(
        arguments.controller,
        arguments.reference,
        arguments.engine,
        arguments.model,
        arguments.seeds,
        _varied(arguments),
        arguments.duration,
        arguments.log_every,
        arguments.spawn,
        arguments.controller_rate,
        arguments.delay,
        shared,
    )


def _varied(arguments: argparse.Namespace) -> dict[str, Any]:
    varied = options.varied(arguments)
    if arguments.scenario is None:
        return varied
    if "scenario" in varied:
        raise InputError("vary scenario: it is given by --scenario, too; keep one")
    return {"scenario": arguments.scenario, **varied}


def _show(evaluation: Evaluation, files: list[Path]) -> None:
    from ..studies.evaluate.output import causes, columns_to_read, rows_to_read, summary

    console = terminal.console()
    lines = rows_to_read(evaluation)
    shown = columns_to_read(lines)
    table = terminal.table(*shown.values(), "")
    for line in lines[:_ROWS]:
        table.add_row(*(line[name] for name in shown), line["best"])
    console.print(table)
    if evaluation.margins:
        console.print("", _margins(evaluation))
    if len(lines) > _ROWS:
        console.print(f"{len(lines) - _ROWS} more combinations")
    for cause in causes(evaluation):
        console.print(f"unstable: {cause}")
    console.print(summary(evaluation))
    for file in files:
        console.print(f"written {file}")


def _margins(evaluation: Evaluation) -> Any:
    from ..studies.evaluate.output import margins_to_read

    table = terminal.table("controller", "gain", "delay (s)", "box, median / worst (m)")
    for row in margins_to_read(evaluation):
        if row["failure"]:
            table.add_row(row["controller"], row["failure"])
            continue
        gain, box = (
            " / ".join(row[name] or "-" for name in names)
            for names in (("gain_low", "gain_high"), ("box_median", "box_worst"))
        )
        table.add_row(row["controller"], gain, row["delay_margin"] or "-", box)
    return table


def _report_failures(evaluation: Evaluation) -> None:
    failed = [row for row in evaluation.table if row["failure"]]
    if failed:
        first = failed[0]
        refused = sum(outcome.refused for outcome in evaluation.outcomes)
        told = (
            f"{first['controller']} on {first['reference']} in {first['engine']}, seed "
            f"{first['seed']}: {first['failure']}"
        )
        raise failure(len(failed), len(evaluation.table), refused, told)
