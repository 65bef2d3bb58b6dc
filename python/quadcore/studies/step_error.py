"""Numerical error of the plant: the change of a flight with half the step."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import NamedTuple, Optional

import numpy as np

from .._core import QuadcoreError
from ..control import controllers
from ..control.built_in import BuiltInController
from ..simulation.engines import exerts_wrenches
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import Log
from ..support.warning import suppress_warnings
from .executor import call_apart
from .time_limit import time_limit
from .tracking_metrics import EQUAL

_LONGEST = 10.0  # s; maximum duration of the compared part
_SUBSTITUTE = "geometric"
"""Built-in controller that replaces user-defined ones; the error is that of the plant only."""


class StepError(NamedTuple):
    """Change of a flight when its step is halved."""

    flight: str
    """Description of the flight and its conditions."""
    step: float
    """Step of the study, s."""
    duration: float
    """Duration of the compared part of the flight, s."""
    position: Optional[float]
    """Maximum change of position, m; None if the flight is random, fails or exceeds the limit."""

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


def compute_step_error(name: str, flight: FlightPlan, limit: float) -> Optional[StepError]:
    """Repeat the start of a flight with half the step.

    The flights run in a separate process. The built-in controller `geometric` replaces a
    user-defined controller.

    Parameters
    ----------
    name
        Description of the flight.
    flight
        Flight with the step of the study, either open loop or with a reference.
    limit
        Wall-clock limit of each flight, s.

    Returns
    -------
    StepError or None
        Numerical error; None for an engine without plugins.
    """
    if not exerts_wrenches(flight.engine):
        return None
    if flight.commands is None and not isinstance(flight.controller, BuiltInController):
        flight = replace(flight, controller=controllers.parse(_SUBSTITUTE, flight.model.name))
        name = f"{name}, with {_SUBSTITUTE} as its controller"
    short = replace(flight, duration=min(_LONGEST, flight.duration))
    try:
        change = call_apart(partial(_compare, short, limit))
    except QuadcoreError:  # includes errors of a user-defined reference
        change = None
    return StepError(name, short.step, short.duration, change)


def _compare(flight: FlightPlan, limit: float) -> Optional[float]:
    """Return the maximum change of position, m; None for a random flight."""
    half = replace(flight, dt=flight.step / 2, log_every=2 * flight.log_every)
    other_seed = replace(flight, seed=flight.seed + 1)

    def fly(plan: FlightPlan) -> Log:
        with time_limit(limit), suppress_warnings():
            return plan.fly()

    log = fly(flight)
    return None if _change(log, fly(other_seed)) >= EQUAL else _change(log, fly(half))


def _change(log: Log, other: Log) -> float:
    rows = min(len(log), len(other))
    away = np.linalg.norm(log.position[:rows] - other.position[:rows], axis=1)
    return float(away.max())
