"""Flying all cases of a plan and drawing the sums."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .._core import QuadcoreError
from ..study.axes import Values
from ..study.executor import conducted
from ..study.sampling import evenly
from . import robustness
from .flights import NAN, Outcome, flown
from .intervals import cvar, interval
from .plan import Case, Named, Plan
from .poles import has_poles, poles

Progress = Callable[[int, int], None]

JUDGED = ("rms_position", "largest_position", "tail_position")
"""Measures that have a mean, an interval and a risk over the seeds."""

_DRAWN = 60  # flights of which enough is kept to draw them
_NOT_FLOWN = "not flown: interrupted"


class Evaluation(NamedTuple):
    """What became of the flights."""

    table: List[Dict[str, Any]]
    """A row per flight: controller, reference, engine, model, scenario, seed, failure ("" if it
    flew) and each of the measures, NaN where it failed."""
    groups: List[Dict[str, Any]]
    """A row per combination, over its seeds: flights, failure_rate and, of those that flew, for
    each of `JUDGED` mean, interval (low, high), cvar; and the mean difference from the first
    controller under the same seeds, with its interval."""
    margins: List[Dict[str, Any]]
    """A row per controller if they were searched, see `robustness`."""
    poles: List[Dict[str, Any]]
    """Of the cascaded laws in hover, for each axis, see `poles`; with controller and engines."""
    seconds: List[float]
    """Of the wall clock, per flight; NaN where it did not end."""
    updates: List[int]
    """Of the controller, per flight."""
    warnings: List[Sequence[str]]
    """Of the model and the flight, per flight."""
    drawn: Dict[int, Outcome]
    """What is needed to draw flights: the first seed of some combinations, by row of the table."""


def evaluate(
    controllers: Named,
    references: Named,
    engines: Union[str, Sequence[str]] = "eigen",
    models: Union[str, Path, Sequence[Union[str, Path]]] = "quadrotor",
    seeds: int = 1,
    vary: Optional[Mapping[str, Values]] = None,
    duration: float = 30.0,
    log_every: Optional[int] = None,
    spawn: Optional[Sequence[float]] = None,
    controller_rate: Optional[float] = None,
    delay: Optional[float] = None,
    margins: bool = False,
    time_limit: float = 300.0,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
    **options: Any,
) -> Evaluation:
    """Fly controllers along references, and measure how well they do.

    Parameters
    ----------
    controllers
        Names of laws, ``LAW:KEY=VALUE,...``, files of gains, ``MODULE:CLASS``, or objects as
        `Simulation.run` takes them; or a mapping of labels to these.
    references
        Names as on the command line, or of `quadcore.references`; or a mapping of labels.
    engines, models
        Names of one or several.
    seeds
        How many, from `seed` on, each with noise of its own.
    vary
        Values by ``"PLUGIN.TAG"``, ``"world"`` or ``"controller.KEY"``, KEY being ``rate``,
        ``delay`` or a parameter of a law: conditions, all combinations of which are flown.
    duration
        s
    log_every
        Steps between measured rows; None: a hundredth of a second.
    spawn
        Where flights begin; None: in the full flat state of the reference.
    controller_rate, delay
        Of every controller; None leaves each its own.
    margins
        Whether to search for gain and delay margins, see `robustness`.
    time_limit
        Of the wall clock for one flight, s.
    processes, progress
        As for `compare`.
    **options
        As for `Simulation`: world, dt, seed (the first), parameters, xacro_args, ignore.

    Returns
    -------
    Evaluation
        But for `seconds` the same whatever the number of processes.

    Raises
    ------
    InputError
        Nothing was flown.
    KeyboardInterrupt
        With the attribute `evaluation`, whose missing rows say so.
    """
    plan = Plan(
        controllers,
        references,
        [engines] if isinstance(engines, str) else engines,
        [models] if isinstance(models, (str, Path)) else models,
        seeds,
        vary or {},
        duration,
        log_every,
        spawn,
        controller_rate,
        delay,
        options,
    )
    return conduct(plan, time_limit, processes, progress, margins)


def conduct(
    plan: Plan,
    time_limit: float,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
    margins: bool = False,
) -> Evaluation:
    """Fly a plan; parameters as for `evaluate`."""
    cases = plan.cases()
    kept = _to_draw(plan, cases)
    missing = Outcome(_NOT_FLOWN, NAN, float("nan"), 0)
    outcomes: List[Outcome] = [missing] * len(cases)
    searches = robustness.searches(plan) if margins else []
    found: List[Any] = [None] * len(searches)
    in_hover = _poles(plan)
    total, done = len(cases) + len(searches), 0

    def note(outcome: Any) -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, total)

    def fly(row: int) -> Outcome:
        return flown(plan.flight(cases[row]), time_limit, row in kept)

    def take(row: int, outcome: Union[Outcome, QuadcoreError]) -> None:
        if isinstance(outcome, QuadcoreError):
            outcome = Outcome(str(outcome), NAN, float("nan"), 0)
        outcomes[row] = outcome
        note(outcome)

    def take_found(row: int, result: Any) -> None:
        found[row] = str(result) if isinstance(result, QuadcoreError) else result
        note(result)

    try:
        conducted(fly, range(len(cases)), take, processes)
        conducted(lambda search: search.made(plan, time_limit), searches, take_found, processes)
    except KeyboardInterrupt as stop:
        stop.evaluation = _summed(plan, cases, outcomes, searches, found, in_hover)  # type: ignore[attr-defined]
        raise
    return _summed(plan, cases, outcomes, searches, found, in_hover)


def _poles(plan: Plan) -> List[Dict[str, Any]]:
    """Find the poles of the laws that have some, on the first model in the first scenario."""
    rows: List[Dict[str, Any]] = []
    for label, engines, flight in plan.laws():
        if has_poles(flight.controller):
            with suppress(QuadcoreError):  # a vehicle that chapter 2 cannot describe
                found = poles(flight.controller, replace(flight, on_reference=False).simulation())
                rows += [{"controller": label, "engine": engines, **row} for row in found]
    return rows


def _to_draw(plan: Plan, cases: Sequence[Case]) -> List[int]:
    """Rows of first seeds: all, or evenly many."""
    firsts = list(range(0, len(cases), len(plan.seeds)))
    return [firsts[i] for i in evenly(len(firsts), _DRAWN)]


def _summed(
    plan: Plan,
    cases: Sequence[Case],
    outcomes: Sequence[Outcome],
    searches: Sequence[Any],
    found: Sequence[Any],
    found_poles: List[Dict[str, Any]],
) -> Evaluation:
    table = [
        {**plan.names(case), "failure": outcome.failure, **outcome.measures}
        for case, outcome in zip(cases, outcomes)
    ]
    return Evaluation(
        table,
        _groups(plan, cases, outcomes),
        robustness.rows(plan, searches, found),
        found_poles,
        [outcome.seconds for outcome in outcomes],
        [outcome.updates for outcome in outcomes],
        [outcome.warnings for outcome in outcomes],
        {row: outcome for row, outcome in enumerate(outcomes) if outcome.log is not None},
    )


def _groups(plan: Plan, cases: Sequence[Case], outcomes: Sequence[Outcome]) -> List[Dict[str, Any]]:
    by_group: Dict[Tuple[int, ...], List[Outcome]] = {}
    names: Dict[Tuple[int, ...], Dict[str, Any]] = {}
    for case, outcome in zip(cases, outcomes):
        by_group.setdefault(case.group, []).append(outcome)
        names.setdefault(case.group, plan.names(case))
    return [
        {
            **{name: value for name, value in names[group].items() if name != "seed"},
            **_over_seeds(flights, by_group[(0, *group[1:])]),
        }
        for group, flights in by_group.items()
    ]


def _over_seeds(flights: Sequence[Outcome], first: Sequence[Outcome]) -> Dict[str, Any]:
    """Sum the flights of one combination, and compare them with the first controller's."""
    row: Dict[str, Any] = {
        "flights": len(flights),
        "failure_rate": sum(1 for f in flights if f.failure) / len(flights),
    }
    for name in JUDGED:
        values = np.array([f.measures[name] for f in flights if not f.failure])
        low, high = interval(values)
        row[f"mean_{name}"] = float(values.mean()) if len(values) else float("nan")
        row[f"low_{name}"], row[f"high_{name}"] = low, high
        row[f"cvar_{name}"] = cvar(values)
        apart = [
            f.measures[name] - other.measures[name]
            for f, other in zip(flights, first)
            if not f.failure and not other.failure and flights is not first
        ]
        row[f"difference_{name}"] = float(np.mean(apart)) if apart else float("nan")
        row[f"difference_low_{name}"], row[f"difference_high_{name}"] = interval(np.array(apart))
    return row
