"""``quadcore export-fmu``: a vehicle for other programs to fly."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from .._core import InputError
from ..simulation.flight_plan import FlightPlan
from . import options
from .unmeant import refuse_log_every


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(
        commands, "export-fmu", "Write a vehicle as an FMU for co-simulation (FMI 2.0).", export
    )
    options.add_model(parser)
    options.add_flight(parser, log_every=None, seconds=None)
    options.add_scenario(parser)
    parser.add_argument(
        "-o", "--output", metavar="FILE.fmu", type=Path, required=True, help="file to write"
    )


def export(arguments: argparse.Namespace) -> None:
    """Write the FMU."""
    from ..fmu.export import write_fmu

    if arguments.output.suffix.lower() != ".fmu":
        raise InputError(f"-o {arguments.output}: name a file that ends in .fmu")
    refuse_log_every(arguments, "an FMU")
    plan = FlightPlan.of(
        **options.model_arguments(arguments),
        **options.flight_arguments(arguments),
        scenario=arguments.scenario,
        duration=math.inf,
    )
    write_fmu(arguments.output, plan)
    if not arguments.quiet:
        print(f"written {arguments.output}")
