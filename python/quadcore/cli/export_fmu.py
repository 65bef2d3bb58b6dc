"""``quadcore export-fmu``: write a vehicle for other simulation programs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .._core import InputError
from . import options, reading, terminal
from .command_checks import refuse_log_every
from .parser import add_command


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "export-fmu",
        "Write a vehicle as a functional mock-up unit (FMU, FMI 2.0, co-simulation).",
        export_fmu,
        "quadcore export-fmu quadrotor --engine eigen -o quadrotor.fmu",
    )
    options.add_model(parser)
    options.add_flight(parser, log_every=None, has_end=False)
    options.add_options(parser, "scenario", "wind")
    parser.add_argument(
        "-o", "--output", metavar="FILE.fmu", type=Path, required=True, help="file to write"
    )


def export_fmu(arguments: argparse.Namespace) -> None:
    """Write the FMU."""
    from ..fmu.export import write_fmu

    if arguments.output.suffix.lower() != ".fmu":
        raise InputError(f"-o {arguments.output}: is not an FMU. Name a file that ends in .fmu.")
    refuse_log_every(arguments, "an FMU")
    plan = reading.make_flight_plan(arguments)
    write_fmu(arguments.output, plan)
    if not arguments.quiet:
        terminal.print_written([arguments.output])
