"""Evaluation of a plan: flights, statistics, margins."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import nan
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
from ...simulation.engines import STUDY_ENGINE, AnyEngineName
from ...simulation.flight_plan import FlightPlan
from ...support import arguments
from ...support.warning import warn
from ..accept_options import accept_options
from ..axes import Values
from ..control_setup import Controllers, References
from ..executor import contain_errors, count_cores, run_contained
from ..grouped_flights import MOST_VECTORIZED, FlightRecord, fly_group, share_out, split
from ..measured_flight import Outcome, fly_alone, measure_record
from ..options import EvaluateKeywords, EvaluateOptions, Names, Progress, choose_engines
from ..table import count_outcomes
from ..time_limit import time_limit
from ..tracking_metrics import UNITS
from .loop_responses import measure_loops
from .margins import MarginSearch
from .plan import Plan
from .poles import compute_poles, has_poles
from .seed_statistics import summarise_seeds
from .summary_table import choose_columns, format_rows
from .trial import Trial

if TYPE_CHECKING:
    from typing_extensions import Unpack

_DRAWN = 60  # maximum number of flights with logs for plots and animations


class Evaluation(NamedTuple):
    """Results of an evaluation.

    Attributes
    ----------
    table : list of dict
        Row per flight: controller, reference, engine, model, scenario, seed, failure ("" for
        success), and each metric, NaN after a failure.
    groups : list of dict
        Row per combination with the statistics over its seeds: flights, not_flown and failure_rate.
        For each of `units`, mean and interval (low, high) of the successful flights, and cvar, in
        which a failure counts as infinite. Also the mean difference from the first controller,
        paired by seed, with its interval and the number of pairs. The effect_size is Cohen's d of
        the differences in the last 10 s. The value is_random is true if the seeds change the
        flights (None if unknown). For is_best and p_best, see `mark_best`.
    margins : list of dict
        Row per controller, empty without a search; see `evaluate.margins`.
    poles : list of dict
        Row per axis of each cascaded controller in hover; see `compute_poles`.
    outcomes : sequence of Outcome
        Outcome of each flight. For at most 60 combinations, the outcome of the first seed contains
        a log.
    units : mapping of str to str
        Unit of each metric, including those that `constraints` and `metrics` add.
    loops : sequence of dict
        Row per controller, engine, model and axis, if the option `frequency_response` is set; see
        `measure_loops`.
    """

    table: List[Dict[str, Any]]
    groups: List[Dict[str, Any]]
    margins: List[Dict[str, Any]]
    poles: List[Dict[str, Any]]
    outcomes: Sequence[Outcome]
    units: Mapping[str, str] = UNITS
    loops: Sequence[Mapping[str, Any]] = ()

    @property
    def drawn(self) -> Dict[int, Outcome]:
        """Outcomes with a log, by row of the table."""
        return {row: outcome for row, outcome in enumerate(self.outcomes) if outcome.log}

    def __repr__(self) -> str:
        return f"<Evaluation, {count_outcomes([row['failure'] for row in self.table])}>"

    def _repr_html_(self) -> str:
        lines = format_rows(self)
        shown = {**choose_columns(lines, self.units), "best": ""}
        rows = [[line[name] for name in shown] for line in lines[:SHOWN_ROWS]]
        return html_title(self) + html_table(list(shown.values()), rows, len(lines))


@accept_options(
    EvaluateOptions,
    engines=arguments.SOME,
    engine=arguments.or_none(arguments.NAME),
    models=arguments.SOME,
    vary=arguments.or_none(arguments.AXES),
    margins=arguments.FLAG,
)
def evaluate(
    controllers: Controllers,
    references: References,
    engines: Union[AnyEngineName, Sequence[AnyEngineName]] = STUDY_ENGINE,
    models: Names = "quadrotor",
    *,
    engine: Optional[AnyEngineName] = None,
    vary: Optional[Mapping[str, Values]] = None,
    margins: bool = False,
    **options: Unpack[EvaluateKeywords],
) -> Evaluation:
    """Measure the tracking error of controllers on references.

    Parameters
    ----------
    controllers
        Controller names, ``NAME:KEY=VALUE,...``, gains files, ``MODULE:CLASS``, or objects as for
        `Simulation.run`; or a mapping of labels to these.
    references
        Names as on the command line, or objects of `quadcore.references`; or a mapping of labels to
        these.
    engines, models
        One or several names (default: "eigen", "quadrotor").
    engine
        Single engine, instead of `engines`.
    vary
        Conditions by ``"PLUGIN.TAG"``, ``"world"``, ``"scenario"`` or ``"controller.KEY"``, where
        KEY is ``rate``, ``delay`` or a parameter of the controller. All combinations are simulated.
    margins
        Whether to search for gain and delay margins.
    **options

    Returns
    -------
    Evaluation
        Results, which do not depend on the number of processes, except for the measured durations.
        Flights with user-defined controllers or references run in separate forked processes.

    Raises
    ------
    InputError
        If an argument is invalid. In this case no flight runs.
    KeyboardInterrupt
        On Ctrl-C. The attribute `evaluation` contains the results so far and marks the missing
        rows.
    """
    shared = EvaluateOptions(**options)
    names = choose_engines(engine, engines), arguments.to_list(models)
    plan = Plan(controllers, references, *names, vary or {}, shared)
    return fly_plan(plan, shared.progress, margins)


def fly_plan(plan: Plan, progress: Optional[Progress] = None, margins: bool = False) -> Evaluation:
    """Simulate all flights of a plan; parameters as for `evaluate`."""
    flights = _Flights(plan, progress, margins)
    poles = _compute_poles(plan)
    try:
        flights.fly(_pick_drawn(plan))
        loops = measure_loops(plan, poles) if plan.measures_loops else []
    except KeyboardInterrupt as stop:
        stop.evaluation = flights.make_evaluation(poles)  # type: ignore[attr-defined]
        raise
    return flights.make_evaluation(poles)._replace(loops=loops)


def fly_outcomes(plan: Plan, progress: Optional[Progress] = None) -> List[Outcome]:
    """Simulate all flights of a plan without logs; an interrupt has the attribute `outcomes`."""
    flights = _Flights(plan, progress, margins=False)
    try:
        flights.fly()
    except KeyboardInterrupt as stop:
        stop.outcomes = flights.outcomes  # type: ignore[attr-defined]
        raise
    return flights.outcomes


class _Flights:
    """Flights of an evaluation and their outcomes so far."""

    def __init__(self, plan: Plan, progress: Optional[Progress], margins: bool) -> None:
        self._plan, self._progress = plan, progress
        self.outcomes = [Outcome()] * len(plan)
        self._done = 0
        self._searches: Optional[MarginSearch] = None
        if margins:
            self._searches = MarginSearch(plan.control.controllers, plan.lacking, plan.plugins)
            if plan.omitted_margins:
                warn(plan.omitted_margins)

    def fly(self, drawn: Collection[int] = ()) -> None:
        """Simulate all cases, then the flights of the margin search."""
        plan, rows = self._plan, range(len(self._plan))
        flights = [partial(plan.make_plan, case) for case in plan]
        fly = partial(self._fly_tasks, flights, self.outcomes, drawn=drawn)
        if plan.measures_times:
            plan.set_computation_times(self._measure_times())
        if plan.control.runs_user_code:
            fly([[i] for i in rows[:: len(plan.seeds)]])
            fly(self._group_other_seeds())
        else:
            groups = self._share_out([i for i in rows if i not in drawn])
            fly([*([i] for i in sorted(drawn)), *groups])
        if self._searches is not None:
            self._searches.run(partial(self._fly_trials, together=not plan.control.runs_user_code))

    def make_evaluation(self, poles: List[Dict[str, Any]]) -> Evaluation:
        """Summarise the flights so far."""
        plan, outcomes = self._plan, self.outcomes
        names = [plan.name_case(case) for case in plan]
        units = plan.criteria.units
        return Evaluation(
            [
                {
                    **name,
                    "failure": outcome.failure,
                    **dict.fromkeys(units, nan),
                    **outcome.measures,
                }
                for name, outcome in zip(names, outcomes)
            ],
            summarise_seeds([case[:-1] for case in plan], names, outcomes, units),
            [] if self._searches is None else self._searches.list_rows(),
            poles,
            outcomes,
            units,
        )

    def _measure_times(self) -> List[float]:
        """Return the 99 % quantile of the call duration of each controller in its first flight."""
        outcomes = self._fly_trials([Trial(i) for i in range(len(self._plan.control.controllers))])
        return [outcome.slow_call if outcome.flew else nan for outcome in outcomes]

    def _fly_trials(self, trials: Sequence[Trial], together: bool = False) -> List[Outcome]:
        outcomes = [Outcome()] * len(trials)
        flights = [partial(trial.make_plan, self._plan) for trial in trials]
        tasks: List[Sequence[int]] = [[i] for i in range(len(trials))]
        if together:
            # A kick changes the state once more, so kicked and other flights cannot share a batch.
            kinds = [[i for i, t in enumerate(trials) if t.kicked == kicked] for kicked in (0, 1)]
            tasks = [group for rows in kinds for group in self._share_out(rows)]
        self._fly_tasks(flights, outcomes, tasks, watch=True)
        return outcomes

    def _share_out(self, rows: Sequence[int]) -> List[Sequence[int]]:
        return share_out(rows, self._plan.options.processes or count_cores())

    def _group_other_seeds(self) -> List[Sequence[int]]:
        """Group the seeds after the first one, as many as a vectorized controller takes at once."""
        tasks: List[Sequence[int]] = []
        for first, *others in split(range(len(self._plan)), len(self._plan.seeds)):
            together = MOST_VECTORIZED if self.outcomes[first].is_vectorized else 1
            tasks += split(others, together)
        return tasks

    def _fly_tasks(
        self,
        flights: Sequence[Callable[[], FlightPlan]],
        outcomes: List[Outcome],
        tasks: Sequence[Sequence[int]],
        drawn: Collection[int] = (),
        watch: bool = False,
    ) -> None:
        """Simulate flights; the flights of one task run together.

        Flights in `drawn` keep their logs; `watch` keeps the motion of all flights. This process
        computes the metrics of flights with user-defined controllers, because it does not run user
        code.
        """
        options, criteria = self._plan.options, self._plan.criteria
        expected = len(self._plan) + (self._searches.expected if self._searches else 0)
        total = max(self._done + sum(map(len, tasks)), expected)
        apart = self._plan.control.runs_user_code

        def fly(rows: Sequence[int]) -> List[Union[FlightRecord, Outcome]]:
            found = None
            if len(rows) > 1:
                group = [flights[i] for i in rows]
                found = fly_group(group, options.time_limit, criteria.needs_flat_states)
            records: List[Any] = found or [_contain(fly_one, i) for i in rows]
            return records if apart else list(map(finish, rows, records))

        def fly_one(i: int) -> FlightRecord:
            is_drawn = i in drawn
            return fly_alone(
                flights[i],
                options.time_limit,
                is_drawn,
                criteria=criteria,
                logs_commands=is_drawn and self._plan.draws_spectra,
            )

        def finish(i: int, found: Union[FlightRecord, Outcome]) -> Outcome:
            if isinstance(found, Outcome):
                return found

            def measure(flight: FlightRecord) -> Outcome:
                with time_limit(options.time_limit):
                    return measure_record(flight, criteria, i in drawn, watch)

            outcome: Outcome = _contain(measure, found)
            return outcome

        def take(task: int, found: Union[List[Any], QuadcoreError]) -> None:
            rows = tasks[task]
            if isinstance(found, QuadcoreError):
                found = [_describe_error(found)] * len(rows)
            for i, one in zip(rows, found):
                outcomes[i] = finish(i, one)
            self._done += len(rows)
            if self._progress is not None:
                self._progress(self._done, total)

        run_contained(fly, tasks, take, options.processes, apart=apart)


def _contain(function: Callable[[Any], Any], argument: Any) -> Any:
    """Call a function, and convert an error into an outcome."""
    try:
        return contain_errors(function)(argument)
    except QuadcoreError as error:
        return _describe_error(error)


def _describe_error(error: QuadcoreError) -> Outcome:
    """Convert the error of a flight into an outcome."""
    return Outcome(str(error), refused=isinstance(error, InputError))


def _compute_poles(plan: Plan) -> List[Dict[str, Any]]:
    """Compute the poles of all cascaded controllers on each model, in the first scenario."""
    rows: List[Dict[str, Any]] = []
    for names, flight in plan.list_built_in_flights():
        if has_poles(flight.controller):
            with suppress(QuadcoreError):  # chapter 2 does not cover every vehicle
                found = compute_poles(
                    flight.controller, replace(flight, on_reference=False).simulation()
                )
                rows += [{**names, **row} for row in found]
    return rows


def _pick_drawn(plan: Plan) -> Set[int]:
    """Return the rows to draw: the first seed of all flights on evenly spaced conditions.

    A condition is a pair of reference and point. At most `_DRAWN` flights are drawn, but at least
    one condition.
    """
    pairs = [(case.reference, case.point) for case in plan]
    every = list(dict.fromkeys(pairs))
    flights = len(plan) // len(plan.seeds) // len(every)
    shown = {every[i] for i in pick_evenly(len(every), max(1, _DRAWN // flights))}
    return {row for row in range(0, len(plan), len(plan.seeds)) if pairs[row] in shown}
