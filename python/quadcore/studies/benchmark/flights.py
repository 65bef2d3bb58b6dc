"""Plans, flights and results of the benchmark."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Union

from ..._core import InputError
from ...control import controllers as built_in
from ...support import arguments
from ...support.parameters import suggest
from ...support.warning import suppress_warnings
from ..control_setup import Controllers
from ..evaluate.evaluate import fly_outcomes
from ..evaluate.plan import Plan
from ..evaluate.seed_statistics import summarise_seeds
from ..measured_flight import Outcome
from ..options import EvaluateOptions, Progress
from ..table import count_outcomes
from .definition import LATEST, Condition, Definition
from .scores import Score, compute_scores, make_cells

_GENERAL = [name for name in built_in.NAMES if name not in built_in.FIRMWARE]


class Part(NamedTuple):
    """Flights of one vehicle in one condition."""

    condition: Condition
    plan: Plan


class Benchmark(NamedTuple):
    """Results of a benchmark.

    Attributes
    ----------
    definition : Definition
        Vehicles, references, scenarios and seeds.
    parts : list of Part
        Plans of the flights.
    table : list of dict
        Row per flight, as in `Evaluation.table`, with its ``category``. The model is the name of
        the vehicle.
    groups : list of dict
        Row per combination with the statistics over its seeds, as in `Evaluation.groups`, and its
        ``category``.
    scores : list of Score
        Score of each controller in each category.
    outcomes : list of Outcome
        Outcome of each flight.
    """

    definition: Definition
    parts: List[Part]
    table: List[Dict[str, Any]]
    groups: List[Dict[str, Any]]
    scores: List[Score]
    outcomes: List[Outcome]

    @property
    def is_complete(self) -> bool:
        """Whether all flights of the version have run."""
        vehicles = {part.plan.models[0] for part in self.parts}
        categories = {part.condition.category for part in self.parts}
        given = self.definition
        whole = vehicles == set(given.vehicles) and categories == set(given.categories)
        return whole and all(outcome.was_flown for outcome in self.outcomes)

    def __repr__(self) -> str:
        outcomes = count_outcomes([row["failure"] for row in self.table])
        return f"<Benchmark {self.definition.version}, {outcomes}>"


def benchmark(
    controllers: Optional[Controllers] = None,
    *,
    version: str = LATEST,
    vehicles: Union[str, Sequence[str], None] = None,
    categories: Union[str, Sequence[str], None] = None,
    time_limit: float = EvaluateOptions.time_limit,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> Benchmark:
    """Simulate the flights of the benchmark with some controllers, and compute their scores.

    Parameters
    ----------
    controllers
        As for `evaluate`. Default: all built-in controllers except the firmware controllers.
    version
        Version of the benchmark.
    vehicles, categories
        Names of the vehicles and categories to simulate. Default: all. With a selection, the result
        is not complete.
    time_limit
        Wall-clock limit per flight, s.
    processes
        Number of processes. Default: one per core.
    progress
        Function called as progress(done, total).

    Raises
    ------
    InputError
        If an argument is invalid. In this case no flight runs.
    KeyboardInterrupt
        On Ctrl-C. The attribute `benchmark` contains the results so far and marks the missing
        flights.
    """
    definition = Definition(version)
    options = EvaluateOptions(time_limit=time_limit, processes=processes)
    return fly_parts(
        definition, make_parts(definition, controllers, vehicles, categories, options), progress
    )


def make_parts(
    definition: Definition,
    controllers: Optional[Controllers],
    vehicles: Union[str, Sequence[str], None],
    categories: Union[str, Sequence[str], None],
    options: EvaluateOptions,
) -> List[Part]:
    """Make the plans of a version; of `options`, only the time limit and the processes apply."""
    chosen = _choose("vehicle", vehicles, list(definition.vehicles))
    kinds = _choose("category", categories, definition.categories)
    return [
        Part(condition, _make_plan(definition, condition, vehicle, controllers, options))
        for vehicle in chosen
        for condition in definition.conditions
        if condition.category in kinds
    ]


def fly_parts(
    definition: Definition, parts: List[Part], progress: Optional[Progress] = None
) -> Benchmark:
    """Simulate all flights of some plans; the errors are those of `benchmark`."""
    total = sum(len(part.plan) for part in parts)
    outcomes: List[Outcome] = []

    def report(done: int, _: int) -> None:
        if progress is not None:
            progress(len(outcomes) + done, total)

    try:
        for part in parts:
            outcomes += fly_outcomes(part.plan, report)
    except KeyboardInterrupt as stop:
        outcomes += getattr(stop, "outcomes", [])
        missing = [Outcome()] * (total - len(outcomes))
        stop.benchmark = _summarise(definition, parts, outcomes + missing)  # type: ignore[attr-defined]
        raise
    return _summarise(definition, parts, outcomes)


def _summarise(definition: Definition, parts: List[Part], outcomes: List[Outcome]) -> Benchmark:
    names = [name for part in parts for name in _name_flights(part)]
    keys = [
        (case.controller, number, case.reference)
        for number, part in enumerate(parts)
        for case in part.plan
    ]
    groups = summarise_seeds(keys, names, outcomes)
    return Benchmark(
        definition,
        parts,
        [
            {**name, "failure": outcome.failure, **outcome.measures}
            for name, outcome in zip(names, outcomes)
        ],
        groups,
        compute_scores(make_cells(groups)),
        outcomes,
    )


def _name_flights(part: Part) -> Iterator[Dict[str, Any]]:
    for case in part.plan:
        name = part.plan.name_case(case)
        yield {**name, "scenario": part.condition.name, "category": part.condition.category}


def _choose(kind: str, given: Union[str, Sequence[str], None], known: List[str]) -> List[str]:
    chosen = known if given is None else arguments.to_list(given)
    for name in chosen:
        if name not in known:
            near = suggest(str(name), known)
            raise InputError(
                f"{kind} '{name}' does not exist.{near} Use some of {', '.join(known)}."
            )
    return [name for name in known if name in chosen]


def _make_plan(
    definition: Definition,
    condition: Condition,
    vehicle: str,
    controllers: Optional[Controllers],
    options: EvaluateOptions,
) -> Plan:
    shapes: Any = {label: definition.references[label] for label in condition.references}
    with suppress_warnings():  # users cannot change the vehicles of a version
        return Plan(
            _GENERAL if controllers is None else controllers,
            shapes,
            [definition.engine],
            [vehicle],
            {},
            EvaluateOptions(
                xacro_args=definition.vehicles[vehicle],
                scenario=definition.find_scenario(condition, vehicle),
                seeds=condition.seeds,
                duration=definition.duration,
                delay=condition.delay,
                time_limit=options.time_limit,
                processes=options.processes,
            ),
        )
