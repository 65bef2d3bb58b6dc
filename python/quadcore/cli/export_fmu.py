"""``quadcore export-fmu``: a vehicle for other programs to fly."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .._core import InputError
from . import options
from .command_checks import refuse_log_every


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "export-fmu", "Write a vehicle as an FMU for co-simulation (FMI 2.0).", export
    )
    options.add_model(parser)
    options.add_flight(parser, log_every=None, has_end=False)
    options.add(parser, "scenario")
    parser.add_argument(
        "-o", "--output", metavar="FILE.fmu", type=Path, required=True, help="file to write"
    )


def export(arguments: argparse.Namespace) -> None:
    """Write the FMU."""
    from ..fmu.export import write_fmu

    if arguments.output.suffix.lower() != ".fmu":
        raise InputError(f"-o {arguments.output}: name a file that ends in .fmu")
    refuse_log_every(arguments, "an FMU")
    plan = options.flight_plan(arguments)
    write_fmu(arguments.output, plan)
    if not arguments.quiet:
        print(f"written {arguments.output}")
