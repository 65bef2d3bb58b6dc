"""Computation time of controllers."""

from __future__ import annotations

from time import perf_counter
from typing import Any, List, Tuple

import numpy as np

from ..control.built_in import BuiltInController
from ..control.controller import check_callable
from ..simulation.controller_pilot import ControllerPilot


class TimedController:
    """User-defined controller with the duration of each call, s."""

    def __init__(self, controller: Any) -> None:
        check_callable(controller)
        self.seconds: List[float] = []
        self._controller = controller

    def __getattr__(self, name: str) -> Any:
        return getattr(self._controller, name)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Call the controller."""
        started = perf_counter()
        answer = self._controller(t, state, reference)
        self.seconds.append(perf_counter() - started)
        return answer


class TimedPilot:
    """Pilot of a built-in controller with the duration of each call, s, including its inputs."""

    def __init__(self, pilot: ControllerPilot) -> None:
        self.seconds: List[float] = []
        self._pilot = pilot

    def __getattr__(self, name: str) -> Any:
        return getattr(self._pilot, name)

    def speeds(self, simulation: Any) -> Any:
        """Return the rotor speeds of the controller."""
        started = perf_counter()
        answer = self._pilot.speeds(simulation)
        self.seconds.append(perf_counter() - started)
        return answer


def time_controller(controller: Any) -> Any:
    """Wrap a user-defined controller; built-in controllers are timed in their pilot."""
    return controller if isinstance(controller, BuiltInController) else TimedController(controller)


def summarise_durations(seconds: List[float]) -> Tuple[float, float]:
    """Return median and 99 % quantile, s; NaN without a call."""
    if not seconds:
        return float("nan"), float("nan")
    middle, slow = np.quantile(seconds, [0.5, 0.99])
    return float(middle), float(slow)
