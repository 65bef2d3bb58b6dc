"""What is evaluated: every combination of what flies, checked before the first takes off."""

from __future__ import annotations

import copy
import itertools
import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import (
    Any,
    Callable,
    Dict,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    Union,
)

from .. import laws, references
from .._core import InputError, check_ignored, parse_number
from ..controller import check_callable, give
from ..description import list_of_names, read_model, read_world
from ..files import shown
from ..flight_plan import FlightPlan
from ..overrides import check_names, without_xacro
from ..plants import LAGRANGE, plants
from ..simulation import text_of
from ..study.axes import LARGEST, Values, axes_of

LOG_RATE = 100.0
"""Rows per second that a flight is measured by."""

_OF_CONTROLLER = "controller."
_READ = 16  # models that are kept as they were read

Named = Union[str, Any, Mapping[str, Any], Sequence[Any]]


class Case(NamedTuple):
    """One flight, by the positions of what it is made of."""

    controller: int
    reference: int
    engine: int
    model: int
    scenario: int
    seed: int

    @property
    def group(self) -> Tuple[int, ...]:
        """What it shares with flights of other seeds."""
        return tuple(self[:-1])


class Plan:
    """Controllers x references x engines x models x scenarios x seeds.

    Parameters
    ----------
    controllers, references
        Texts as the command line has them, objects, or a mapping of labels to either.
    engines, models
        Names.
    seeds
        How many, from `seed` on.
    vary
        Values by axis: ``PLUGIN.TAG``, ``world``, and ``controller.KEY``, KEY being ``rate``,
        ``delay`` or a parameter of the laws. All combinations are scenarios.
    duration
        s
    log_every
        Steps between the rows that are measured; None is a hundredth of a second.
    spawn
        Where flights begin; None is on the reference.
    controller_rate, delay
        For every controller; None leaves each its own.
    options
        As for `FlightPlan.of`.

    Raises
    ------
    InputError
        Anything that is known to be wrong before it flies, but for a controller of the user's own,
        whose flights fail.
    """

    def __init__(
        self,
        controllers: Named,
        references_: Named,
        engines: Sequence[str],
        models: Sequence[Union[str, Path]],
        seeds: int,
        vary: Mapping[str, Values],
        duration: float,
        log_every: Optional[int],
        spawn: Optional[Sequence[float]],
        controller_rate: Optional[float],
        delay: Optional[float],
        options: Mapping[str, Any],
    ) -> None:
        self.models = [shown(model) for model in models]
        self.engines = list(engines)
        self._timing = {"rate": controller_rate, "delay": delay}
        things = _labelled("controller", controllers, laws.Law)
        self.controllers = [label for label, _ in things]
        self._are_own = [_is_own(thing) for _, thing in things]
        self.references, self._shapes = [], []
        for label, thing in _labelled("reference", references_, references.Shape):
            self.references.append(label)
            self._shapes.append(references.parse(thing) if isinstance(thing, str) else thing)
        self._scenarios = _scenarios(vary)
        self.scenarios = [_label(scenario) for scenario in self._scenarios]
        own = dict(options)
        first_seed = own.pop("seed", 0)
        self.seeds = [first_seed + i for i in range(seeds)]
        self.duration = duration
        self._check(seeds)
        ignore = own.pop("ignore", ())
        arguments, given = without_xacro(
            own.pop("parameters", None) or {}, own.pop("xacro_args", None)
        )
        self._set = {key: text_of(value) for key, value in given.items()}
        self._read = lru_cache(_READ)(
            lambda i, varied: read_model(models[i], {**arguments, **dict(varied)}, ignore)
        )
        world = read_world(own.pop("world", None), ignore)
        common = {**own, "duration": duration, "wrenches": False, "on_reference": spawn is None}
        if spawn is not None:
            common["spawn"] = spawn
        read = [self._read(i, ()) for i in range(len(models))]
        passed_over = [*(model.passed_over for model in read), world.passed_over]
        check_ignored(list_of_names("ignore", ignore), passed_over)
        self._plans = [FlightPlan.of(model, world, **common) for model in read]
        vehicles = [plan.model.name for plan in self._plans]
        self._makers = [[_maker(thing, vehicle) for vehicle in vehicles] for _, thing in things]
        worlds = [scenario["world"] for scenario in self._scenarios if "world" in scenario]
        self._worlds = {name: read_world(name, ignore) for name in worlds}
        self.dt = [self._built(model).dt for model in range(len(models))]
        self._every = [log_every or max(1, round(1 / (LOG_RATE * dt))) for dt in self.dt]

    def __len__(self) -> int:
        return math.prod(map(len, self._sides())) * len(self.seeds)

    def cases(self) -> List[Case]:
        """All flights; seeds run fastest, then scenarios."""
        ranges = [range(len(side)) for side in self._sides()]
        return [
            Case._make((*where, seed))
            for where in itertools.product(*ranges)
            for seed in self.seeds
        ]

    def names(self, case: Case) -> Dict[str, Any]:
        """Tell what a case is made of, as the first columns of the table."""
        named = zip(("controller", "reference", "engine", "model", "scenario"), self._sides(), case)
        return {**{kind: side[i] for kind, side, i in named}, "seed": case.seed}

    def flight(self, case: Case) -> FlightPlan:
        """Describe a flight, its controller made anew; raises what making it raises."""
        changed, timing = self._changed(case.model, self._scenarios[case.scenario])
        controller = self._makers[case.controller][case.model]()
        for name, value in timing.items():
            give(controller, name, value)
        return replace(
            self._plans[case.model],
            engine=self.engines[case.engine],
            seed=case.seed,
            controller=controller,
            reference=self._shapes[case.reference],
            log_every=self._every[case.model],
            **changed,
        )

    def _changed(
        self, model: int, scenario: Mapping[str, str]
    ) -> Tuple[Dict[str, Any], Dict[str, float]]:
        """Tell what a scenario changes in a plan, and what of the controller."""
        changed: Dict[str, Any] = {}
        timing = {name: value for name, value in self._timing.items() if value is not None}
        parameters = dict(self._set)
        for name, value in scenario.items():
            if name.startswith(_OF_CONTROLLER):
                timing[name[len(_OF_CONTROLLER) :]] = _number(name, value)
            elif name == "world":
                changed["world"] = self._worlds[value]
            else:
                parameters.update(dict.fromkeys(name.split(","), value))
        varied, tags = without_xacro(parameters, None)
        read = self._read(model, tuple(varied.items()))
        check_names(read, parameters)
        return {**changed, "model": read, "parameters": tags}, timing

    def laws(self) -> Iterator[Tuple[str, str, FlightPlan]]:
        """Name controller and engines, and describe a flight, for each law of quadcore.

        Engines that fly the same plugins are one.
        """
        for row, label in enumerate(self.controllers):
            if self._are_own[row]:
                continue
            of_plugins = [name for name in self.engines if name != LAGRANGE]
            for flown in (of_plugins, [LAGRANGE] if LAGRANGE in self.engines else []):
                if flown:
                    engine = self.engines.index(flown[0])
                    flight = self.flight(Case(row, 0, engine, 0, 0, self.seeds[0]))
                    yield label, ", ".join(flown), flight

    def _sides(self) -> Tuple[Sequence[str], ...]:
        return self.controllers, self.references, self.engines, self.models, self.scenarios

    def _built(self, model: int) -> Any:
        """Build a model as the first scenario has it: says at once what is wrong or doubtful."""
        changed, _ = self._changed(model, self._scenarios[0])
        plan = replace(self._plans[model], engine=self.engines[0], on_reference=False, **changed)
        return plan.simulation()

    def _check(self, seeds: int) -> None:
        known = [name for name, _ in plants()]
        for engine in self.engines:
            if engine not in known:
                raise InputError(f"there is no engine '{engine}'; give some of {', '.join(known)}")
        for kind, names in (
            ("controller", self.controllers),
            ("reference", self.references),
            ("engine", self.engines),
            ("model", self.models),
        ):
            for name in names:
                if names.count(name) > 1:
                    raise InputError(f"{kind} '{name}' is named twice; keep one, or label them")
            if not names:
                raise InputError(f"no {kind} is named; name at least one")
        if seeds < 1:
            raise InputError(f"seeds is {seeds}; give at least 1")
        if len(self) > LARGEST:
            raise InputError(f"these are {len(self)} flights; at most {LARGEST} are evaluated")


def adjusted(controller: Any, values: Mapping[str, float]) -> Any:
    """Give a controller values of its own, see `give`."""
    for name, value in values.items():
        give(controller, name, value)
    return controller


def _maker(thing: Any, vehicle: str) -> Callable[[], Any]:
    """Make what makes a controller for a flight; one of the user's own is brought in then."""
    if _is_own(thing):
        return lambda: laws.parse(thing, vehicle)
    if isinstance(thing, str):
        thing = laws.parse(thing, vehicle)
    check_callable(thing)

    def again() -> Any:
        try:
            if isinstance(thing, laws.Law):
                return thing.copy()
            return copy.deepcopy(thing)  # so that no flight knows of another
        except Exception:  # what cannot be copied has to begin anew by its reset()
            return thing

    return again


def _is_own(thing: Any) -> bool:
    """Whether a text names a module of the user's own."""
    return isinstance(thing, str) and ":" in thing and thing.partition(":")[0] not in laws.NAMES


def _number(name: str, text: str) -> float:
    number = parse_number(text)
    if number is None:
        raise InputError(f"vary {name}: '{text}' is not a finite number")
    return number


def _labelled(kind: str, things: Named, one: type) -> List[Tuple[str, Any]]:
    """Give each thing a label."""
    if isinstance(things, Mapping):
        return [(str(label), thing) for label, thing in things.items()]
    if isinstance(things, (str, one)) or callable(things):
        things = [things]
    return [(_name(kind, thing), thing) for thing in things]


def _name(kind: str, thing: Any) -> str:
    if isinstance(thing, str):
        return thing
    if isinstance(thing, (laws.Law, references.Shape)):
        values = ",".join(f"{name}={value:g}" for name, value in thing.parameters.items())
        return f"{thing.name}:{values}" if values else thing.name
    return getattr(thing, "__name__", type(thing).__name__)


def _scenarios(vary: Mapping[str, Values]) -> List[Dict[str, str]]:
    axes = axes_of(vary)
    for axis in axes:
        if axis.name == "engine":
            raise InputError("vary engine: name the engines by themselves")
        if "," in axis.name and _OF_CONTROLLER in axis.name:
            raise InputError(f"vary {axis.name}: vary what is the controller's alone")
    names = [axis.name for axis in axes]
    return [dict(zip(names, values)) for values in itertools.product(*(a.values for a in axes))]


def _label(scenario: Mapping[str, str]) -> str:
    return " ".join(f"{name}={value}" for name, value in scenario.items())
