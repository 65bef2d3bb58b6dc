"""``quadcore play``: animate logs in a browser, a page or a GIF."""

from __future__ import annotations

import argparse
import threading
from pathlib import Path
from typing import Any, List, Optional, Sequence, Tuple

from .._core import InputError
from ..model import resources
from ..report.cameras import CAMERAS
from ..simulation.log import Log
from ..studies.options import OUTPUT, VEHICLE
from ..support import parse
from ..support.output_files import atomic_write, check_writable, encode_text
from . import options, terminal
from .parser import add_command, complete_from, find_group
from .run_folder import find_logs, find_vehicle, find_world


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "play",
        "Animate logs in a browser, a page or a GIF.",
        play_logs,
        """
        quadcore play out/hover
        quadcore play a.csv b.csv --model hexarotor --names before,after -o flights.html
        quadcore play out/hover --gif hover.gif --camera whole
        """,
    )
    add_logs(parser)
    find_group(parser, OUTPUT).add_argument(
        "-o",
        "--out",
        metavar="PAGE.html",
        type=Path,
        help="page to write (default: show the page in the browser until Ctrl-C)",
    )
    find_group(parser, OUTPUT).add_argument(
        "--gif",
        metavar="FILE.gif",
        type=Path,
        help="animation to write, 560 x 360 px; needs Chromium or Chrome",
    )
    find_group(parser, OUTPUT).add_argument(
        "--camera",
        choices=CAMERAS,
        default=CAMERAS[0],
        help=f"camera at the start, and of the GIF (default: {CAMERAS[0]})",
    )
    model = find_group(parser, VEHICLE).add_argument(
        "--model",
        metavar="MODEL",
        help="model that gives the shapes of the vehicle (default: that of the folder that `run` "
        "wrote, else a star of arms)",
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


def play_logs(arguments: argparse.Namespace) -> None:
    """Read the logs, and write what was asked for, or show the page in the browser."""
    from ..report.player import PlayerFlight, make_page  # jinja2 is slow to import

    logs, names = read_logs(arguments)
    _check_output(arguments.out, (".html", ".htm"), "a page")
    _check_output(arguments.gif, (".gif",), "a GIF")
    flights = [
        PlayerFlight(name, Log.of_file(log, arguments.mapping), find_vehicle(log, arguments.model))
        for name, log in zip(names, logs)
    ]
    page = make_page(flights, ", ".join(names), find_world(logs), arguments.camera)
    written = []
    if arguments.out is not None:
        written += _write(arguments.out, encode_text(page))
    if arguments.gif is not None:
        from ..report.gif import make_gif

        written += _write(arguments.gif, make_gif(page))
    if not written:
        _show(page, arguments.quiet)
    elif not arguments.quiet:
        terminal.print_written(written)


def _check_output(file: Optional[Path], suffixes: Sequence[str], kind: str) -> None:
    if file is None:
        return
    if file.suffix.lower() not in suffixes:
        raise InputError(f"{file}: is not {kind}. Name a file that ends in {suffixes[0]}.")
    check_writable(file)


def _write(file: Path, content: bytes) -> List[Path]:
    with atomic_write(file) as stream:
        stream.write(content)
    return [file]


def _show(page: str, quiet: bool) -> None:
    """Serve a page to the browser of this machine until a signal ends the process."""
    from ..report.page_server import PageServer, open_browser

    server = PageServer(page)
    if not open_browser(server.url) or not quiet:
        print(f"showing {server.url} until Ctrl-C", flush=True)
    try:
        threading.Event().wait()
    finally:
        server.close()


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
