"""Numerical error of the plant: the change of a flight if the step is halved."""

from __future__ import annotations

from dataclasses import replace
from typing import Mapping, NamedTuple, Optional

import numpy as np

from ..._core import QuadcoreError
from ...simulation.engines import exerts_wrenches
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support.warning import suppress_warnings
from .intervals import EQUAL
from .plan import Plan

_LONGEST = 10.0  # s


class StepError(NamedTuple):
    """Change of a flight if its step is halved."""

    flight: str
    """Controller, model and engine."""
    step: float
    """Step of the study, s."""
    duration: float
    """Compared part of the flight, s."""
    position: Optional[float]
    """Maximum change of the position, m; None if the flight is random or fails."""

    def describe(self) -> str:
        """Describe the error in one line."""
        if self.position is None:
            return (
                "The numerical error of the plant is not measured: the flight is random or fails."
            )
        return (
            f"Numerical error of the plant: {self.position:.2g} m, the maximum change of the "
            f"position within {self.duration:g} s of {self.flight} if the step of "
            f"{1e3 * self.step:g} ms is halved."
        )


def measure_step_error(plan: Plan) -> Optional[StepError]:
    """Repeat the start of the first flight of a built-in controller at half the step.

    Parameters
    ----------
    plan
        Plan of the evaluation.

    Returns
    -------
    StepError or None
        Error; None without a built-in controller in an engine with plugins.
    """
    for names, flight in plan.list_built_in_flights():
        if exerts_wrenches(flight.engine):
            short = replace(flight, duration=min(_LONGEST, flight.duration))
            named = f"{_name(names)} on {plan.control.references[0]}"
            return StepError(named, short.step, short.duration, _compare(short))
    return None


def _name(names: Mapping[str, str]) -> str:
    return f"{names['controller']} ({names['model']}, {names['engine'].partition(',')[0]})"


def _compare(flight: FlightPlan) -> Optional[float]:
    """Return the maximum change of the position, m; None for a random or failed flight."""
    half = replace(flight, dt=flight.step / 2, log_every=2 * flight.log_every)
    other_seed = replace(flight, seed=flight.seed + 1)
    try:
        with suppress_warnings():
            log = flight.fly()
            if _change(log, other_seed.fly()) >= EQUAL:
                return None
            return _change(log, half.fly())
    except QuadcoreError:
        return None


def _change(log: Log, other: Log) -> float:
    rows = min(len(log), len(other))
    away = np.linalg.norm(log.position[:rows] - other.position[:rows], axis=1)
    return float(away.max())
