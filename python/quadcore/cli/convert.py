"""``quadcore convert``: a log in another format."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ..simulation.log import Log, check_log_path
from ..support.output_files import remove_left
from . import options


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "convert", "Write a log in another format, every bit kept.", convert
    )
    formats = ".csv, .mat or .bag"
    parser.add_argument("source", metavar="A", type=Path, help=f"a log: {formats}")
    parser.add_argument("target", metavar="B", type=Path, help=f"file to write: {formats}")


def convert(arguments: argparse.Namespace) -> None:
    """Read one, write the other."""
    check_log_path(arguments.target)
    remove_left(arguments.target)
    Log.of_file(arguments.source).to_file(arguments.target)
