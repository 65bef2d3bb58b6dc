"""``quadcore play``: animate logs in a browser, a page or a GIF."""

from __future__ import annotations

import argparse
import threading
from pathlib import Path
from typing import Any, List, Optional, Sequence

from .._core import InputError
from ..model import resources
from ..report.cameras import CAMERAS
from ..studies.option_info import OUTPUT, VEHICLE
from ..support.output_files import atomic_write, check_writable, encode_text
from . import options, terminal
from .parser import add_command, complete_from, find_group
from .played_flights import add_logs, find_flights, find_world, read_player_flight


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
        help="model that gives the shapes of the vehicle (default: that of the folder, else "
        "a star of arms)",
    )
    complete_from(model, list(resources.list_shipped("urdf")))
    options.add_quiet(parser)


def play_logs(arguments: argparse.Namespace) -> None:
    """Read the logs, and write the requested files or show the page in the browser."""
    from ..report.player import make_page  # jinja2 is slow to import

    played = find_flights(arguments)
    _check_output(arguments.out, (".html", ".htm"), "a page")
    _check_output(arguments.gif, (".gif",), "a GIF")
    flights = [read_player_flight(each, arguments.mapping, arguments.model) for each in played]
    title = ", ".join(flight.name for flight in flights)
    page = make_page(flights, title, find_world(played), arguments.camera)
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
