"""``quadcore convert``: write a log in another format."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ..simulation.log import Log, check_log_path
from ..support.output_files import remove_leftovers
from . import options
from .parser import add_command

_FORMATS = ".csv, .mat, .bag, a ROS 2 bag .ros2"


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "convert",
        "Convert a log to another format; the numbers of quadcore's own logs stay bit-identical.",
        convert_log,
        """
        quadcore convert out/spiral/log.csv spiral.mat
        quadcore convert flight.ulg flight.csv
        quadcore convert out/spiral/log.csv spiral.ros2
        """,
    )
    parser.add_argument(
        "source",
        metavar="A",
        type=Path,
        help=f"log to read: {_FORMATS}, or a recording of a "
        "real flight: ULog, Crazyflie micro-SD, blackbox, CSV, bag",
    )
    options.add_mapping(parser)
    parser.add_argument("target", metavar="B", type=Path, help=f"log to write: one of {_FORMATS}")


def convert_log(arguments: argparse.Namespace) -> None:
    """Read a log, and write it in another format."""
    check_log_path(arguments.target)
    remove_leftovers(arguments.target)
    Log.of_file(arguments.source, arguments.mapping).to_file(arguments.target)
