"""Margins of a controller: gain, delay, update rate, and model errors.

The controller has the nominal model of the vehicle, while thrust, drag and motor lag of the
simulated vehicle are scaled. Built-in controllers receive the nominal model directly, user-defined
ones in `reset`.
"""

from __future__ import annotations

import itertools
import math
from typing import (
    AbstractSet,
    Any,
    Callable,
    Collection,
    Dict,
    Generator,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Sequence,
    Tuple,
)

import numpy as np

from ..measured_flight import Outcome
from ..table import NOT_FLOWN
from .trial import Trial

LARGEST_GAIN = 10.0
LARGEST_DELAY = 0.5  # s
ENDS = {"gain_low": 1 / LARGEST_GAIN, "gain_high": LARGEST_GAIN, "delay_margin": LARGEST_DELAY}
"""Ends of the search range; a margin at an end may exceed it."""
RATES = (1000.0, 500.0, 250.0, 125.0, 100.0, 50.0, 25.0)  # 1/s
BOX = {"thrust": 0.1, "drag": 0.5, "lag": 0.3}
"""Relative model errors: the corners of this box and random points inside are simulated."""

NAMES = (*ENDS, *(f"rms_at_{rate:g}_Hz" for rate in RATES), "box_median", "box_worst")

_STEPS = 7  # per bisection: 2 % of a gain, 1 % of the range of the delay
_SAMPLES = 16  # random points in the box
_FIRST_DELAY = 0.004  # s
_TRIALS = 60  # per controller, about
_METRIC = "rms_position"

Found = Dict[str, float]
Search = Generator[List[Trial], List[Outcome], Found]
Fly = Callable[[List[Trial]], List[Outcome]]


class MarginSearch:
    """Search for the margins of controllers, on the first reference, engine, model and scenario.

    Parameters
    ----------
    controllers
        Names of the controllers.
    lacking
        Effects that no tag of the vehicle scales; see `list_missing_effects`.
    """

    def __init__(self, controllers: Sequence[str], lacking: Collection[str]) -> None:
        self._rows: List[Dict[str, Any]] = [
            {"controller": name, "failure": NOT_FLOWN, **dict.fromkeys(NAMES, math.nan)}
            for name in controllers
        ]
        self._kinds = [kind.search for kind in _KINDS if not kind.varies & set(lacking)]
        self._done: Dict[Trial, Outcome] = {}

    @property
    def expected(self) -> int:
        """Approximate number of flights."""
        return _TRIALS * len(self._rows)

    def run(self, fly: Fly) -> None:
        """Run all searches in parallel; `fly` simulates the trials of each round."""
        running: List[Tuple[int, Search]] = []
        as_it_is = self._fly_new(fly, [Trial(row) for row in range(len(self._rows))])
        for trial, outcome in as_it_is.items():
            if outcome.flew:
                running += [(trial.controller, kind(trial)) for kind in self._kinds]
            else:
                self._rows[trial.controller]["failure"] = outcome.failure
        asked = [(row, search, next(search)) for row, search in running]
        while asked:
            self._fly_new(fly, [trial for *_, trials in asked for trial in trials])
            asked = list(self._advance(asked))
        for row, _ in running:
            self._rows[row]["failure"] = ""

    def list_rows(self) -> List[Dict[str, Any]]:
        """Return a row per controller: `NAMES`, and the failure that prevented a search."""
        return [dict(row) for row in self._rows]

    def _fly_new(self, fly: Fly, trials: Sequence[Trial]) -> Mapping[Trial, Outcome]:
        new = [trial for trial in dict.fromkeys(trials) if trial not in self._done]
        self._done.update(zip(new, fly(new)))
        return self._done

    def _advance(self, asked: Sequence[Tuple[int, Search, List[Trial]]]) -> Iterator[Any]:
        for row, search, trials in asked:
            try:
                yield row, search, search.send([self._done[trial] for trial in trials])
            except StopIteration as stop:
                self._rows[row].update(stop.value)


def _search_gain(own: Trial) -> Search:
    """Find the range of scaling of thrust and torque without failure."""

    def at(logarithm: float) -> Trial:
        return own._replace(thrust=math.exp(logarithm))

    found = {}
    for name in ("gain_low", "gain_high"):
        end = math.log(ENDS[name])
        if (yield from _try_flight(at(end))):
            found[name] = ENDS[name]
        else:
            found[name] = math.exp((yield from _bisect(at, 0.0, end)))
    return found


def _bisect(at: Callable[[float], Trial], good: float, bad: float) -> Generator[Any, Any, float]:
    for _ in range(_STEPS):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if (yield from _try_flight(at(middle))) else (good, middle)
    return good


def _search_delay(own: Trial) -> Search:
    """Find the maximum additional delay without failure, s."""

    def at(delay: float) -> Trial:
        return own._replace(delay=delay)

    good, bad = 0.0, _FIRST_DELAY
    while (yield from _try_flight(at(bad))):
        if bad == LARGEST_DELAY:
            return {"delay_margin": bad}
        good, bad = bad, min(2 * bad, LARGEST_DELAY)
    return {"delay_margin": (yield from _bisect(at, good, bad))}


def _sweep_rates(own: Trial) -> Search:
    """Find the error at each update rate; NaN after a failure."""
    outcomes = yield [own._replace(rate=rate) for rate in RATES]
    return {f"rms_at_{r:g}_Hz": o.measures[_METRIC] for r, o in zip(RATES, outcomes)}


def _sample_model_errors(own: Trial) -> Search:
    """Find worst and median error under model errors; the worst is infinite after a failure."""
    corners = list(itertools.product(*((1 - part, 1 + part) for part in BOX.values())))
    inside = np.random.default_rng(0).uniform(-1, 1, (_SAMPLES, len(BOX)))
    points = [*corners, *(1 + inside * np.array(list(BOX.values()))).tolist()]
    outcomes = yield [
        own._replace(**{name: 1 / modelled for name, modelled in zip(BOX, point)})
        for point in points
    ]
    errors = [o.measures[_METRIC] if o.flew else math.inf for o in outcomes]
    return {"box_median": float(np.median(errors)), "box_worst": max(errors)}


class _Kind(NamedTuple):
    """Kind of margin: its search, and the effects of the vehicle that it scales."""

    name: str
    search: Callable[[Trial], Search]
    varies: AbstractSet[str] = frozenset()


_KINDS = (
    _Kind("gain", _search_gain, {"thrust"}),
    _Kind("delay", _search_delay),
    _Kind("rates", _sweep_rates),
    _Kind("box", _sample_model_errors, set(BOX)),
)


def describe_omitted(model: str, lacking: Collection[str]) -> str:
    """State in one line the margins that cannot be searched; "" if all can."""
    left_out = [kind.name for kind in _KINDS if kind.varies & set(lacking)]
    if not left_out:
        return ""
    verb = "is" if len(left_out) == 1 else "are"
    return (
        f"margins: no tag of '{model}' scales its {' and its '.join(lacking)}. "
        f"{' and '.join(left_out)} {verb} not searched."
    )


def _try_flight(trial: Trial) -> Generator[List[Trial], List[Outcome], bool]:
    (outcome,) = yield [trial]
    return outcome.flew


def format_margin(row: Mapping[str, Any], name: str, number: Callable[[float], str]) -> str:
    """Format a margin; < or > marks one at an end of the search range."""
    value = row.get(name, math.nan)
    if value == ENDS.get(name):
        return f"{'<' if name == 'gain_low' else '>'} {number(value)}"
    return number(value)
