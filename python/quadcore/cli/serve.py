"""``quadcore serve``: let another program control flights."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any, Sequence

from ..formats.rows import LogFile
from ..serve import Server
from ..serve.server import TIMEOUT
from ..simulation.flight import list_columns
from ..simulation.log import check_log_path, make_log_file
from ..studies.option_info import OUTPUT
from ..support import parse
from . import options, reading, terminal
from .parser import add_command, find_group


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "serve",
        "Let another program control flights over a local socket, in lockstep.",
        serve_clients,
        "quadcore serve quadrotor --port 5555 --log flight.csv",
    )
    options.add_model(parser)
    options.add_flight(parser, has_end=False)
    options.add_options(parser, "scenario", "wind")
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--port",
        metavar="N",
        type=parse.integer(0, 65535),
        default=0,
        help="port of 127.0.0.1 (default: any free port)",
    )
    where.add_argument("--socket", metavar="PATH", help="path of a Unix socket, which is created")
    find_group(parser, OUTPUT).add_argument(
        "--log",
        metavar="FILE",
        type=Path,
        help="log of the first flight, .csv, .mat or .bag; later flights are written to NAME-2 ...",
    )
    options.add_log_topics(parser)
    parser.add_argument(
        "--timeout",
        metavar="S",
        type=parse.positive,
        default=TIMEOUT,
        help="seconds after which a silent client is dropped: before its first request, within a "
        f"message, or while another client waits (default: {TIMEOUT:g})",
    )


def serve_clients(arguments: argparse.Namespace) -> None:
    """Serve clients until a signal ends the process."""
    plan = reading.make_flight_plan(arguments)
    simulation = plan.simulation()
    address = arguments.port if arguments.socket is None else arguments.socket
    topics = arguments.log_topics
    record = None
    if arguments.log is not None:
        check_log_path(arguments.log)
        record = _Logs(arguments.log, list_columns(simulation, topics), simulation.ignored).begin
    with Server(
        simulation, address, topics, record, arguments.log_every, arguments.timeout
    ) as server:
        if not arguments.quiet:
            print(f"serving {simulation.model.name} at {server.address}", flush=True)
        server.serve(terminal.print_message)


class _Logs:
    """Logs of successive flights: NAME.csv, NAME-2.csv and so on; existing files are kept."""

    def __init__(self, first: Path, columns: Sequence[str], ignored: Sequence[str]) -> None:
        self._first, self._columns, self._ignored = first, columns, ignored
        self._count = 0

    def begin(self) -> LogFile:
        """Open the log of the next flight."""
        self._count += 1
        path = self._first if self._count == 1 else self._name_numbered()
        while self._count > 1 and os.path.lexists(path):  # written by an earlier server
            self._count += 1
            path = self._name_numbered()
        return make_log_file(path, self._columns, (), self._ignored)

    def _name_numbered(self) -> Path:
        return self._first.with_name(f"{self._first.stem}-{self._count}{self._first.suffix}")
