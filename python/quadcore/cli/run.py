"""``quadcore run``: one flight."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table

from .. import interrupts
from .._core import FlightError
from ..files import make_folder
from ..log import Log, check_log_path
from ..rotation import roll_pitch_yaw
from ..simulation import Simulation
from . import options, terminal


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(commands, "run", "Fly once.", run)
    options.add_model(parser)
    options.add_flight(parser)
    options.add_commands(parser)
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="write log.csv and plots here; made if missing"
    )
    parser.add_argument("--log", metavar="FILE", type=Path, help="write the log here, .csv or .mat")
    parser.add_argument("--no-plots", action="store_true", help="no plots in --out")


def run(arguments: argparse.Namespace) -> None:
    """Fly, write what was asked for, and print a summary."""
    simulation = options.simulation(arguments)
    files = _log_files(arguments)
    started = time.perf_counter()
    try:
        with terminal.progress(arguments.quiet) as progress:
            log = simulation.run(
                arguments.duration, arguments.commands, arguments.log_every, progress
            )
    except (FlightError, KeyboardInterrupt) as stop:
        partial = getattr(stop, "log", None)
        if partial is not None:
            _write(partial, files)
            for file in files:
                print(f"log until t = {partial.time[-1]:.6g} s: {file}", file=sys.stderr)
        raise
    elapsed = time.perf_counter() - started
    _write(log, files)
    if arguments.out is not None and not arguments.no_plots:
        files += log.plot(arguments.out)
    if not arguments.quiet:
        terminal.console().print(_summary(simulation, log, elapsed, files))


def _log_files(arguments: argparse.Namespace) -> list[Path]:
    """Name the logs to write and try each now: after the flight would be too late."""
    files = []
    if arguments.out is not None:
        make_folder(arguments.out)
        files.append(arguments.out / "log.csv")
    if arguments.log is not None:
        files.append(arguments.log)
    for file in files:
        check_log_path(file)
    return files


def _write(log: Log, files: list[Path]) -> None:
    with interrupts.held():
        for file in files:
            log.to_file(file)


def _summary(simulation: Simulation, log: Log, elapsed: float, files: list[Path]) -> Table:
    table = Table(box=None, show_header=False, pad_edge=False)
    steps = round(simulation.time / simulation.dt)
    attitude = np.degrees(roll_pitch_yaw(simulation.state.orientation))
    fastest = np.abs(log.rotor_velocity).max(initial=0.0)
    rows = [
        ("flown", f"{simulation.model.name}, {simulation.engine}"),
        ("duration", f"{simulation.time:.9g} s"),
        ("steps", f"{steps}, {steps / elapsed:,.0f} per s"),
        ("final position", "{:.6f}, {:.6f}, {:.6f} m".format(*simulation.state.position)),
        ("final roll, pitch, yaw", "{:.4f}, {:.4f}, {:.4f} deg".format(*attitude)),
        ("fastest rotor", f"{fastest:.3f} rad/s"),
    ]
    for i, file in enumerate(files):
        rows.append(("" if i else "written", str(file)))
    for row in rows:
        table.add_row(*row)
    return table
