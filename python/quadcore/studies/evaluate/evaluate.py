"""Flying all cases of a plan and drawing the sums."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import (
    Any,
    Callable,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Union,
)

from ..._core import InputError, QuadcoreError
from ...report.html_table import SHOWN_ROWS, html_table, html_title
from ...report.thinning import evenly
from ...simulation.engines import STUDIED
from ...simulation.flight_plan import FlightPlan
from ...support import arguments
from ...support.warning import warn
from ..axes import Values
from ..executor import conducted
from ..table import flown_and_failed
from .entries import Named
from .flights import Outcome, flown
from .plan import Case, Plan
from .poles import has_poles, poles
from .robustness import Searches
from .sums import JUDGED as JUDGED
from .sums import over_seeds
from .trial import Trial

Progress = Callable[[int, int], None]

_KINDS = {
    "engines": arguments.SOME,
    "models": arguments.SOME,
    "vary": arguments.or_none(arguments.AXES),
    "duration": arguments.SECONDS,
    "margins": arguments.FLAG,
    "time_limit": arguments.LIMIT,
    "processes": arguments.or_none(arguments.COUNT),
    "progress": arguments.or_none(arguments.PROGRESS),
}
_DRAWN = 60  # flights of which enough is kept to draw them


class Evaluation(NamedTuple):
    """What became of the flights.

    Attributes
    ----------
    table : list of dict
        A row per flight: controller, reference, engine, model, scenario, seed, failure ("" if it
        flew) and each of the measures, NaN where it failed.
    groups : list of dict
        A row per combination, over its seeds: flights, not_flown and failure_rate; of those that
        flew, for each of `JUDGED`, mean and interval (low, high); cvar, in which who failed counts
        as infinite; and the mean difference from the first controller under the same seeds, with
        its interval.
    margins : list of dict
        A row per controller if they were searched, see `robustness`.
    poles : list of dict
        Of the cascaded laws in hover, for each axis, see `poles`; whose, and on what.
    outcomes : sequence of Outcome
        What is known of each flight; of the first seed of some combinations, enough to draw it.
    """

    table: List[Dict[str, Any]]
    groups: List[Dict[str, Any]]
    margins: List[Dict[str, Any]]
    poles: List[Dict[str, Any]]
    outcomes: Sequence[Outcome]

    @property
    def drawn(self) -> Dict[int, Outcome]:
        """What can be drawn, by row of the table."""
        return {row: outcome for row, outcome in enumerate(self.outcomes) if outcome.log}

    def __repr__(self) -> str:
        return f"<Evaluation, {flown_and_failed([row['failure'] for row in self.table])}>"

    def _repr_html_(self) -> str:
        from .output import columns_to_read, rows_to_read

        lines = rows_to_read(self)
        shown = {**columns_to_read(lines), "best": ""}
        rows = [[line[name] for name in shown] for line in lines[:SHOWN_ROWS]]
        return html_title(self) + html_table(list(shown.values()), rows, len(lines))


def evaluate(
    controllers: Named,
    references: Named,
    engines: Union[str, Sequence[str]] = STUDIED,
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
        Values by ``"PLUGIN.TAG"``, ``"world"``, ``"scenario"`` or ``"controller.KEY"``, KEY being
        ``rate``, ``delay`` or a parameter of a law: conditions, of which all combinations fly.
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
        But for the seconds the same whatever the number of processes: flights of a controller or
        reference that is none of quadcore's have processes of their own, which begin as this one
        is when they begin.

    Raises
    ------
    InputError
        Nothing was flown.
    KeyboardInterrupt
        With the attribute `evaluation`, whose missing rows say so.
    """
    given = dict(locals())
    arguments.check({**{name: given[name] for name in _KINDS}, **options}, _KINDS)
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
    arguments.check({"time_limit": time_limit}, _KINDS)
    cases = plan.cases()
    kept = set(_to_draw(plan, cases))
    outcomes = [Outcome()] * len(cases)
    searches = Searches(plan.controllers, plan.lacking) if margins else None
    if margins and plan.unsearched:
        warn(plan.unsearched)
    in_hover = _poles(plan)
    done = 0

    def summed() -> Evaluation:
        found = searches.rows() if searches else []
        return _summed(plan, cases, outcomes, found, in_hover)

    def conduct_each(
        described: Callable[[int], Callable[[], FlightPlan]], into: List[Outcome]
    ) -> None:
        def fly(i: int) -> Outcome:
            return flown(described(i), time_limit, into is outcomes and i in kept)

        def take(i: int, outcome: Union[Outcome, QuadcoreError]) -> None:
            nonlocal done
            if isinstance(outcome, QuadcoreError):
                outcome = Outcome(str(outcome), refused=isinstance(outcome, InputError))
            into[i] = outcome
            done += 1
            if progress is not None:
                progress(done, total)

        total = max(done + len(into), len(cases) + (searches.expected if searches else 0))
        conducted(fly, range(len(into)), take, processes, apart=plan.apart)

    def fly_trials(trials: Sequence[Trial]) -> List[Outcome]:
        found = [Outcome()] * len(trials)
        conduct_each(lambda i: lambda: trials[i].flight(plan), found)
        return found

    try:
        conduct_each(lambda row: lambda: plan.flight(cases[row]), outcomes)
        if searches is not None:
            searches.run(fly_trials)
    except KeyboardInterrupt as stop:
        stop.evaluation = summed()  # type: ignore[attr-defined]
        raise
    return summed()


def _poles(plan: Plan) -> List[Dict[str, Any]]:
    """Find the poles of the laws that have some, on each model in the first scenario."""
    rows: List[Dict[str, Any]] = []
    for names, flight in plan.laws():
        if has_poles(flight.controller):
            with suppress(QuadcoreError):  # a vehicle that chapter 2 cannot describe
                found = poles(flight.controller, replace(flight, on_reference=False).simulation())
                rows += [{**names, **row} for row in found]
    return rows


def _to_draw(plan: Plan, cases: Sequence[Case]) -> List[int]:
    """Rows of first seeds: all, or evenly many."""
    firsts = list(range(0, len(cases), len(plan.seeds)))
    return [firsts[i] for i in evenly(len(firsts), _DRAWN)]


def _summed(
    plan: Plan,
    cases: Sequence[Case],
    outcomes: Sequence[Outcome],
    margins: List[Dict[str, Any]],
    found_poles: List[Dict[str, Any]],
) -> Evaluation:
    names = [plan.names(case) for case in cases]
    return Evaluation(
        [
            {**name, "failure": outcome.failure, **outcome.measures}
            for name, outcome in zip(names, outcomes)
        ],
        over_seeds([case.group for case in cases], names, outcomes),
        margins,
        found_poles,
        outcomes,
    )
