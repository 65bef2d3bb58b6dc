"""``quadcore serve``: flights driven from outside."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any, Sequence

from ..formats.rows import LogFile
from ..serve import Server
from ..serve.server import TIMEOUT
from ..simulation.flight import columns_of
from ..simulation.log import check_log_path, log_file
from ..support import parse
from . import options, terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "serve", "Let a program drive a flight over a local socket, in lockstep.", serve
    )
    options.add_model(parser)
    options.add_flight(parser, has_end=False)
    options.add(parser, "scenario")
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--port",
        metavar="N",
        type=parse.integer(0, 65535),
        default=0,
        help="port of 127.0.0.1 (any that is free)",
    )
    where.add_argument("--socket", metavar="PATH", help="path of a unix socket to make")
    parser.add_argument(
        "--log",
        metavar="FILE",
        type=Path,
        help="write the log of the first flight here, .csv, .mat or .bag, of others to NAME-2 ...",
    )
    options.add_log_topics(parser)
    parser.add_argument(
        "--timeout",
        metavar="S",
        type=parse.positive,
        default=TIMEOUT,
        help=f"drop a client that is silent for S seconds before its first request, within a "
        f"message, or while another one waits ({TIMEOUT:g})",
    )


def serve(arguments: argparse.Namespace) -> None:
    """Serve clients until a signal comes."""
    plan = options.flight_plan(arguments)
    simulation = plan.simulation()
    address = arguments.port if arguments.socket is None else arguments.socket
    topics = arguments.log_topics
    record = None
    if arguments.log is not None:
        check_log_path(arguments.log)
        record = _Logs(arguments.log, columns_of(simulation, topics), simulation.ignored).begin
    with Server(
        simulation, address, topics, record, arguments.log_every, arguments.timeout
    ) as server:
        if not arguments.quiet:
            print(f"serving {simulation.model.name} at {server.address}", flush=True)
        server.serve(terminal.say)


class _Logs:
    """A file for each flight: NAME.csv, NAME-2.csv ...; numbers that are taken are left out."""

    def __init__(self, first: Path, columns: Sequence[str], ignored: Sequence[str]) -> None:
        self._first, self._columns, self._ignored = first, columns, ignored
        self._begun = 0

    def begin(self) -> LogFile:
        """Open the next."""
        self._begun += 1
        path = self._first if self._begun == 1 else self._numbered()
        while self._begun > 1 and os.path.lexists(path):  # of an earlier server, perhaps
            self._begun += 1
            path = self._numbered()
        return log_file(path, self._columns, (), self._ignored)

    def _numbered(self) -> Path:
        return self._first.with_name(f"{self._first.stem}-{self._begun}{self._first.suffix}")
