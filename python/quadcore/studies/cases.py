"""Cases of a study: all combinations of its inputs, checked before the first flight."""

from __future__ import annotations

import math
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import (
    Any,
    Dict,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    TypeVar,
    Union,
)

from .._core import InputError, check_ignored
from ..model.description import check_names_argument, read_world_once
from ..simulation.commands import CommandsLike, check_commands
from ..simulation.controller_pilot import ControllerPilot
from ..simulation.engines import list_engines
from ..simulation.flight import check_log_length
from ..simulation.flight_plan import FlightPlan
from ..simulation.scenarios import Scenario
from ..simulation.simulation import Simulation
from ..support.output_files import printable_name
from ..support.values import check_whole
from ..support.warning import suppress_warnings
from .axes import OF_CONTROLLER
from .control_setup import ControlSetup
from .design import Design, Point
from .options import Options
from .variation import Variation, pick_controller_values

T = TypeVar("T", bound=Options)

LOG_RATE = 100.0
"""Default rate of the logged rows from which the metrics are computed, 1/s."""


class Case(NamedTuple):
    """One flight, as indices of controller, reference, engine, model, point and seed."""

    controller: int = 0
    reference: int = 0
    engine: int = 0
    model: int = 0
    point: int = 0
    seed: int = 0


class Cases(Sequence[Case]):
    """Combinations of controllers, references, engines, models, points and seeds.

    The seed varies fastest.

    Parameters
    ----------
    design
        Points of the varied axes.
    control
        Controllers and references.
    models, engines
        Model files or names, and engine names.
    options
        Options that all flights share.
    wrenches
        Whether to log wrenches.
    largest
        Maximum number of flights.

    Raises
    ------
    InputError
        If a file cannot be read, a name does not exist, or there are too many flights.
    """

    def __init__(
        self,
        design: Design,
        control: ControlSetup,
        models: Sequence[Union[str, Path]],
        engines: Sequence[str],
        options: Options,
        wrenches: bool = False,
        largest: int = 100_000,
    ) -> None:
        self.design, self.control, self.options = design, control, options
        self.models, self.engines = [printable_name(model) for model in models], list(engines)
        first = check_whole(options.seed)
        self.seeds = range(first, first + options.seeds)
        self._sizes = self._check_sizes(largest)
        scenario: Any = options.scenario
        world: Any = options.world
        changes = options.parameters, options.xacro_args, options.ignore
        self.variation = Variation(models, design, *changes, scenario, options.wind, options.at)
        world = read_world_once(world, options.ignore, options.at)
        everything = [*self.variation.models, world, *self.variation.worlds.values()]
        ignored = check_names_argument("ignore", options.ignore)
        check_ignored(ignored, [each.ignored_elements for each in everything])
        where = {} if options.spawn is None else {"spawn": options.spawn}
        common: Dict[str, Any] = {"dt": options.dt, "duration": options.duration, **where}
        self._plans = [
            FlightPlan.of(
                model, world, on_reference=control.on_reference, wrenches=wrenches, **common
            )
            for model in self.variation.models
        ]
        control.check(self.vehicles)

    def __len__(self) -> int:
        return math.prod(self._sizes)

    def __getitem__(self, row: Any) -> Any:
        if not 0 <= row < len(self):
            raise IndexError(row)
        where = []
        for size in reversed(self._sizes):
            row, at = divmod(row, size)
            where.append(at)
        return Case._make(reversed(where))

    @property
    def vehicles(self) -> List[str]:
        """Names of the vehicles in the models."""
        return [model.name for model in self.variation.models]

    def name_sides(self, case: Case) -> Dict[str, str]:
        """Return the names of controller, reference, engine and model of a case."""
        found = {"engine": self.engines[case.engine], "model": self.models[case.model]}
        if not self.control.is_closed_loop:
            return found
        controller = self.control.controllers[case.controller]
        return {
            "controller": controller,
            "reference": self.control.references[case.reference],
            **found,
        }

    def make_plan_without_controller(self, case: Case) -> FlightPlan:
        """Make the plan of a flight without its controller."""
        plan = replace(
            self._plans[case.model],
            engine=self.engines[case.engine],
            seed=self.seeds[case.seed],
            reference=self.control.shapes[case.reference] if self.control.is_closed_loop else None,
        )
        plan = self.variation.apply(plan, case.model, self.design[case.point])
        return replace(plan, log_every=self.steps_per_row(plan.step))

    def make_plan(self, case: Case) -> FlightPlan:
        """Make the plan of a flight; errors of the controller propagate."""
        plan = self.make_plan_without_controller(case)
        if not self.control.is_closed_loop:
            return plan
        return replace(plan, controller=self.make_controller(case))

    def make_controller(self, case: Case) -> Any:
        """Make the controller of a flight with the values of its point."""
        return self._make_controller(case.controller, case.model, self.design[case.point])

    def make_vehicle(self, model: int, point: Point) -> Simulation:
        """Make the vehicle of a model with the values of a point."""
        plan = replace(self._plans[model], engine=self.engines[0], on_reference=False)
        return self.variation.apply(plan, model, point).simulation()

    def start_controllers(self, model: int, point: Point, vehicle: Simulation) -> None:
        """Start each built-in controller on a model with the values of a point."""
        with _name_point_in_errors(point):
            for i in range(len(self.control.things)):
                if not self.control.is_user_code(i):
                    ControllerPilot(self._make_controller(i, model, point), vehicle).reset(vehicle)

    def check(self, commands: Optional[CommandsLike] = None) -> List[Simulation]:
        """Build each model and start each built-in controller on it, at the trial points.

        Parameters
        ----------
        commands
            Commands of open-loop flights, as for `Simulation.run`.

        Returns
        -------
        list of Simulation
            One vehicle per model, at the first point.

        Raises
        ------
        InputError
            If an input is invalid. User-defined controllers are not started.
        """
        made = []
        for model in range(len(self.models)):
            for i, point in enumerate(self.design.pick_trial_points()):
                with (
                    suppress_warnings() if i else nullcontext()
                ):  # warn only once, at the first point
                    vehicle = self.make_vehicle(model, point)
                    self.start_controllers(model, point, vehicle)
                if not i:
                    made.append(vehicle)
        for plan in self._plans:
            for world in [plan.world, *self.variation.worlds.values()]:
                step = replace(plan, world=world).step
                check_log_length(self.options.duration, step, self.steps_per_row(step))
        if commands is not None:
            self.set_commands(commands, [vehicle.command_width for vehicle in made])
        return made

    def set_commands(self, commands: CommandsLike, widths: Sequence[int]) -> None:
        """Set the commands of all flights; `widths` contains the command width of each model."""
        self._plans = [
            replace(plan, commands=check_commands(commands, width))
            for plan, width in zip(self._plans, widths)
        ]

    def steps_per_row(self, dt: float) -> int:
        """Return the number of simulation steps between logged rows."""
        if self.options.log_every is None:
            return max(1, round(1 / (LOG_RATE * dt)))
        return self.options.log_every

    @property
    def unsimulated(self) -> List[str]:
        """Parts of the worlds that may affect the motion but are not simulated."""
        worlds = [self._plans[0].world, *self.variation.worlds.values()]
        return list(
            dict.fromkeys(name for each in worlds for name in each.ignored_elements.unsimulated)
        )

    def list_settings(self) -> Dict[str, Any]:
        """Return the settings that all flights share, as plain values."""
        options, step = self.options, self._plans[0].step
        spawn = options.spawn
        return {
            "seeds": list(self.seeds),
            "duration": float(options.duration),
            "world": None if options.world is None else str(options.world),
            "dt": step,
            "log_every": self.steps_per_row(step),
            "spawn": None if spawn is None else [float(value) for value in spawn],
            "wind": None if options.wind is None else [float(value) for value in options.wind],
            "controller_rate": options.controller_rate,
            "delay": options.delay,
            "set": dict(self.variation.set),
            "xacro": {name: str(value) for name, value in self.variation.arguments.items()},
            "ignore": list(options.ignore),
            "unsimulated": self.unsimulated,
        }

    def _make_controller(self, controller: int, model: int, point: Point) -> Any:
        return self.control.make(controller, self.vehicles[model], pick_controller_values(point))

    def _check_sizes(self, largest: int) -> Tuple[int, ...]:
        sides = {
            "controller": self.control.controllers,
            "reference": self.control.references,
            "engine": self.engines,
            "model": self.models,
        }
        for kind in list(sides)[:3] if self.control.is_closed_loop else ["engine"]:
            check_labels(kind, sides[kind])
        known = [name for name, _ in list_engines()]
        for engine in self.engines:
            if engine not in known:
                raise InputError(f"engine '{engine}' does not exist. Use {', '.join(known)}.")
        for name in self.design.names:
            if name.startswith(OF_CONTROLLER) and not self.control.is_closed_loop:
                raise InputError(f"vary {name}: no controller is given. Add --controller.")
        sizes = [len(side) or 1 for side in sides.values()]
        sizes += [self.design.size, int(self.options.seeds)]
        if math.prod(sizes) > largest:
            raise InputError(
                f"{math.prod(sizes)} flights are more than {largest}. Use fewer combinations."
            )
        return tuple(sizes)


def check_models(models: Sequence[Union[str, Path]], design: Design) -> None:
    """Raise `InputError` if a model is given twice, or an axis varies the engine."""
    check_labels("model", [printable_name(model) for model in models])
    if "engine" in design.names:
        raise InputError("vary engine: engines are not an axis here. Use --engine A,B.")


def make_scenario_axis(
    vary: Mapping[str, Any], options: T, least: int = 1
) -> Tuple[Mapping[str, Any], T]:
    """Turn the scenarios in the options into an axis if there are at least `least` of them."""
    scenario: Any = options.scenario
    names = list(scenario) if isinstance(scenario, (list, tuple)) else [scenario]
    if scenario is None or not names:
        return vary, options
    if "scenario" in vary:
        raise InputError("vary scenario: --scenario is also given. Give one of them.")
    if len(names) < least or isinstance(names[0], Scenario):
        return vary, replace(options, scenario=names[0])
    return {"scenario": names, **vary}, replace(options, scenario=None)


def check_labels(kind: str, names: Sequence[str]) -> None:
    """Raise `InputError` if the list is empty or contains a name twice."""
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{kind} '{name}' is named twice. Remove one, or label them.")
    if not names:
        raise InputError(f"no {kind} is named. Name at least one.")


def label_point(point: Mapping[str, str]) -> str:
    """Return the label of a point."""
    return " ".join(
        value if name == "scenario" else f"{name}={value}" for name, value in point.items()
    )


@contextmanager
def _name_point_in_errors(point: Mapping[str, str]) -> Iterator[None]:
    """Prefix errors in the block with the controller values of a point."""
    try:
        yield
    except InputError as error:
        given = {name: text for name, text in point.items() if name.startswith(OF_CONTROLLER)}
        if not given or str(error).startswith("vary "):
            raise
        raise InputError(f"vary {label_point(given)}: {error}") from error
