"""``quadcore validate``: plant against mathematical model, as in the thesis' chapter 6.1."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict

from rich.table import Table

from .._core import FlightError, QuadcoreError
from ..files import check_writable, make_folder
from ..parallel import each
from . import options, terminal

if TYPE_CHECKING:
    from ..validation import Chain, Study


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "validate", "Compare engines with the mathematical model, and say why.", run
    )
    options.add_model(parser, nargs="?")
    options.add_flight(parser, several_engines=True, log_every=10)
    options.add_commands(parser)
    parser.add_argument(
        "--sim-slow",
        metavar="LIST",
        type=options.positive_numbers,
        default=[1.0, 8.0, 18.0],
        help="slow-downs of the rotors (1,8,18)",
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
    options.add_jobs(parser)
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="write page, tables and figures here"
    )
    parser.add_argument("--no-plots", action="store_true", help="no figures in --out")
    parser.set_defaults(model="quadrotor")


def run(arguments: argparse.Namespace) -> None:
    """Fly everything, print how far it is from the model and why, and write it."""
    # scipy and jinja2 are slow to import.
    from ..validation import Case, Experiment, conduct
    from ..validation.output import write

    experiment = Experiment.of(
        **options.model_arguments(arguments),
        world=arguments.world,
        dt=arguments.dt,
        duration=arguments.duration,
        spawn=arguments.spawn,
        commands=arguments.commands,
        motor_lag=arguments.motors == "lag",
        log_every=arguments.log_every,
    )
    experiment.simulation(Case("eigen"))  # says at once what is wrong or doubtful
    if arguments.out is not None:
        make_folder(arguments.out)
        check_writable(arguments.out / "report.html")  # after the flights would be too late
    with terminal.progress(arguments.quiet) as progress:
        study = conduct(
            experiment,
            arguments.engine,
            arguments.sim_slow,
            arguments.drag,
            arguments.jobs,
            progress,
        )
    console = terminal.console()
    if not arguments.quiet:
        console.print("largest distance from the mathematical model (m)")
        console.print(_distances(study), "")
        for chain in study.chains:
            if chain.drag == study.drags[-1]:
                console.print(_chain(study, chain), "")
    if arguments.out is not None:
        pictures = {} if arguments.no_plots else _draw(study, arguments)
        page, *others = write(study, pictures, arguments.out)
        if not arguments.quiet:
            console.print(f"written {page} and {len(others)} tables and figures beside it")
    failures = [row for row in study.rows if row.failure]
    if failures:
        case = failures[0].case
        raise FlightError(
            f"{len(failures)} of {len(study.rows)} flights failed; the first ({case.plant}, "
            f"sim_slow {case.sim_slow:g}, drag {case.drag}): {failures[0].failure}"
        )


def _draw(study: Study, arguments: argparse.Namespace) -> Dict[str, bytes]:
    from ..validation.figures import pictures

    wanted = pictures(study)
    names = list(wanted)
    drawn: Dict[str, bytes] = {}

    def draw(name: str) -> bytes:
        function, what = wanted[name]
        return function(*what)

    with terminal.progress(arguments.quiet, "drawing") as progress:
        for index, picture in each(draw, names, arguments.jobs):
            if isinstance(picture, QuadcoreError):
                raise picture
            drawn[names[index]] = picture
            if progress is not None:
                progress(len(drawn), len(names))
    return {name: drawn[name] for name in names}


def _distances(study: Study) -> Table:
    from ..validation import Case
    from ..validation.output import size

    table = terminal.table("engine", "sim_slow", *study.drags, numbers=True)
    rows = {row.case: row.difference for row in study.rows}
    for engine in study.engines:
        for slow in study.sim_slow:
            differences = [rows[Case(engine, slow, drag)] for drag in study.drags]
            cells = [size(d.largest["distance"]) if d else "failed" for d in differences]
            table.add_row(engine, f"{slow:g}", *cells)
    return table


def _chain(study: Study, chain: Chain) -> Table:
    from ..validation.output import size

    start = f"{study.engines[0]}, sim_slow {chain.sim_slow:g}, drag {chain.drag}: because of"
    table = terminal.table(start, "share (m)", "largest (m)", numbers=True)
    for link in chain.links:
        table.add_row(link.change, size(link.share), size(link.largest))
    table.add_row(chain.failure or f"sum, at {chain.time:.2f} s", size(chain.distance), "")
    return table
