"""``quadcore play``: make a page that animates logs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List, Sequence, Tuple

from .._core import InputError
from ..model import resources
from ..simulation.log import Log
from ..studies.options import OUTPUT, VEHICLE
from ..support import parse
from ..support.output_files import atomic_write, check_writable, encode_text
from . import options, terminal
from .parser import add_command, complete_from, find_group
from .run_folder import find_logs, find_vehicle

_PAGE = "play.html"


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "play",
        "Make a page that animates logs.",
        make_page,
        """
        quadcore play out/hover
        quadcore play a.csv b.csv --model hexarotor --names before,after -o flights.html
        """,
    )
    add_logs(parser)
    find_group(parser, OUTPUT).add_argument(
        "-o",
        "--out",
        metavar="PAGE.html",
        type=Path,
        help=f"page to write (default: {_PAGE} next to the first log)",
    )
    model = find_group(parser, VEHICLE).add_argument(
        "--model",
        metavar="MODEL",
        help="model that gives the places of the rotors (default: that of the folder that `run` "
        "wrote, else a cross)",
    )
    complete_from(model, list(resources.list_shipped("urdf")))
    options.add_quiet(parser)


def add_logs(parser: argparse.ArgumentParser) -> None:
    """Add the logs, and the option that names them."""
    parser.add_argument(
        "logs",
        metavar="LOG",
        nargs="+",
        type=Path,
        help="log of quadcore (.csv, .mat or .bag); recording of a real flight (ULog, Crazyflie "
        "micro-SD, blackbox, CSV, bag); or a folder that `run` or `compare` wrote",
    )
    options.add_mapping(parser)
    find_group(parser, OUTPUT).add_argument(
        "--names",
        metavar="A,B",
        type=parse.names,
        help="names of the flights (default: the part in which their paths differ)",
    )


def make_page(arguments: argparse.Namespace) -> None:
    """Read the logs and write the page."""
    from ..report.player import PlayerFlight  # jinja2 is slow to import
    from ..report.player import make_page as render_page

    logs, names = read_logs(arguments)
    out = arguments.out or logs[0].parent / _PAGE
    if out.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{out}: is not a page. Name a file that ends in .html.")
    check_writable(out)
    flights = [
        PlayerFlight(name, Log.of_file(log, arguments.mapping), find_vehicle(log, arguments.model))
        for name, log in zip(names, logs)
    ]
    text = render_page(flights, ", ".join(names))
    with atomic_write(out) as stream:
        stream.write(encode_text(text))
    if not arguments.quiet:
        terminal.print_written([out])


def read_logs(arguments: argparse.Namespace) -> Tuple[List[Path], List[str]]:
    """Find the logs that `add_logs` asked for, and name each flight."""
    logs = [log for path in arguments.logs for log in find_logs(path)]
    if arguments.names is None:
        return logs, _name_by_path(logs, arguments.logs)
    if len(arguments.names) != len(logs):
        raise InputError(
            f"--names: {len(arguments.names)} name(s) for {len(logs)} flight(s). Name each flight."
        )
    return logs, arguments.names


def _name_by_path(logs: Sequence[Path], given: Sequence[Path]) -> List[str]:
    """Name logs by the part in which their paths differ: out/ode/log.csv, out/eigen/log.csv."""
    if len(logs) == 1:
        return [given[0].resolve().name if given[0] != logs[0] else logs[0].stem]
    parts: List[Tuple[str, ...]] = [log.with_suffix("").parts for log in logs]
    if len(set(logs)) < len(logs):
        twice = next(log for i, log in enumerate(logs) if log in logs[:i])
        raise InputError(f"{twice}: is named twice. Name each log once.")
    if len(set(parts)) < len(parts):  # a.csv and a.mat
        return [str(log) for log in logs]
    while len({path[-1] for path in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [path[:-1] for path in parts]
    while len({path[0] for path in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [path[1:] for path in parts]
    return ["/".join(path) for path in parts]
