"""Vehicle of ``quadcore run``: its plan, recorders and results."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Sequence, Tuple

from .._core import InputError
from ..formats.rows import Recorder
from ..simulation.clearance import Clearance
from ..simulation.flight import count_steps, list_columns
from ..simulation.log import check_log_path, make_log_file
from ..simulation.recording import DecimatedRows, FastestRotor, Recording, TrackingError
from . import run_folder, terminal
from .command_checks import warn_of_commands, warn_of_yaw_zero
from .run_summary import summarize

if TYPE_CHECKING:
    from ..simulation.flight_plan import FlightPlan
    from ..simulation.simulation import Simulation

Rows = Sequence[Tuple[str, str]]
"""Lines of a summary: pairs of a name and a text."""


class RunVehicle:
    """Vehicle with its pilot, the recorders of its flight, and the files to write.

    Parameters
    ----------
    arguments
        Options of the vehicle.
    plan : FlightPlan
        Plan of the flight.
    simulation : Simulation
        Simulation of the plan.
    """

    def __init__(
        self, arguments: argparse.Namespace, plan: FlightPlan, simulation: Simulation
    ) -> None:
        self.arguments, self.plan, self.simulation = arguments, plan, simulation
        self.pilot = plan.pilot(simulation)
        self.columns = list_columns(simulation, plan.topics, self.pilot)
        self.fastest = FastestRotor(simulation)
        self.clearance = Clearance(plan.model, plan.world)
        self.recorders: List[Recorder] = [self.fastest, self.clearance]
        self.errors = None
        if self.pilot is not None:
            self.errors = TrackingError(self.columns)
            self.recorders.append(self.errors)
        terms = simulation.wrench_terms if arguments.wrenches else []
        self.drawn = None
        if arguments.out is not None:
            steps = count_steps(plan.duration, simulation.dt)
            self.drawn = DecimatedRows(1 + steps // plan.log_every, self.columns, terms)
            self.recorders.append(self.drawn)
        self._logs = [
            make_log_file(file, self.columns, terms, simulation.ignored)
            for file in _check_log_files(arguments)
        ]
        self._described: List[Path] = []
        if arguments.out is not None:
            self._described = run_folder.write_description(arguments, plan, simulation)

    def open_recording(self) -> Recording:
        """Make the recording of the flight with all recorders."""
        self.recording = Recording(self._logs, self.recorders)
        return self.recording

    def keep_logs(self) -> None:
        """Close the logs of a flight that ended early, and print their paths."""
        for file in self.recording.close():
            terminal.print_message(f"log until t = {self.fastest.time:.6g} s: {file}")

    def summarize(self, elapsed: float) -> Dict[str, Any]:
        """Return the result of the flight as plain values by name."""
        return summarize(
            self.arguments,
            self.plan,
            self.simulation,
            self.fastest,
            self.clearance,
            elapsed,
            self.pilot,
            self.errors,
        )

    def write_results(self, logs: Sequence[Path], rows: Rows) -> List[Path]:
        """Write the plots and the page, and return the paths of all files."""
        files = list(logs)
        if self.drawn is not None:
            files += self._described
            files += run_folder.write_results(
                self.arguments, self.plan, self.simulation, self.drawn.log(), rows
            )
        return files

    def warn(self) -> None:
        """Warn about commands and references that do not suit the vehicle."""
        warn_of_commands(self.simulation, self.plan)
        if self.errors is not None:
            warn_of_yaw_zero(self.simulation, self.errors.max)


def print_result(rows: Rows, title: str = "") -> None:
    """Print the lines of a summary, if there are any."""
    if not rows:
        return
    table = terminal.make_table("", "", show_header=False)
    if title:
        table.title = title
    for row in rows:
        table.add_row(*row)
    terminal.make_console().print(table)


def print_files(files: Sequence[Path], rows: Rows) -> None:
    """Print the paths of the written files as further lines of the summary with these rows."""
    width = max(len(name) for name, _ in rows)
    named = [("" if i else "written", str(file)) for i, file in enumerate(files)]
    print_result([(name.ljust(width), file) for name, file in named])


def _check_log_files(arguments: argparse.Namespace) -> List[Path]:
    """Return the paths of the logs, after a check that they can be written."""
    files = list(arguments.log)
    if arguments.out is not None:
        files.insert(0, arguments.out / run_folder.LOG)
    for i, file in enumerate(files):
        check_log_path(file)
        if os.path.realpath(file) in [os.path.realpath(other) for other in files[:i]]:
            raise InputError(f"{file}: would be written twice. Name each log once.")
    return files
