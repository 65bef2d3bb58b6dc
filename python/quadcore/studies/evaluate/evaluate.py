"""Flying all cases of a plan and drawing the sums."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import (
    TYPE_CHECKING,
    Any,
    Callable,
    Collection,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Set,
    Union,
)

from ..._core import InputError, QuadcoreError
from ...report.decimation import pick_evenly
from ...report.html_table import SHOWN_ROWS, html_table, html_title
from ...simulation.engines import AnyEngineName
from ...simulation.flight_plan import FlightPlan
from ...support import arguments
from ...support.warning import warn
from ..axes import Values
from ..control_setup import Controllers, References
from ..executor import run_contained
from ..measured_flight import Outcome, fly_and_measure
from ..options import EvaluateOptions, Keywords, Names, Progress, accept_options, choose_engines
from ..table import count_outcomes
from .margins import MarginSearch
from .plan import Plan
from .poles import compute_poles, has_poles
from .seed_statistics import JUDGED as JUDGED
from .seed_statistics import summarise_seeds
from .summary_table import choose_columns, format_rows
from .trial import Trial

if TYPE_CHECKING:
    from typing_extensions import Unpack

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
        return f"<Evaluation, {count_outcomes([row['failure'] for row in self.table])}>"

    def _repr_html_(self) -> str:
        lines = format_rows(self)
        shown = {**choose_columns(lines), "best": ""}
        rows = [[line[name] for name in shown] for line in lines[:SHOWN_ROWS]]
        return html_title(self) + html_table(list(shown.values()), rows, len(lines))


@accept_options(
    EvaluateOptions,
    engines=arguments.or_none(arguments.SOME),
    engine=arguments.or_none(arguments.NAME),
    models=arguments.SOME,
    vary=arguments.or_none(arguments.AXES),
    margins=arguments.FLAG,
)
def evaluate(
    controllers: Controllers,
    references: References,
    engines: Union[AnyEngineName, Sequence[AnyEngineName], None] = None,
    models: Names = "quadrotor",
    *,
    engine: Optional[AnyEngineName] = None,
    vary: Optional[Mapping[str, Values]] = None,
    margins: bool = False,
    **options: Unpack[Keywords],
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
        Names of one or several; default: "eigen" and "quadrotor".
    engine
        One engine, instead of `engines`.
    vary
        Values by ``"PLUGIN.TAG"``, ``"world"``, ``"scenario"`` or ``"controller.KEY"``, KEY being
        ``rate``, ``delay`` or a parameter of a law: conditions, of which all combinations fly.
    margins
        Whether to search for gain and delay margins, see `robustness`.
    **options

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
    shared = EvaluateOptions(**options)
    names = choose_engines(engine, engines), arguments.several(models)
    plan = Plan(controllers, references, *names, vary or {}, shared)
    return fly_plan(plan, shared.progress, margins)


def fly_plan(plan: Plan, progress: Optional[Progress] = None, margins: bool = False) -> Evaluation:
    """Fly a plan; parameters as for `evaluate`."""
    flights = _Flights(plan, progress, margins)
    try:
        flights.fly()
    except KeyboardInterrupt as stop:
        stop.evaluation = flights.make_evaluation()  # type: ignore[attr-defined]
        raise
    return flights.make_evaluation()


class _Flights:
    """The flights of an evaluation, and what is known of them so far."""

    def __init__(self, plan: Plan, progress: Optional[Progress], margins: bool) -> None:
        self._plan, self._progress = plan, progress
        self._outcomes = [Outcome()] * len(plan)
        self._done = 0
        self._searches: Optional[MarginSearch] = None
        if margins:
            self._searches = MarginSearch(plan.control.controllers, plan.lacking)
            if plan.omitted_margins:
                warn(plan.omitted_margins)
        self._poles = _compute_poles(plan)

    def fly(self) -> None:
        """Fly all cases, then what the searches ask for."""
        plan = self._plan
        self._fly_all(
            [partial(plan.make_plan, case) for case in plan], self._outcomes, _pick_drawn(plan)
        )
        if self._searches is not None:
            self._searches.run(self._fly_trials)

    def make_evaluation(self) -> Evaluation:
        """Sum up the flights so far."""
        plan, outcomes = self._plan, self._outcomes
        names = [plan.name_case(case) for case in plan]
        return Evaluation(
            [
                {**name, "failure": outcome.failure, **outcome.measures}
                for name, outcome in zip(names, outcomes)
            ],
            summarise_seeds([case[:-1] for case in plan], names, outcomes),
            [] if self._searches is None else self._searches.list_rows(),
            self._poles,
            outcomes,
        )

    def _fly_trials(self, trials: Sequence[Trial]) -> List[Outcome]:
        outcomes = [Outcome()] * len(trials)
        self._fly_all([partial(trial.make_plan, self._plan) for trial in trials], outcomes)
        return outcomes

    def _fly_all(
        self,
        flights: Sequence[Callable[[], FlightPlan]],
        outcomes: List[Outcome],
        drawn: Collection[int] = (),
    ) -> None:
        """Fly what some functions describe; of the flights that are `drawn` the log is kept."""
        options = self._plan.options
        expected = len(self._plan) + (self._searches.expected if self._searches else 0)
        total = max(self._done + len(flights), expected)

        def fly(i: int) -> Outcome:
            return fly_and_measure(flights[i], options.time_limit, i in drawn)

        def take(i: int, outcome: Union[Outcome, QuadcoreError]) -> None:
            if isinstance(outcome, QuadcoreError):
                outcome = Outcome(str(outcome), refused=isinstance(outcome, InputError))
            outcomes[i] = outcome
            self._done += 1
            if self._progress is not None:
                self._progress(self._done, total)

        apart = self._plan.control.runs_user_code
        run_contained(fly, range(len(flights)), take, options.processes, apart=apart)


def _compute_poles(plan: Plan) -> List[Dict[str, Any]]:
    """Find the poles of the laws that have some, on each model in the first scenario."""
    rows: List[Dict[str, Any]] = []
    for names, flight in plan.list_built_in_flights():
        if has_poles(flight.controller):
            with suppress(QuadcoreError):  # a vehicle that chapter 2 cannot describe
                found = compute_poles(
                    flight.controller, replace(flight, on_reference=False).simulation()
                )
                rows += [{**names, **row} for row in found]
    return rows


def _pick_drawn(plan: Plan) -> Set[int]:
    """Choose the rows to draw: of first seeds, all or evenly many."""
    firsts = range(0, len(plan), len(plan.seeds))
    return {firsts[i] for i in pick_evenly(len(firsts), _DRAWN)}
