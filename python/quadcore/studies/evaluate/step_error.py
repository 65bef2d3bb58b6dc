"""Numerical error of the plant: the change of a flight if the step is halved."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Mapping, NamedTuple, Optional

import numpy as np

from ..._core import QuadcoreError
from ...simulation.engines import exerts_wrenches
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support.warning import suppress_warnings
from ..executor import call_apart
from ..time_limit import time_limit
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
    """Maximum change of the position, m; None if the flight is random, fails, or is too slow."""

    def describe(self) -> str:
        """Describe the error in one line."""
        if self.position is None:
            return (
                "The numerical error of the plant is not measured: the flight is random, fails, or "
                "exceeds the time limit."
            )
        return (
            f"Numerical error of the plant: {self.position:.2g} m, the maximum change of the "
            f"position within {self.duration:g} s of {self.flight} if the step of "
            f"{1e3 * self.step:g} ms is halved."
        )


def measure_step_error(plan: Plan) -> Optional[StepError]:
    """Repeat the start of the first flight of a built-in controller at half the step.

    The flights run in a process of their own, each within the time limit of the plan.

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
            change = call_apart(partial(_compare, short, plan.options.time_limit))
            return StepError(named, short.step, short.duration, change)
    return None


def _name(names: Mapping[str, str]) -> str:
    return f"{names['controller']} ({names['model']}, {names['engine'].partition(',')[0]})"


def _compare(flight: FlightPlan, limit: float) -> Optional[float]:
    """Return the maximum change of the position, m; None for a random or failed flight.

    Parameters
    ----------
    flight
        Flight at the step of the study.
    limit
        Wall-clock limit of each flight, s.
    """
    half = replace(flight, dt=flight.step / 2, log_every=2 * flight.log_every)
    other_seed = replace(flight, seed=flight.seed + 1)

    def fly(plan: FlightPlan) -> Log:
        with time_limit(limit), suppress_warnings():
            return plan.fly()

    try:
        log = fly(flight)
        return None if _change(log, fly(other_seed)) >= EQUAL else _change(log, fly(half))
    except QuadcoreError:
        return None


def _change(log: Log, other: Log) -> float:
    rows = min(len(log), len(other))
    away = np.linalg.norm(log.position[:rows] - other.position[:rows], axis=1)
    return float(away.max())
