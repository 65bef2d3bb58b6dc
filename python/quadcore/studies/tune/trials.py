"""Flights that evaluate gains, and their results."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Iterator, Mapping, NamedTuple, Sequence

import numpy as np

from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...simulation.simulation import Simulation
from ...simulation.state import State
from ...support import rotation
from ..tracking_metrics import compute_errors, describe_failure, find_failure_time

OFFSET, TURN = (0.3, -0.2, 0.25), (0.1, -0.1, 0.2)
"""Initial offset from the reference in world axes (m), and rotation about body axes (rad)."""
RETURN_TIME = 10.0
"""Duration of the return from the offset, s."""
_LAST = 2.0  # s; final part in which the distance is measured
_REMAINDER = 0.5  # maximum remaining part of the offset; z of `pd` has a pole at -0.22 1/s


class Trial(NamedTuple):
    """Flight for the evaluation of gains."""

    label: str
    """Name of the reference; with several models, points or seeds, also their names."""
    plan: FlightPlan
    """Plan without a controller."""
    values: Mapping[str, float]
    """Values of the point that belong to the controller."""
    has_offset: bool = False
    """Whether the flight starts at `OFFSET` and `TURN` from the reference."""

    def make_plan(self, controller: Any) -> FlightPlan:
        """Add a controller to the plan, and the offset if there is one."""
        if not self.has_offset:
            return replace(self.plan, controller=controller)
        values = {each.name: getattr(self.plan, each.name) for each in fields(self.plan)}
        return _OffsetPlan(**{**values, "controller": controller})


class Flown(NamedTuple):
    """Simulated flight of a trial."""

    log: Log
    failure: str
    """Reason for the failure; "" for success."""


class TrialResult(NamedTuple):
    """Result of a trial with some gains."""

    error: float
    """RMS tracking error, m. From a failure on, the error is the failure distance."""
    failure: str
    """Reason for the failure; "" for success."""


@dataclass(frozen=True, eq=False)
class _OffsetPlan(FlightPlan):
    """Plan of a flight that starts at an offset."""

    def list_placements(self, simulation: Simulation) -> Iterator[State]:
        yield from super().list_placements(simulation)
        state = simulation.state.copy()
        state.position = state.position + OFFSET
        state.orientation = rotation.turn(state.orientation, np.array(TURN))
        yield state


def judge(trial: Trial, flown: Flown, failure_distance: float) -> TrialResult:
    """Compute the result of a trial; this runs no code of the controller.

    Parameters
    ----------
    trial, flown
        Trial, and its simulated flight.
    failure_distance
        Tracking error above which a flight has failed, m.
    """
    log, failure = flown
    away = compute_errors(log)
    away = np.minimum(np.nan_to_num(away, nan=failure_distance), failure_distance)
    late = find_failure_time(log, failure_distance)
    if late is not None:
        failure = describe_failure(log, failure_distance)
        away[log.time >= late] = failure_distance
    # The missing rest of a failed flight counts as failed.
    rest = max(0.0, 1 - (log.time[-1] - log.time[0]) / trial.plan.duration) if failure else 0.0
    square = (1 - rest) * np.mean(away**2) + rest * failure_distance**2
    return TrialResult(float(np.sqrt(square)), failure)


def judge_return(flown: Sequence[Flown]) -> str:
    """Check that a flight from an offset approaches the flight from the reference.

    On the reference, a controller with a perfect model hardly uses its gains. They are needed to
    correct an offset.

    Parameters
    ----------
    flown
        Result of `Problem.simulate_return`.

    Returns
    -------
    str
        Reason for the failure; "" for success.
    """
    if flown[-1].failure:
        return flown[-1].failure
    logs = [each.log for each in flown]
    apart = np.linalg.norm(logs[0].position - logs[1].position, axis=1)
    left = float(apart[logs[0].time > logs[0].time[-1] - _LAST].max())
    if left <= _REMAINDER * apart[0]:
        return ""
    offset = float(apart[0])
    return f"{left:.3g} m of an offset of {offset:.3g} m remain after {RETURN_TIME:g} s"
