"""Recorded flights, aligned with a reference and measured like simulated ones."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ..._core import InputError, Rotor
from ...control import references
from ...formats.recordings.recording import interpolate_orientation
from ...formats.recordings.series import Series
from ...report.decimation import decimate
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...simulation.simulation import Simulation
from ...simulation.trajectory import find_speed_limit
from ...support.output_files import printable_name
from ...support.warning import warn
from ..criteria import Criteria
from ..grouped_flights import FlightRecord
from ..measured_flight import Outcome, measure_record
from ..tracking_errors import sample_flat_states
from ..tracking_metrics import RotorData

FIND = "find"
"""Alignment that requests a search."""

Alignment = Union[float, str]
"""Time in the log at which the reference begins, s, or `FIND`."""

_EVEN = 0.01  # relative to the row spacing; rows with larger deviations are uneven
_GAP = 10  # in row spacings; a longer gap gives a warning
_OVERLAP = 0.5  # minimum share of the log after the start of the reference
_SHIFTS = 2000  # maximum number of shifts in the coarse search, both sides together


class RecordedFlight(NamedTuple):
    """A recorded flight along a reference."""

    label: str
    """Label in tables, such as the name of the controller."""
    file: str
    begin: float
    """Time in the log at which the reference begins, s."""
    is_found: bool
    """Whether a search found `begin`."""
    spacing: float
    """Time between rows, s."""
    was_even: bool
    """Whether the rows of the file are evenly spaced. Otherwise they are interpolated."""
    log: Log
    """Evenly spaced log in the time of the reference, with topics ``reference`` and ``error``."""

    def describe(self) -> str:
        """Describe the alignment and the rows in one line."""
        how = "found by the minimum RMS error" if self.is_found else "as given"
        rows = f"{len(self.log)} rows every {self.spacing:.4g} s"
        rows += "" if self.was_even else ", interpolated because those of the file are uneven"
        return f"{self.file}: the reference begins at {self.begin:.4g} s of the log, {how}; {rows}."

    def make_record(
        self, plan: FlightPlan, simulation: Simulation, needs_flat_states: bool
    ) -> FlightRecord:
        """Make the record of the flight; `plan` and `simulation` define vehicle and world."""
        log, flat_states = _add_rotors(self.file, self.log, simulation.rotors), None
        if needs_flat_states:
            flat_states = sample_flat_states(simulation, plan, log.time)
        return FlightRecord(
            log=log,
            failure="",
            calls=0,
            saturated=math.nan,
            variation=None,
            seconds=np.empty(0),
            warnings=[],
            rate=math.nan,
            delay=math.nan,
            is_vectorized=False,
            rotors=[RotorData.of(rotor) for rotor in simulation.rotors],
            limit=find_speed_limit(simulation.rotors),
            model=plan.model,
            world=plan.world,
            elapsed=math.nan,
            flat_states=flat_states,
        )

    def measure(self, plan: FlightPlan, simulation: Simulation, criteria: Criteria) -> Outcome:
        """Compute the metrics; `plan` and `simulation` define vehicle and world."""
        record = self.make_record(plan, simulation, criteria.needs_flat_states)
        outcome = measure_record(record, criteria, keep=True)
        if outcome.flew and not self.log.rotor_velocity.shape[1]:
            outcome.measures.update(effort=math.nan, energy=math.nan)
        return outcome._replace(log=decimate(self.log))


def read_recorded_flight(label: str, given: Union[str, Path, Log], mapping: Any) -> Tuple[str, Log]:
    """Return the name and the log of a file; raise `InputError` if it cannot be read."""
    if isinstance(given, Log):
        return given.title or label, given
    return printable_name(given), Log.of_file(given, mapping)


def align_flight(
    label: str,
    file: str,
    log: Log,
    reference: Any,
    alignment: Alignment,
    duration: Optional[float] = None,
) -> RecordedFlight:
    """Align a log with a reference.

    Parameters
    ----------
    label, file
        Names for tables and messages.
    log
        Log, possibly with unevenly spaced rows.
    reference
        Function of the time t (s), which starts at t = 0.
    alignment
        Time in the log at which the reference begins, s, or `FIND`.
    duration
        Time after the start of the reference at which the log is cut, s. Default: the whole log.

    Raises
    ------
    InputError
        If fewer than two rows remain.
    """
    table, spacing, was_even = _make_even(file, log)
    is_found = alignment == FIND
    begin = _find_begin(table, spacing, reference) if is_found else float(alignment)
    time = table[:, 0] - begin
    kept = time >= -1e-9
    if duration is not None:
        kept &= time <= duration + 1e-9
    if kept.sum() < 2:
        raise InputError(
            f"{file}: no rows are left after the reference begins at {begin:.4g} s. Correct the "
            "alignment."
        )
    table = table[kept].copy()
    table[:, 0] = time[kept]
    wanted = references.sample_positions(reference, table[:, 0])
    error = table[:, 1:4] - wanted[:, :3]
    topics = {
        "reference": dict(zip(("x", "y", "z", "yaw"), wanted.T)),
        "error": dict(zip("xyz", error.T)),
    }
    aligned = Log(table, title=label, ignored=log.ignored, topics=topics)
    return RecordedFlight(label, file, begin, is_found, spacing, was_even, aligned)


def _make_even(file: str, log: Log) -> Tuple[np.ndarray, float, bool]:
    """Return evenly spaced rows, their spacing (s), and whether the rows of the log were even."""
    if len(log) < 2:
        raise InputError(f"{file}: the log has {len(log)} rows. Record at least two.")
    steps = np.diff(log.time)
    spacing = float(np.median(steps))
    if np.abs(steps - spacing).max() <= _EVEN * spacing:
        return log.table, spacing, True
    longest = int(steps.argmax())
    if steps[longest] > _GAP * spacing:
        warn(
            f"{file}: there are no rows from t = {log.time[longest]:.4g} s to "
            f"{log.time[longest + 1]:.4g} s; the metrics use interpolated ones."
        )
    time = log.time[0] + spacing * np.arange(int((log.time[-1] - log.time[0]) / spacing + 1e-6) + 1)
    columns: List[np.ndarray] = [np.interp(time, log.time, column) for column in log.table.T]
    table = np.column_stack(columns)
    table[:, 4:8] = interpolate_orientation(Series(log.time, log.orientation), time)
    return table, spacing, False


def _find_begin(table: np.ndarray, spacing: float, reference: Any) -> float:
    """Find the time in a log (s) at which the reference begins, by the minimum RMS error."""
    from scipy.optimize import minimize_scalar  # slow to import

    time, position = table[:, 0], table[:, 1:4]
    reach = (1 - _OVERLAP) * (time[-1] - time[0])
    grid = np.linspace(0, (time[-1] - time[0]) + reach, 4 * len(time))
    known = references.sample_positions(reference, grid)[:, :3]

    def compute_error(begin: float) -> float:
        since = time - begin
        kept = since >= 0
        wanted = np.column_stack([np.interp(since[kept], grid, axis) for axis in known.T])
        return float(np.mean(np.sum((position[kept] - wanted) ** 2, axis=1)))

    step = max(spacing, 2 * reach / _SHIFTS)
    shifts = time[0] + step * np.arange(-int(reach / step), int(reach / step) + 1)
    errors = [compute_error(shift) for shift in shifts]
    # Of equally good times, such as periods of a circle, take the nearest to the start of the log.
    good = np.flatnonzero(np.array(errors) <= 1.01 * min(errors) + 1e-12)
    best = shifts[good[np.abs(shifts[good] - time[0]).argmin()]]
    found = minimize_scalar(compute_error, bounds=(best - step, best + step), method="bounded")
    return float(found.x)


def _add_rotors(file: str, log: Log, rotors: Sequence[Rotor]) -> Log:
    """Return the log with rotor columns; they are zero if the file contains none."""
    count = log.rotor_velocity.shape[1]
    if count == len(rotors):
        return log
    if count:
        raise InputError(
            f"{file}: the log has {count} rotors, and the model has {len(rotors)}. Name the model "
            "of the log's vehicle."
        )
    table = np.hstack([log.table, np.zeros((len(log), len(rotors)))])
    return Log(table, topics=log.topics)
