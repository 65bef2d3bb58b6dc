"""How long a controller takes by itself."""

from __future__ import annotations

from time import perf_counter
from typing import Any, List, Tuple

import numpy as np

from ..control.built_in import BuiltInController
from ..control.controller import check_callable
from ..simulation.controller_pilot import Guided


class TimedController:
    """A controller of one's own, with the seconds that each call took; the rest is its own."""

    def __init__(self, controller: Any) -> None:
        check_callable(controller)
        self.seconds: List[float] = []
        self._controller = controller

    def __getattr__(self, name: str) -> Any:
        return getattr(self._controller, name)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Ask the controller."""
        started = perf_counter()
        answer = self._controller(t, state, reference)
        self.seconds.append(perf_counter() - started)
        return answer


class TimedPilot:
    """A pilot of a law of quadcore, with the same; it reads odometry and reference on the way."""

    def __init__(self, pilot: Guided) -> None:
        self.seconds: List[float] = []
        self._pilot = pilot

    def __getattr__(self, name: str) -> Any:
        return getattr(self._pilot, name)

    def speeds(self, simulation: Any) -> Any:
        """Ask the law."""
        started = perf_counter()
        answer = self._pilot.speeds(simulation)
        self.seconds.append(perf_counter() - started)
        return answer


def time_controller(controller: Any) -> Any:
    """Make a controller that is timed; a law of quadcore is by its pilot."""
    return controller if isinstance(controller, BuiltInController) else TimedController(controller)


def summarise_durations(seconds: List[float]) -> Tuple[float, float]:
    """Median, and what one call of a hundred exceeds, s; NaN without any."""
    if not seconds:
        return float("nan"), float("nan")
    middle, slow = np.quantile(seconds, [0.5, 0.99])
    return float(middle), float(slow)
