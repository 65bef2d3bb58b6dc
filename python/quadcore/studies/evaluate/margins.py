"""Margins of a controller: gain, delay, update rate, and model errors.

Gain and delay are scanned from the nominal value outwards; the margin ends at the first unstable
value. Each value is simulated twice, with and without an initial disturbance (`KICK`). It counts as
unstable if a flight fails, or if the difference between the flights does not decay. The disturbance
is needed because a vehicle in equilibrium shows no instability.

The controller has the nominal model of the vehicle, while thrust, drag and motor lag of the
simulated vehicle are scaled. Built-in controllers receive the nominal model directly, and
user-defined controllers receive it in `reset`.
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
from .trial import KICK, Trial

LARGEST_GAIN = 10.0
LARGEST_DELAY = 0.5  # s
ENDS = {"gain_low": 1 / LARGEST_GAIN, "gain_high": LARGEST_GAIN, "delay_margin": LARGEST_DELAY}
"""Ends of the search range. If a search reaches an end, the margin may be larger."""
RATES = (1000.0, 500.0, 250.0, 125.0, 100.0, 50.0, 25.0)  # 1/s
BOX = {"thrust": 0.1, "drag": 0.5, "lag": 0.3}
"""Relative model errors. The corners of this box and random points inside it are simulated."""

NAMES = (*ENDS, *(f"rms_at_{rate:g}_Hz" for rate in RATES), "box_median", "box_worst")

_GAINS = 24  # number of steps of a gain scan; each is 10 %
_GAIN_WIDTH = 0.015  # relative width of the final interval
_FINE = 0.001  # s; step of the delay scan
_FINE_UNTIL = 0.05  # s; end of the fine steps
_COARSE = 0.05  # relative step beyond
_DELAY_WIDTH = 5e-4  # s; width of the final interval
_ROUND = 6  # number of scan values that are simulated together
_SAMPLES = 16  # number of random points in the box
_TRIALS = 120  # approximate number of flights per controller
NOT_DECAYED = (
    "the initial disturbance does not decay in the nominal flight. Use a stable controller and a "
    "longer duration."
)
"""Failure of a controller without margins."""

_DECAYED = 0.05  # of the initial disturbance; less is rounding noise of the controller
_METRIC = "rms_position"

Found = Dict[str, float]
Search = Generator[List[Trial], List[Outcome], Found]
Fly = Callable[[List[Trial]], List[Outcome]]


class MarginSearch:
    """Search for the margins of controllers with the first reference, engine, model and scenario.

    Parameters
    ----------
    controllers
        Names of the controllers.
    lacking
        Effects that no tag of the vehicle can scale; see `list_missing_effects`.
    plugins
        Indices of plugin controllers, for which only the delay margin is searched.
    """

    def __init__(
        self, controllers: Sequence[str], lacking: Collection[str], plugins: Collection[int] = ()
    ) -> None:
        self._rows: List[Dict[str, Any]] = [
            {"controller": name, "failure": NOT_FLOWN, **dict.fromkeys(NAMES, math.nan)}
            for name in controllers
        ]
        self._kinds = [kind for kind in _KINDS if not kind.varies & set(lacking)]
        self._plugins = plugins
        self._done: Dict[Trial, Outcome] = {}

    @property
    def expected(self) -> int:
        """Approximate number of flights."""
        return _TRIALS * len(self._rows)

    def run(self, fly: Fly) -> None:
        """Run all searches in parallel; `fly` simulates the trials of each round."""
        running: List[Tuple[int, Search]] = []
        own = [Trial(row) for row in range(len(self._rows))]
        self._fly_new(fly, [*own, *(trial._replace(kicked=True) for trial in own)])
        for trial in own:
            pair = self._done[trial], self._done[trial._replace(kicked=True)]
            failure = pair[0].failure or pair[1].failure
            if not failure and is_lost(*pair):
                failure = NOT_DECAYED
            if failure:
                self._rows[trial.controller]["failure"] = failure
            else:
                is_plugin = trial.controller in self._plugins
                running += [
                    (trial.controller, kind.search(trial))
                    for kind in self._kinds
                    if kind.suits_plugins or not is_plugin
                ]
        asked = [(row, search, next(search)) for row, search in running]
        while asked:
            self._fly_new(fly, [trial for *_, trials in asked for trial in trials])
            asked = list(self._advance(asked))
        for row, _ in running:
            self._rows[row]["failure"] = ""

    def list_rows(self) -> List[Dict[str, Any]]:
        """Return a row per controller: the values of `NAMES`, or the failure without a search."""
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
    """Find the range of the thrust and torque factor in which the flights remain stable."""

    def at(logarithm: float) -> Trial:
        return own._replace(thrust=math.exp(logarithm))

    found = {}
    for name in ("gain_low", "gain_high"):
        scan = np.linspace(0, math.log(ENDS[name]), _GAINS + 1)[1:].tolist()
        end = yield from _find_first_loss(at, scan, _GAIN_WIDTH)
        found[name] = ENDS[name] if end == scan[-1] else math.exp(end)
    return found


def _search_delay(own: Trial) -> Search:
    """Find the smallest additional delay that makes the flight unstable, s."""
    scan = [_FINE]
    while scan[-1] < LARGEST_DELAY:
        step = _FINE if scan[-1] < _FINE_UNTIL else _COARSE * scan[-1]
        scan.append(min(scan[-1] + step, LARGEST_DELAY))
    found = yield from _find_first_loss(lambda delay: own._replace(delay=delay), scan, _DELAY_WIDTH)
    return {"delay_margin": found}


def _find_first_loss(
    at: Callable[[float], Trial], scan: Sequence[float], width: float
) -> Generator[List[Trial], List[Outcome], float]:
    """Return the stable value before the first unstable one of a scan from 0, or the last value."""
    good, bad = 0.0, math.nan
    for start in range(0, len(scan), _ROUND):
        values = scan[start : start + _ROUND]
        lost = yield from _judge([at(value) for value in values])
        if any(lost):
            first = lost.index(True)
            good, bad = ([good, *values][first], values[first])
            break
        good = values[-1]
    while abs(bad - good) > width:
        middle = (good + bad) / 2
        (is_lost,) = yield from _judge([at(middle)])
        good, bad = (good, middle) if is_lost else (middle, bad)
    return good


def _judge(trials: Sequence[Trial]) -> Generator[List[Trial], List[Outcome], List[bool]]:
    """Simulate trials, and return which of them are unstable."""
    outcomes = yield [each._replace(kicked=kicked) for each in trials for kicked in (False, True)]
    return [is_lost(*pair) for pair in zip(outcomes[::2], outcomes[1::2])]


def is_lost(plain: Outcome, kicked: Outcome) -> bool:
    """Whether a flight fails with or without the disturbance, or the effect does not decay.

    Linear and angular velocities are compared separately. The RMS effect in the last quarter of the
    flight must be below those in the first and third quarters.
    """
    if not (plain.flew and kicked.flew):
        return True
    if plain.motion is None or kicked.motion is None:
        return False
    effect = (kicked.motion - plain.motion).reshape(-1, 2, 3)
    quarters = np.array_split(np.linalg.norm(effect, axis=2), 4)
    first, _, third, last = (np.sqrt((part**2).mean(axis=0)) for part in quarters)
    return bool(np.any((last > np.minimum(first, third)) & (last > _DECAYED * KICK)))


def _sweep_rates(own: Trial) -> Search:
    """Find the tracking error at each update rate; NaN after a failure."""
    outcomes = yield [own._replace(rate=rate) for rate in RATES]
    return {f"rms_at_{r:g}_Hz": o.measures[_METRIC] for r, o in zip(RATES, outcomes)}


def _sample_model_errors(own: Trial) -> Search:
    """Find the worst and median error with model errors; a failure counts as infinite."""
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
    """Kind of margin: its search, and the vehicle effects that the search scales."""

    name: str
    search: Callable[[Trial], Search]
    varies: AbstractSet[str] = frozenset()
    suits_plugins: bool = False


_KINDS = (
    _Kind("gain", _search_gain, {"thrust"}),
    _Kind("delay", _search_delay, suits_plugins=True),
    _Kind("rates", _sweep_rates),
    _Kind("box", _sample_model_errors, set(BOX)),
)


def describe_omitted(model: str, lacking: Collection[str], plugins: Sequence[str]) -> str:
    """Describe in one line the margins that are not searched; "" if all are searched.

    Parameters
    ----------
    model, lacking
        Name of the vehicle, and effects that none of its tags can scale.
    plugins
        Names of the plugin controllers.
    """
    found = []
    left_out = [kind.name for kind in _KINDS if kind.varies & set(lacking)]
    if left_out:
        verb = "is" if len(left_out) == 1 else "are"
        found.append(
            f"margins: no tag of '{model}' scales its {' and its '.join(lacking)}. "
            f"{' and '.join(left_out)} {verb} not searched."
        )
    if plugins:
        found.append(
            f"margins of {', '.join(plugins)}: only the delay is searched. A plugin sets its own "
            "rate, and its model is the changed vehicle."
        )
    return " ".join(found)


def format_margin(row: Mapping[str, Any], name: str, number: Callable[[float], str]) -> str:
    """Format a margin; < or > marks a value at the end of the search range."""
    value = row.get(name, math.nan)
    if value == ENDS.get(name):
        return f"{'<' if name == 'gain_low' else '>'} {number(value)}"
    return number(value)
