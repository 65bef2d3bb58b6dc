"""``quadcore validate``: plant against mathematical model, as in the thesis' chapter 6.1."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Union

from rich.table import Table

from .._core import FlightError, InputError, QuadcoreError, engines
from ..simulation.flight_plan import FlightPlan
from ..studies.executor import run_contained
from ..support import interrupts, parse
from ..support.output_files import atomic_write, prepare_folder
from ..support.values import SPAWN
from . import options, terminal
from .interrupted_output import keep_partial_output

if TYPE_CHECKING:
    from ..thesis.validation import Chain, Experiment, Study


_OF_FLIGHTS = ("duration", "spawn", "seed", "log_every", "motors", "jobs")
"""Options that a recording leaves no room for."""


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "validate", "Compare engines with the mathematical model, and say why.", run
    )
    options.add_model(parser, nargs="?", default="quadrotor")
    options.add_flight(parser, [name for name, _ in engines()], log_every=10)
    options.add_commands(parser)
    parser.add_argument(
        "--sim-slow",
        metavar="LIST",
        type=parse.positive_numbers,
        help="slow-downs of the rotors (those of the thesis: 1,8,10,18)",
    )
    parser.add_argument(
        "--drag",
        metavar="LIST",
        type=lambda text: text.split(","),
        help="none, all, or those that act alone: profile and so on (each that the model has)",
    )
    parser.add_argument(
        "--motors",
        choices=("lag", "ideal"),
        default="lag",
        help="of the mathematical model: those of the engines, or none that lags (lag)",
    )
    parser.add_argument(
        "--plant",
        metavar="FILE",
        type=Path,
        help="judge this recording instead: a log of any Gazebo, .csv, .mat or .bag; without "
        "--commands its topic vel_cmd",
    )
    options.add(parser, "processes")
    options.add_out(parser, "page, tables and figures", "figures")
    of_flights = {name: parser.get_default(name) for name in _OF_FLIGHTS}
    parser.set_defaults(of_flights=of_flights)


def run(arguments: argparse.Namespace) -> None:
    """Fly everything, print how far it is from the model and why, and write it."""
    if arguments.plant is not None:
        return judge(arguments)
    # scipy and jinja2 are slow to import.
    from ..thesis.validation import Case, Experiment

    experiment = Experiment.of(
        **options.model_arguments(arguments),
        world=arguments.world,
        dt=arguments.dt,
        duration=arguments.duration,
        spawn=arguments.spawn or SPAWN,
        commands=arguments.commands,
        motor_lag=arguments.motors == "lag",
        log_every=arguments.log_every,
    )
    experiment.flight(Case("eigen")).simulation()  # says at once what is wrong or doubtful
    out = arguments.out
    if out is not None:
        prepare_folder(out, ["report.html"])  # after the flights would be too late
    study = _conduct(experiment, arguments)
    failures = _row_failures(study)
    if out is not None:
        page, *tables = _write(study, out)
    if not arguments.quiet:
        _show(study)
    if out is not None:
        drawn = {} if arguments.no_plots else _draw(study, arguments, failures)
        if not arguments.quiet:
            beside = len(tables) + len(drawn)
            terminal.console().print(f"written {page} and {beside} tables and figures beside it")
    if failures:
        raise FlightError(failures[0])


def judge(arguments: argparse.Namespace) -> None:
    """Print how far a recording is from the model and the engines, and write it."""
    from ..thesis.validation import recorded_plant
    from ..thesis.validation.output import size

    for option in ("sim_slow", "drag"):
        if getattr(arguments, option) is not None:
            raise InputError(
                f"--plant is one flight; give its --{option.replace('_', '-')} by --set"
            )
    for name, default in arguments.of_flights.items():
        if getattr(arguments, name) != default:
            option = f"--{name.replace('_', '-')}"
            raise InputError(f"--plant judges the flight that was recorded; leave {option} out")
    plan = FlightPlan.of(
        **options.model_arguments(arguments), world=arguments.world, dt=arguments.dt
    )
    if arguments.out is not None:
        prepare_folder(arguments.out, ["plant.csv"])
    rows = list(recorded_plant.judge(plan, arguments.plant, arguments.commands, arguments.engine))
    if arguments.out is not None:
        with atomic_write(arguments.out / "plant.csv") as stream:
            stream.write(recorded_plant.table_of(rows, len(plan.model.joints)))
    if not arguments.quiet:
        console = terminal.console()
        console.print(f"{arguments.plant}: largest difference from")
        table = terminal.table("", *_JUDGED, numbers=True)
        for row in rows:
            largest = row.difference.max if row.difference else {}
            table.add_row(row.plant, *(size(largest[n]) if largest else "failed" for n in _JUDGED))
        console.print(table)
        if arguments.out is not None:
            console.print(f"written {arguments.out / 'plant.csv'}")
    failed = [row for row in rows if row.failure]
    if failed:
        raise FlightError(f"{failed[0].plant}: {failed[0].failure}")


_JUDGED = ("position", "attitude", "velocity", "rates")
"""m, rad, m/s, rad/s."""


def _conduct(experiment: Experiment, arguments: argparse.Namespace) -> Study:
    """Fly; what was flown before an interrupt is written."""
    from ..thesis.validation import conduct

    def put(study: Study) -> None:
        _write(study, arguments.out)

    with keep_partial_output("study", arguments.out, put), terminal.progress(
        arguments.quiet
    ) as progress:
        return conduct(
            experiment,
            arguments.engine,
            arguments.sim_slow,
            arguments.drag,
            arguments.jobs,
            progress,
        )


def _write(study: Study, out: Path) -> List[Path]:
    """Write page and tables, before any picture is drawn: flights are not flown twice."""
    from ..thesis.validation.output import write_report, write_tables

    with interrupts.hold_signals():
        tables = write_tables(study, out)
        return [write_report(study, {}, out), *tables]


def _draw(study: Study, arguments: argparse.Namespace, failures: List[str]) -> Dict[str, bytes]:
    """Write each picture as soon as it is drawn, and then the page with all of them."""
    from ..thesis.validation.figures import pictures
    from ..thesis.validation.output import write_picture, write_report

    wanted = pictures(study)
    names = list(wanted)
    drawn: Dict[str, bytes] = {}
    failed: List[str] = []

    def draw(name: str) -> bytes:
        function, what = wanted[name]
        return function(*what)

    try:
        with terminal.progress(arguments.quiet, "drawing") as progress:

            def take(index: int, picture: Union[bytes, QuadcoreError]) -> None:
                name = names[index]
                if isinstance(picture, QuadcoreError):
                    failed.append(f"{name}: {picture}")
                else:
                    write_picture(name, picture, arguments.out)
                    drawn[name] = picture

            run_contained(draw, names, take, arguments.jobs, progress=progress)
    finally:
        in_order = {name: drawn[name] for name in names if name in drawn}
        with interrupts.hold_signals():
            write_report(study, in_order, arguments.out)
    if failed:
        failures.append(f"{len(failed)} of {len(names)} pictures failed; the first, {failed[0]}")
    return in_order


def _row_failures(study: Study) -> List[str]:
    """Say how many flights failed, and why the first did, if any did."""
    failed = [row for row in study.rows if row.failure]
    if not failed:
        return []
    case = failed[0].case
    return [
        f"{len(failed)} of {len(study.rows)} flights failed; the first ({case.plant}, "
        f"sim_slow {case.sim_slow:g}, drag {case.drag}): {failed[0].failure}"
    ]


def _show(study: Study) -> None:
    console = terminal.console()
    console.print("largest distance from the mathematical model (m)")
    console.print(_distances(study), "")
    for chain in study.chains:
        if chain.drag == study.drags[-1]:
            console.print(_chain(study, chain), "")


def _distances(study: Study) -> Table:
    from ..thesis.validation import Case
    from ..thesis.validation.output import size

    table = terminal.table("engine", "sim_slow", *study.drags, numbers=True)
    rows = {row.case: row.difference for row in study.rows}
    for engine in study.engines:
        for slow in study.sim_slow:
            differences = [rows[Case(engine, slow, drag)] for drag in study.drags]
            cells = [size(d.max["distance"]) if d else "failed" for d in differences]
            table.add_row(engine, f"{slow:g}", *cells)
    return table


def _chain(study: Study, chain: Chain) -> Table:
    from ..thesis.validation.output import size

    start = f"{study.engines[0]}, sim_slow {chain.sim_slow:g}, drag {chain.drag}: because of"
    table = terminal.table(start, "share (m)", "max (m)", numbers=True)
    for link in chain.links:
        table.add_row(link.change, size(link.share), size(link.max))
    table.add_row(chain.failure or f"sum, at {chain.time:.2f} s", size(chain.distance), "")
    return table
