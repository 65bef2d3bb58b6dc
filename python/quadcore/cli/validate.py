"""``quadcore validate``: compare engines with the mathematical model of thesis chapter 2."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Union

from rich.table import Table

from .._core import FlightError, InputError, QuadcoreError, engines
from ..report.drawing import Drawing
from ..simulation.flight_plan import FlightPlan
from ..studies.executor import run_contained
from ..studies.option_info import FLIGHT, STUDY
from ..support import interrupts, parse
from ..support.output_files import atomic_write, prepare_folder
from ..support.values import SPAWN
from . import options, reading, terminal
from .interrupted_output import keep_partial_output
from .parser import add_command, find_group

if TYPE_CHECKING:
    from ..thesis.validation import Chain, Experiment, Study


_OF_FLIGHTS = ("duration", "spawn", "seed", "log_every", "motors", "jobs")
"""Options that cannot be used with a recorded flight."""


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "validate",
        "Compare engines with the mathematical model, and attribute their differences.",
        validate_engines,
        """
        quadcore validate --out out/validation
        quadcore validate --plant gazebo.bag
        """,
    )
    options.add_model(parser, nargs="?", default="quadrotor")
    options.add_flight(parser, [name for name, _ in engines()], log_every=10)
    options.add_commands(parser)
    study = find_group(parser, STUDY)
    study.add_argument(
        "--sim-slow",
        metavar="A,B",
        type=parse.positive_numbers,
        help="slowdowns of the rotors (default: those of the thesis, 1,8,10,18)",
    )
    study.add_argument(
        "--drag",
        metavar="A,B",
        type=lambda text: text.split(","),
        help="rotor drag terms: none, all, or single terms such as profile (default: none, all and "
        "each term of the model)",
    )
    study.add_argument(
        "--motors",
        choices=("lag", "ideal"),
        default="lag",
        help="motors of the mathematical model: as in the engines, or without lag (default: lag)",
    )
    find_group(parser, FLIGHT).add_argument(
        "--plant",
        metavar="FILE",
        type=Path,
        help="compare this recorded flight instead: a log of any Gazebo, .csv, .mat or .bag. "
        "Without --commands, its topic vel_cmd commands the rotors",
    )
    options.add_options(parser, "processes")
    options.add_out(parser, "page, tables and figures", "figures")
    options.add_json(parser)
    of_flights = {name: parser.get_default(name) for name in _OF_FLIGHTS}
    parser.set_defaults(of_flights=of_flights)


def validate_engines(arguments: argparse.Namespace) -> None:
    """Simulate all flights, and print and write their differences with the causes."""
    if arguments.plant is not None:
        return judge_recording(arguments)
    # slow to import
    from ..thesis.validation import Case, Experiment

    experiment = Experiment.of(
        **reading.read_model_arguments(arguments),
        world=arguments.world,
        dt=arguments.dt,
        duration=arguments.duration,
        spawn=arguments.spawn or SPAWN,
        commands=arguments.commands,
        motor_lag=arguments.motors == "lag",
        log_every=arguments.log_every,
    )
    experiment.flight(Case("eigen")).simulation()
    out = arguments.out
    if out is not None:
        prepare_folder(out, ["report.html"])  # checking after the flights would be too late
    study = _conduct(experiment, arguments)
    failures = _describe_failures(study)
    if out is not None:
        page, *tables = _write(study, out)
    if arguments.json:
        terminal.print_json(_describe(study))
    elif not arguments.quiet:
        _show(study)
    if out is not None:
        drawn = {} if arguments.no_plots else _draw(study, arguments, failures)
        if not (arguments.quiet or arguments.json):
            count = len(tables) + len(drawn)
            terminal.make_console().print(
                f"written {page} and {count} tables and figures next to it"
            )
    if failures:
        raise FlightError(failures[0])


def judge_recording(arguments: argparse.Namespace) -> None:
    """Print and write the differences of a recording from the model and the engines."""
    from ..thesis.validation import recorded_plant
    from ..thesis.validation.output import size

    for option in ("sim_slow", "drag"):
        if getattr(arguments, option) is not None:
            raise InputError(
                f"--plant is one flight. Give its --{option.replace('_', '-')} with --set."
            )
    for name, default in arguments.of_flights.items():
        if getattr(arguments, name) != default:
            option = f"--{name.replace('_', '-')}"
            raise InputError(f"--plant is a recorded flight. Leave {option} out.")
    plan = FlightPlan.of(
        **reading.read_model_arguments(arguments), world=arguments.world, dt=arguments.dt
    )
    if arguments.out is not None:
        prepare_folder(arguments.out, ["plant.csv"])
    rows = list(recorded_plant.replay(plan, arguments.plant, arguments.commands, arguments.engine))
    if arguments.out is not None:
        with atomic_write(arguments.out / "plant.csv") as stream:
            stream.write(recorded_plant.write_table(rows, len(plan.model.joints)))
    if arguments.json:
        terminal.print_json([_describe_judged(row) for row in rows])
    elif not arguments.quiet:
        console = terminal.make_console()
        console.print(f"{arguments.plant}: maximum difference from")
        table = terminal.make_table("", *_JUDGED, numbers=True)
        for row in rows:
            largest = row.difference.max if row.difference else {}
            table.add_row(row.plant, *(size(largest[n]) if largest else "failed" for n in _JUDGED))
        console.print(table)
        if arguments.out is not None:
            terminal.print_written([arguments.out / "plant.csv"])
    failed = [row for row in rows if row.failure]
    if failed:
        raise FlightError(f"{failed[0].plant}: {failed[0].failure}")


_JUDGED = ("position", "attitude", "velocity", "rates")
"""States in the table: m, rad, m/s, rad/s."""


def _conduct(experiment: Experiment, arguments: argparse.Namespace) -> Study:
    """Simulate all flights; on an interrupt, write the completed flights."""
    from ..thesis.validation import run_study

    def write_tables_so_far(study: Study) -> None:
        _write(study, arguments.out)

    with keep_partial_output("study", arguments.out, write_tables_so_far), terminal.show_progress(
        arguments.quiet
    ) as progress:
        return run_study(
            experiment,
            arguments.engine,
            arguments.sim_slow,
            arguments.drag,
            arguments.jobs,
            progress,
        )


def _write(study: Study, out: Path) -> List[Path]:
    """Write the page and the tables before figures are drawn."""
    from ..thesis.validation.output import write_report, write_tables

    with interrupts.hold_signals():
        tables = write_tables(study, out)
        return [write_report(study, {}, out), *tables]


def _draw(study: Study, arguments: argparse.Namespace, failures: List[str]) -> Dict[str, Drawing]:
    """Write each figure when it is drawn, and then the page with all figures."""
    from ..thesis.validation.figures import list_figures
    from ..thesis.validation.output import write_figure, write_report

    wanted = list_figures(study)
    names = list(wanted)
    drawn: Dict[str, Drawing] = {}
    failed: List[str] = []

    def draw(name: str) -> Drawing:
        function, what = wanted[name]
        return function(*what)

    try:
        with terminal.show_progress(arguments.quiet, "drawing") as progress:

            def take(index: int, picture: Union[Drawing, QuadcoreError]) -> None:
                name = names[index]
                if isinstance(picture, QuadcoreError):
                    failed.append(f"{name}: {picture}")
                else:
                    write_figure(name, picture, arguments.out)
                    drawn[name] = picture

            run_contained(draw, names, take, arguments.jobs, progress=progress)
    finally:
        in_order = {name: drawn[name] for name in names if name in drawn}
        with interrupts.hold_signals():
            write_report(study, in_order, arguments.out)
    if failed:
        failures.append(f"{len(failed)} of {len(names)} figures failed. The first one: {failed[0]}")
    return in_order


def _describe_failures(study: Study) -> List[str]:
    """Describe the number of failed flights and the first failure."""
    failed = [row for row in study.rows if row.failure]
    if not failed:
        return []
    case = failed[0].case
    return [
        f"{len(failed)} of {len(study.rows)} flights failed. The first one ({case.plant}, "
        f"sim_slow {case.sim_slow:g}, drag {case.drag}): {failed[0].failure}"
    ]


def _show(study: Study) -> None:
    console = terminal.make_console()
    console.print("maximum distance from the mathematical model (m)")
    console.print(_make_distance_table(study), "")
    for chain in study.chains:
        if chain.drag == study.drags[-1]:
            console.print(_make_cause_table(study, chain), "")


def _describe(study: Study) -> Dict[str, Any]:
    """Describe the maximum differences of each flight and their causes as plain values."""
    return {
        "flights": [
            {
                **row.case._asdict(),
                "max": dict(row.difference.max) if row.difference else None,
                "failure": row.failure,
            }
            for row in study.rows
        ],
        "causes": [
            {
                "sim_slow": chain.sim_slow,
                "drag": chain.drag,
                "time": chain.time,
                "distance": chain.distance,
                "failure": chain.failure,
                "links": [link._asdict() for link in chain.links],
            }
            for chain in study.chains
        ],
    }


def _describe_judged(row: Any) -> Dict[str, Any]:
    largest = dict(row.difference.max) if row.difference else None
    return {"plant": row.plant, "max": largest, "failure": row.failure}


def _make_distance_table(study: Study) -> Table:
    from ..thesis.validation import Case
    from ..thesis.validation.output import size

    table = terminal.make_table("engine", "sim_slow", *study.drags, numbers=True)
    rows = {row.case: row.difference for row in study.rows}
    for engine in study.engines:
        for slow in study.sim_slow:
            differences = [rows[Case(engine, slow, drag)] for drag in study.drags]
            cells = [size(d.max["distance"]) if d else "failed" for d in differences]
            table.add_row(engine, f"{slow:g}", *cells)
    return table


def _make_cause_table(study: Study, chain: Chain) -> Table:
    from ..thesis.validation.output import size

    start = f"{study.engines[0]}, sim_slow {chain.sim_slow:g}, drag {chain.drag}: cause"
    table = terminal.make_table(start, "share (m)", "max (m)", numbers=True)
    for link in chain.links:
        table.add_row(link.change, size(link.share), size(link.max))
    table.add_row(chain.failure or f"sum, at {chain.time:.2f} s", size(chain.distance), "")
    return table
