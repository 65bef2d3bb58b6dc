"""How much a controller forgives: margins by search, a sweep of its rate, a box of beliefs."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any, Dict, List, NamedTuple, Sequence

import numpy as np

from .. import laws
from ..flight_plan import FlightPlan
from .flights import flown
from .plan import Case, Plan, adjusted

LARGEST_GAIN = 10.0
LARGEST_DELAY = 0.5  # s
RATES = (1000.0, 500.0, 250.0, 125.0, 100.0, 50.0, 25.0)  # 1/s
BOX = {"believed_thrust": 0.1, "believed_drag": 0.5, "believed_lag": 0.3}
"""By how much beliefs may be wrong, as part of the right value; the corners are flown, too."""

_STEPS = 7  # of each bisection: 2 % of a gain, 1 % of the range of the delay
_SAMPLES = 16  # in the box
_FLOWN = "rms_position"


class Scaled:
    """A controller whose rotors push harder than it knows, by a factor.

    Attributes
    ----------
    rate, delay : float
        The controller's.
    """

    def __init__(self, controller: Any, factor: float) -> None:
        self._controller, self._root = controller, math.sqrt(factor)
        self.rate = getattr(controller, "rate", 500.0)
        self.delay = getattr(controller, "delay", 0.0)

    def reset(self, simulation: Any) -> None:
        """Let the controller begin anew."""
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Give the speeds whose squares are so many times those that were asked for."""
        return np.asarray(self._controller(t, state, reference)) * self._root


class Search(NamedTuple):
    """One thing to find out about one controller: on the first of everything else."""

    controller: int
    kind: str

    def made(self, plan: Plan, limit: float) -> Dict[str, float]:
        """Fly as often as it takes; the values that the table gets."""
        flight = plan.flight(Case(self.controller, 0, 0, 0, 0, plan.seeds[0]))
        found: Dict[str, float] = _KINDS[self.kind](flight, limit)
        return found


def searches(plan: Plan) -> List[Search]:
    """All of them."""
    return [Search(c, kind) for c in range(len(plan.controllers)) for kind in _KINDS]


def rows(plan: Plan, made: Sequence[Search], found: Sequence[Any]) -> List[Dict[str, Any]]:
    """Put what was found into a row per controller; the reason where nothing could be."""
    table: Dict[int, Dict[str, Any]] = {}
    for search, values in zip(made, found):
        row = table.setdefault(
            search.controller, {"controller": plan.controllers[search.controller], "failure": ""}
        )
        if isinstance(values, dict):
            row.update(values)
        else:
            row["failure"] = row["failure"] or values or "not flown: interrupted"
    return list(table.values())


def _gain(flight: FlightPlan, limit: float) -> Dict[str, float]:
    """Factors on the thrust of all rotors between which the vehicle is not lost."""

    def flies(factor: float) -> bool:
        return _flies(replace(flight, controller=_with_gain(flight.controller, factor)), limit)

    def edge(end: float) -> float:
        if not flies(1.0):
            return math.nan
        if flies(end):
            return end
        good, bad = 0.0, math.log(end)
        for _ in range(_STEPS):
            middle = (good + bad) / 2
            good, bad = (middle, bad) if flies(math.exp(middle)) else (good, middle)
        return math.exp(good)

    return {"gain_low": edge(1 / LARGEST_GAIN), "gain_high": edge(LARGEST_GAIN)}


def _delay(flight: FlightPlan, limit: float) -> Dict[str, float]:
    """Largest delay besides the controller's own with which the vehicle is not lost, s."""
    own = float(getattr(flight.controller, "delay", 0.0))

    def flies(delay: float) -> bool:
        controller = adjusted(_again(flight.controller), {"delay": own + delay})
        return _flies(replace(flight, controller=controller), limit)

    if not flies(0.0):
        return {"delay_margin": math.nan}
    good, bad = 0.0, 0.004
    while flies(bad):
        good, bad = bad, 2 * bad
        if good > LARGEST_DELAY:
            return {"delay_margin": good}
    for _ in range(_STEPS):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if flies(middle) else (good, middle)
    return {"delay_margin": good}


def _rates(flight: FlightPlan, limit: float) -> Dict[str, float]:
    """Error at each rate; NaN where the vehicle is lost."""
    found = {}
    for rate in RATES:
        controller = adjusted(_again(flight.controller), {"rate": rate})
        outcome = flown(replace(flight, controller=controller), limit)
        found[f"rms_at_{rate:g}_Hz"] = outcome.measures[_FLOWN]
    return found


def _box(flight: FlightPlan, limit: float) -> Dict[str, float]:
    """Worst and median error over wrong beliefs; the worst is infinite if a vehicle is lost."""
    if not isinstance(flight.controller, laws.Law):
        return {"box_median": math.nan, "box_worst": math.nan}
    corners = list(itertools.product(*((1 - part, 1 + part) for part in BOX.values())))
    inside = np.random.default_rng(0).uniform(-1, 1, (_SAMPLES, len(BOX)))
    points = [*corners, *(1 + inside * np.array(list(BOX.values()))).tolist()]
    errors = []
    for point in points:
        controller = adjusted(_again(flight.controller), dict(zip(BOX, point)))
        outcome = flown(replace(flight, controller=controller), limit)
        errors.append(math.inf if outcome.failure else outcome.measures[_FLOWN])
    return {"box_median": float(np.median(errors)), "box_worst": max(errors)}


_KINDS = {"gain": _gain, "delay": _delay, "rates": _rates, "box": _box}


def _again(controller: Any) -> Any:
    return controller.copy() if isinstance(controller, laws.Law) else controller


def _with_gain(controller: Any, factor: float) -> Any:
    if not isinstance(controller, laws.Law):
        return Scaled(controller, factor)
    believed = controller.parameters.get("believed_thrust", 1.0)
    return adjusted(controller.copy(), {"believed_thrust": believed / factor})


def _flies(flight: FlightPlan, limit: float) -> bool:
    return not flown(flight, limit).failure
