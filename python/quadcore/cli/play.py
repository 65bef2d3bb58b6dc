"""``quadcore play``: a page on which logs can be watched."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, List, Sequence, Tuple

from .._core import InputError
from ..model.description import read_model
from ..simulation.log import Log
from ..support import parse
from ..support.output_files import atomic_write, check_writable, text_bytes
from . import options, terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(commands, "play", "Make a page that plays logs.", play)
    parser.add_argument("logs", metavar="LOG", nargs="+", type=Path, help="log, .csv, .mat or .bag")
    parser.add_argument(
        "-o", "--out", metavar="PAGE.html", type=Path, required=True, help="the page to write"
    )
    parser.add_argument(
        "--model",
        metavar="MODEL",
        help="whose rotors are drawn where they are, as for `quadcore run`; without, a cross",
    )
    add_names(parser)
    parser.add_argument("--quiet", action="store_true", help="print warnings and errors only")


def add_names(parser: argparse.ArgumentParser) -> None:
    """Add the option that names logs."""
    parser.add_argument(
        "--names",
        metavar="NAME,NAME",
        type=parse.names,
        help="what the flights are called (what their paths differ by)",
    )


def play(arguments: argparse.Namespace) -> None:
    """Read the logs and write the page."""
    from ..report.player import PlayerFlight, make_page  # not every command should pay for jinja2

    if arguments.out.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{arguments.out}: name a file that ends in .html, which it would hold")
    check_writable(arguments.out)
    names = names_of(arguments)
    rotors = None if arguments.model is None else read_model(arguments.model).joint_places
    flights = [
        PlayerFlight(name, Log.of_file(file), rotors) for name, file in zip(names, arguments.logs)
    ]
    text = make_page(flights, ", ".join(names))
    with atomic_write(arguments.out) as stream:
        stream.write(text_bytes(text))
    if not arguments.quiet:
        terminal.console().print(f"written {arguments.out}")


def names_of(arguments: argparse.Namespace) -> List[str]:
    """Name each log, as `add_names` asked for."""
    names: List[str] = arguments.names or _names(arguments.logs)
    if len(names) != len(arguments.logs):
        raise InputError(f"--names: {len(names)} for {len(arguments.logs)} logs; name each")
    return names


def _names(logs: Sequence[Path]) -> List[str]:
    """Call each log by what its path differs by: out/ode/log.csv, out/eigen/log.csv: ode, eigen."""
    if len(logs) == 1:
        return [logs[0].stem]
    parts: List[Tuple[str, ...]] = [log.with_suffix("").parts for log in logs]
    if len(set(logs)) < len(logs):
        twice = next(log for i, log in enumerate(logs) if log in logs[:i])
        raise InputError(f"{twice}: is named twice; name each log once")
    if len(set(parts)) < len(parts):  # a.csv and a.mat
        return [str(log) for log in logs]
    while len({path[-1] for path in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [path[:-1] for path in parts]
    while len({path[0] for path in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [path[1:] for path in parts]
    return ["/".join(path) for path in parts]
