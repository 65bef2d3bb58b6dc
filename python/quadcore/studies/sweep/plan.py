"""The rows of a sweep: what each of them flies, checked before the first takes off."""

from __future__ import annotations

import math
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from ..._core import InputError, check_ignored
from ...control import laws, references
from ...model.description import list_of_names, read_world
from ...simulation.commands import CommandsLike
from ...simulation.controller_pilot import Guided
from ...simulation.engines import STUDIED
from ...simulation.flight import check_logged
from ...simulation.flight_plan import FlightPlan
from ...support.files import shown
from ...support.values import whole
from ...support.warning import unheard
from .. import guidance
from ..design import LARGEST, Design, Point
from ..evaluate import entries
from ..evaluate import measures as of_guided
from ..evaluate.plan import LOG_RATE
from ..variation import Variation, give_all, is_of_controller, of_controller
from . import motion
from .batches import ENGINE
from .calls import Calls as Calls
from .spec import Flight, Own, columns

_NAMED = ("world", "scenario")

_TOGETHER = 32  # rows: four times as many as share an instruction, and few to lose


class Plan:
    """Controllers x references x engines x models x points x seeds.

    Or commands, in the place of controllers and references.

    Parameters
    ----------
    design
        The points.
    controllers, references
        As `evaluate` takes them; None with `commands`.
    commands
        Flown open loop, as `Simulation.run` takes them.
    engines, models
        Names.
    seeds
        How many, from `seed` on.
    duration
        s
    log_every
        Steps between the rows that are measured; None is a hundredth of a second.
    spawn
        Where flights begin; None is on the reference, or 10 m up.
    controller_rate, delay
        For every controller; None leaves each its own.
    time_limit
        Of the wall clock for one row, s.
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
        design: Design,
        controllers: Any = None,
        references_: Any = None,
        commands: Optional[CommandsLike] = None,
        engines: Sequence[str] = (STUDIED,),
        models: Sequence[Union[str, Path]] = ("quadrotor",),
        seeds: int = 1,
        duration: float = 10.0,
        log_every: Optional[int] = None,
        spawn: Optional[Sequence[float]] = None,
        controller_rate: Optional[float] = None,
        delay: Optional[float] = None,
        time_limit: float = 300.0,
        options: Optional[Mapping[str, Any]] = None,
    ) -> None:
        self.is_guided = _is_guided(controllers, references_, commands)
        self.design, self.limit = design, time_limit
        self.models, self.engines = [shown(model) for model in models], list(engines)
        self._timing = {"rate": controller_rate, "delay": delay}
        self._commands = str(commands) if isinstance(commands, (str, Path)) else None
        things: List[Tuple[str, Any]] = [("", None)]
        shapes: List[Tuple[str, Any]] = [("", None)]
        if self.is_guided:
            things = entries.labelled("controller", controllers, laws.Law)
            shapes = entries.labelled("reference", references_, references.Shape)
        self._things = [thing for _, thing in things]
        self.controllers, self.references = [one for one, _ in things], [one for one, _ in shapes]
        self._shapes = [thing and guidance.shape(thing) for _, thing in shapes]
        own = dict(options or {})
        self.first_seed = whole(own.pop("seed", 0))
        self.seeds = whole(seeds, "seeds")
        self.duration, self.spawn = duration, spawn
        self._log_every = log_every
        self._sizes = self._check_sizes()
        ignore = own.pop("ignore", ())
        self._variation = Variation(
            models, own.pop("parameters", None), own.pop("xacro_args", None), ignore
        )
        self.world, self.dt = own.pop("world", None), own.get("dt")
        world = read_world(self.world, ignore)
        read = [self._variation.read(i) for i in range(len(models))]
        passed_over = [*(model.passed_over for model in read), world.passed_over]
        check_ignored(list_of_names("ignore", ignore), passed_over)
        self._variation.provide(*(design.values(name) for name in _NAMED))
        common = {**own, "duration": duration, "wrenches": False, "commands": commands}
        common["on_reference"] = self.is_guided and spawn is None
        if spawn is not None:
            common["spawn"] = spawn
        self._plans = [FlightPlan.of(model, world, **common) for model in read]
        self._makers = [
            [_maker(thing, plan.model.name) for plan in self._plans] for _, thing in things
        ]
        self._own = [thing if guidance.names_own(thing) else "" for _, thing in things]
        self._check()

    whole = ("seed",)
    """Columns that hold whole numbers, besides ``row``."""

    @property
    def at_once(self) -> int:
        """Rows of a task at most: several where they can fly on one batch."""
        return 1 if self.is_guided or self.engines != [ENGINE] else _TOGETHER

    @property
    def apart(self) -> bool:
        """Whether flights call what others wrote, which may remember one when it flies another."""
        own = any(map(guidance.is_own, self._things)) if self.is_guided else False
        return own or not all(
            isinstance(one, (references.Shape, type(None))) for one in self._shapes
        )

    def __len__(self) -> int:
        return math.prod(self._sizes)

    @property
    def units(self) -> Dict[str, str]:
        """Of each measure."""
        return of_guided.UNITS if self.is_guided else motion.UNITS

    @property
    def meanings(self) -> Dict[str, str]:
        """What each measure is."""
        return of_guided.MEANINGS if self.is_guided else motion.MEANINGS

    @property
    def measures(self) -> Sequence[str]:
        """Names of what is measured."""
        return columns(self.is_guided)

    @property
    def names(self) -> List[str]:
        """Of the first columns, which say what flies."""
        guided = ["controller", "reference"] if self.is_guided else []
        return [*guided, "engine", "model", *self.design.names, "seed"]

    def place(self, row: int) -> Tuple[int, ...]:
        """Tell a row's positions: controller, reference, engine, model, point, seed."""
        where = []
        for size in reversed(self._sizes):
            row, at = divmod(row, size)
            where.append(at)
        return tuple(reversed(where))

    def cells(self, row: int) -> Dict[str, Any]:
        """Tell what a row flies, as the first columns of the table."""
        controller, reference, engine, model, point, seed = self.place(row)
        told: Dict[str, Any] = {
            "engine": self.engines[engine],
            "model": self.models[model],
            **self.design[point],
            "seed": self.first_seed + seed,
        }
        if not self.is_guided:
            return told
        flown = {
            "controller": self.controllers[controller],
            "reference": self.references[reference],
        }
        return {**flown, **told}

    def thing(self, controller: int) -> Any:
        """Give what was named as a controller: a text, or an object."""
        return self._things[controller]

    def spec(self, row: int) -> Flight:
        """Describe a row; raises what making it raises."""
        controller, reference, engine, model, at, seed = self.place(row)
        point = self.design[at]
        plan = replace(
            self._plans[model],
            engine=self.engines[engine],
            seed=self.first_seed + seed,
            reference=self._shapes[reference],
        )
        plan = self._variation.applied(plan, model, point)
        own = None
        values = {**self._timing, **of_controller(point)}
        if self._own[controller]:
            own = Own.of(self._own[controller], values)
        else:
            made = self._makers[controller][model]()
            plan = replace(plan, controller=give_all(made, values.items()))
        plan = replace(plan, log_every=self.rows_every(plan.step))
        return Flight(row, self.cells(row), plan, own, self.limit)

    def rows_every(self, dt: float) -> int:
        """Count the steps between measured rows."""
        if self._log_every is None:
            return max(1, round(1 / (LOG_RATE * dt)))
        return self._log_every

    def told(self) -> Dict[str, Any]:
        """Say what flies and how, in plain values."""
        return {
            "controllers": [name for name in self.controllers if name],
            "references": [name for name in self.references if name],
            "commands": self._commands,
            "engines": self.engines,
            "models": self.models,
            "axes": {name: len(set(self.design.values(name))) for name in self.design.names},
            "design": self.design.kind if self.design.drawn else None,
            "samples": self.design.samples,
            "seeds": [self.first_seed + i for i in range(self.seeds)],
            "duration": float(self.duration),
            "world": None if self.world is None else str(self.world),
            "dt": self._plans[0].step,
            "log_every": self.rows_every(self._plans[0].step),
            "spawn": None if self.spawn is None else [float(value) for value in self.spawn],
            "controller_rate": self._timing["rate"],
            "delay": self._timing["delay"],
            "set": dict(self._variation.set),
            "xacro": {name: str(value) for name, value in self._variation.arguments.items()},
            "ignore": list(self._variation.ignore),
        }

    def _check_sizes(self) -> List[int]:
        sides = [self.controllers, self.references, self.engines, self.models]
        entries.check_engines(self.engines)
        entries.check_labels(sides if self.is_guided else [["commands"], ["commands"], *sides[2:]])
        if not self.seeds:
            raise InputError("seeds is 0; give at least 1")
        if "engine" in self.design.names:
            raise InputError("vary engine: name the engines by themselves")
        if not self.is_guided and any(map(is_of_controller, self.design.names)):
            raise InputError("vary controller: commands are flown; name a --controller")
        sizes = [*map(len, sides), len(self.design), self.seeds]
        if math.prod(sizes) > LARGEST:
            raise InputError(f"these are {math.prod(sizes)} flights; at most {LARGEST} are swept")
        return sizes

    def _check(self) -> None:
        """Make each vehicle, and let each law of quadcore begin, at some of the points."""
        for model, plan in enumerate(self._plans):
            check_logged(self.duration, plan.step, self.rows_every(plan.step))
            for i, point in enumerate(self.design.to_try()):
                with unheard() if i else nullcontext():  # the first says what is doubtful
                    self._try(model, point)

    def _try(self, model: int, point: Point) -> None:
        plan = replace(self._plans[model], engine=self.engines[0], on_reference=False)
        vehicle = self._variation.applied(plan, model, point).simulation()
        with entries.blaming(point):
            for own, makers in zip(self._own, self._makers):
                controller = None if own else makers[model]()
                if isinstance(controller, laws.Law):
                    values = {**self._timing, **of_controller(point)}
                    Guided(give_all(controller, values.items()), vehicle).reset(vehicle)


AnyPlan = Union[Plan, Calls]
"""Says what the rows of a sweep are."""


def _is_guided(controllers: Any, references_: Any, commands: Any) -> bool:
    if commands is None:
        for name, given in (("controller", controllers), ("reference", references_)):
            if given is None:
                raise InputError(f"nothing to fly: name --{name}, or --commands")
    elif controllers is not None or references_ is not None:
        raise InputError("a flight takes --commands or a --controller; give one of them")
    return commands is None


def _maker(thing: Any, vehicle: str) -> Callable[[], Any]:
    return (lambda: None) if thing is None else guidance.maker(thing, vehicle)
