"""What is evaluated: every combination of what flies, checked before the first takes off."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from ..._core import InputError, check_ignored
from ...control import laws, references
from ...model.description import list_of_names, read_world
from ...simulation.controller_pilot import Guided
from ...simulation.engines import exerts_wrenches
from ...simulation.flight import check_logged
from ...simulation.flight_plan import FlightPlan
from ...simulation.scenario_events import Event
from ...support.files import shown
from ...support.values import whole
from ...support.warning import unheard
from .. import guidance
from ..axes import LARGEST, Values
from ..variation import Variation, give_all, of_controller
from . import entries, robustness, trial
from .entries import Named

LOG_RATE = 100.0
"""Rows per second that a flight is measured by."""

_NAMED = ("world", "scenario")


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
        Values by axis: ``PLUGIN.TAG``, ``world``, ``scenario`` and ``controller.KEY``, KEY being
        ``rate``, ``delay`` or a parameter of the laws. All combinations are scenarios.
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
        things = entries.labelled("controller", controllers, laws.Law)
        self.controllers = [label for label, _ in things]
        self._are_own = [guidance.is_own(thing) for _, thing in things]
        self.references, self._shapes = [], []
        for label, thing in entries.labelled("reference", references_, references.Shape):
            self.references.append(label)
            self._shapes.append(guidance.shape(thing))
        self._scenarios = entries.scenarios(vary)
        self.scenarios = [entries.label_of(scenario) for scenario in self._scenarios]
        own = dict(options)
        first_seed = whole(own.pop("seed", 0))
        self.seeds = [first_seed + i for i in range(whole(seeds, "seeds"))]
        self.duration, self.spawn = duration, spawn
        self._log_every = log_every
        entries.check_engines(self.engines)
        entries.check_labels(self._sides()[:-1])
        if not self.seeds:
            raise InputError("seeds is 0; give at least 1")
        if len(self) > LARGEST:
            raise InputError(f"these are {len(self)} flights; at most {LARGEST} are evaluated")
        self._ignore = own.pop("ignore", ())
        self._variation = Variation(
            models, own.pop("parameters", None), own.pop("xacro_args", None), self._ignore
        )
        self.world = own.pop("world", None)
        world = read_world(self.world, self._ignore)
        common = {**own, "duration": duration, "on_reference": spawn is None}
        if spawn is not None:
            common["spawn"] = spawn
        read = [self._variation.read(i) for i in range(len(models))]
        passed_over = [*(model.passed_over for model in read), world.passed_over]
        check_ignored(list_of_names("ignore", self._ignore), passed_over)
        self._plans = [FlightPlan.of(model, world, **common) for model in read]
        vehicles = [plan.model.name for plan in self._plans]
        self._makers = [[guidance.maker(thing, name) for name in vehicles] for _, thing in things]
        self._variation.provide(
            *([each[name] for each in self._scenarios if name in each] for name in _NAMED)
        )
        begun = [self._begun(model) for model in range(len(models))]
        self.lacking = trial.lacking(begun[0])
        self._check_logs()

    @property
    def unsearched(self) -> str:
        """What is left out of the margins, and why, in one line; "" if nothing is."""
        return robustness.unsearched(self.models[0], self.lacking)

    @property
    def apart(self) -> bool:
        """Whether flights call what others wrote, which may remember one when it flies another."""
        shipped = [isinstance(shape, references.Shape) for shape in self._shapes]
        return any(self._are_own) or not all(shipped)

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
        scenario = self._scenarios[case.scenario]
        plan = replace(
            self._plans[case.model],
            engine=self.engines[case.engine],
            seed=case.seed,
            controller=self._controller(case.controller, case.model, scenario),
            reference=self._shapes[case.reference],
        )
        varied = self._variation.applied(plan, case.model, scenario)
        return replace(varied, log_every=self.rows_every(varied.step))

    def first_of(self, controller: int) -> FlightPlan:
        """Describe a flight of a controller on the first of everything else."""
        return self.flight(Case(controller, 0, 0, 0, 0, self.seeds[0]))

    def laws(self) -> Iterator[Tuple[Dict[str, str], FlightPlan]]:
        """Name controller, model and engines, and describe a flight, for each law of quadcore.

        Engines that fly the same plugins are one.
        """
        of_plugins = [name for name in self.engines if exerts_wrenches(name)]
        several = [of_plugins, *([name] for name in self.engines if name not in of_plugins)]
        for row, label in enumerate(self.controllers):
            for model, vehicle in enumerate(self.models):
                for flown in several:
                    if flown and not self._are_own[row]:
                        engine = self.engines.index(flown[0])
                        flight = self.flight(Case(row, 0, engine, model, 0, self.seeds[0]))
                        names = {"controller": label, "model": vehicle, "engine": ", ".join(flown)}
                        yield names, flight

    def rows_every(self, dt: float) -> int:
        """Count the steps between measured rows."""
        if self._log_every is None:
            return max(1, round(1 / (LOG_RATE * dt)))
        return self._log_every

    def events(self) -> Dict[str, Sequence[Event]]:
        """Give what happens in time, by scenario."""
        named = zip(self.scenarios, self._scenarios)
        read = self._variation.scenarios
        befall = {label: read[each.get("scenario")] for label, each in named}
        return {label: each.events for label, each in befall.items() if each is not None}

    def told(self) -> Dict[str, Any]:
        """Say what flies and how, in plain values; controllers are told by `laws`."""
        step = self._plans[0].step
        return {
            "controllers": self.controllers,
            "references": self.references,
            "engines": self.engines,
            "models": self.models,
            "scenarios": self.scenarios,
            "seeds": self.seeds,
            "duration": float(self.duration),
            "world": None if self.world is None else str(self.world),
            "dt": step,
            "log_every": self.rows_every(step),
            "spawn": None if self.spawn is None else [float(value) for value in self.spawn],
            "controller_rate": self._timing["rate"],
            "delay": self._timing["delay"],
            "set": dict(self._variation.set),
            "xacro": {name: str(value) for name, value in self._variation.arguments.items()},
            "ignore": list(self._ignore),
        }

    def _controller(self, row: int, model: int, scenario: Mapping[str, str]) -> Any:
        """Make a controller with what a scenario changes in it."""
        values = {**self._timing, **of_controller(scenario)}
        return give_all(self._makers[row][model](), values.items())

    def _sides(self) -> Tuple[Sequence[str], ...]:
        return self.controllers, self.references, self.engines, self.models, self.scenarios

    def _built(self, model: int, scenario: Mapping[str, str]) -> Any:
        plan = replace(self._plans[model], engine=self.engines[0], on_reference=False)
        return self._variation.applied(plan, model, scenario).simulation()

    def _check_logs(self) -> None:
        """Refuse flights of which nothing would be measured but the start."""
        for plan in self._plans:
            for world in [plan.world, *self._variation.worlds.values()]:
                dt = replace(plan, world=world).step
                check_logged(self.duration, dt, self.rows_every(dt))

    def _begun(self, model: int) -> Any:
        """Let each law of quadcore begin on a model, with each value of the axes.

        Returns the vehicle as the first scenario has it, which alone says what is doubtful.
        """
        first, *others = entries.one_by_one(self._scenarios)
        vehicle = self._built(model, first)
        self._begin_laws(model, first, vehicle)
        with unheard():
            for scenario in others:
                self._begin_laws(model, scenario, self._built(model, scenario))
        return vehicle

    def _begin_laws(self, model: int, scenario: Mapping[str, str], vehicle: Any) -> None:
        with entries.blaming(scenario):
            for row, is_own in enumerate(self._are_own):
                if not is_own:
                    Guided(self._controller(row, model, scenario), vehicle).reset(vehicle)
