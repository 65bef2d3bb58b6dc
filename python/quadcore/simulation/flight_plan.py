"""Complete description of a flight, which any process or machine can simulate."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Any,
    Dict,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    Tuple,
    TypedDict,
    Union,
)

import numpy as np

from .. import _core
from .._core import Model, World
from ..control import references
from ..control.built_in import BuiltInController
from ..control.controller import ControllerLike
from ..control.plugin_controller import PluginController
from ..control.references import ReferenceLike
from ..model.description import read_both
from ..model.overrides import apply_link_values, check_names, split_xacro_arguments
from ..support.values import SPAWN, Number, Value, check_pose, check_whole, format_value
from ..support.warning import suppress_warnings, warn
from .commands import CommandsLike, check_commands
from .controller_pilot import ControllerPilot, make_pilot
from .engines import ENGINE, AnyEngineName
from .flight import Progress
from .log import Log
from .reference_pilot import PluginPilot
from .scenarios import Scenario, add_controller, add_wind
from .scenarios import read_scenario as read_scenario
from .simulation import Simulation, check_start, find_start, make_simulation
from .state import State

if TYPE_CHECKING:
    from typing_extensions import Unpack

_VERSION = 1  # version of the contents of a fingerprint


class _Others(TypedDict, total=False):
    """Keyword arguments that `FlightPlan.of` passes on unchanged."""

    engine: AnyEngineName
    dt: Optional[float]
    rotor_velocity: Optional[Tuple[float, ...]]
    duration: float
    controller: Optional[ControllerLike]
    reference: Optional[ReferenceLike]
    on_reference: bool
    log_every: int
    wrenches: bool
    topics: Tuple[str, ...]


@dataclass(frozen=True, eq=False)
class FlightPlan:
    """Complete description of a flight: vehicle, world, initial state and commands.

    A plan contains documents and numbers but no paths. It can be pickled, and its flights are
    bit-identical in every process and on every machine. `FlightPlan.of` makes a plan from files and
    names. `dataclasses.replace` makes a plan with changed attributes.

    Attributes
    ----------
    model, world
        Model and world, as returned by `read_model` and `read_world`.
    engine, dt, seed
        As for `Simulation`.
    parameters : mapping of str to str
        Values by "PLUGIN.TAG". Values of links, such as "LINK.mass", become part of the model.
    spawn : tuple of 6 floats
        x, y, z (m), roll, pitch, yaw (rad) of the frame link in the world.
    rotor_velocity : tuple of float, optional
        Initial velocities of the rotor joints, rad/s. Default: zero.
    duration : float
        Duration, s; infinite if the caller decides when the flight ends.
    commands : ndarray (rows, 1 + n), optional
        As for `Simulation.run`.
    controller, reference : optional
        As for `Simulation.run`.
    on_reference : bool
        Whether to start in the full state of a vehicle that follows the reference, instead of at
        `spawn`.
    log_every, wrenches, topics
        As for `Simulation.run`.
    """

    model: Model
    world: World
    engine: str = ENGINE
    dt: Optional[float] = None
    seed: int = 0
    parameters: Mapping[str, str] = field(default_factory=dict)
    spawn: Tuple[float, ...] = check_pose(SPAWN)
    rotor_velocity: Optional[Tuple[float, ...]] = None
    duration: float = 10.0
    commands: Optional[np.ndarray] = field(default=None, repr=False)
    controller: Any = None
    reference: Optional[ReferenceLike] = None
    on_reference: bool = False
    log_every: int = 1
    wrenches: bool = False
    topics: Tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Convert the attributes to a canonical form for comparisons."""
        model, parameters = apply_link_values(
            self.model, {key: format_value(value) for key, value in self.parameters.items()}
        )
        kept = {
            "model": model,
            "dt": None if self.dt is None else float(self.dt),
            "seed": check_whole(self.seed),
            "parameters": parameters,
            "spawn": check_pose(self.spawn),
            "duration": float(self.duration),
            "log_every": int(self.log_every),
            "wrenches": bool(self.wrenches),
        }
        if self.rotor_velocity is not None:
            kept["rotor_velocity"] = tuple(float(rate) for rate in self.rotor_velocity)
        for name, value in kept.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of(
        cls,
        model: Union[str, Path, Model] = "quadrotor",
        world: Union[str, Path, World, None] = None,
        xacro_args: Optional[Mapping[str, object]] = None,
        ignore: Sequence[str] = (),
        parameters: Optional[Mapping[str, Value]] = None,
        spawn: Sequence[Number] = SPAWN,
        seed: int = 0,
        commands: Optional[CommandsLike] = None,
        scenario: Union[str, Path, Scenario, None] = None,
        wind: Optional[Sequence[float]] = None,
        at: Optional[Sequence[float]] = None,
        **others: Unpack[_Others],
    ) -> FlightPlan:
        """Make a plan from files and names.

        Parameters
        ----------
        model, world, xacro_args, ignore, parameters, spawn, seed
            As for `Simulation`.
        commands
            As for `Simulation.run`. A file is read immediately.
        scenario
            Disturbances and faults: a scenario file, or the name of a built-in scenario.
        wind
            Velocity of a constant wind, world axes, m/s.
        at
            Location on Earth, as for `read_world`.
        **others
            Other attributes of the plan.

        Raises
        ------
        InputError
            If the model, the world, the commands, the scenario or an argument is invalid.
        """
        arguments, given = split_xacro_arguments(parameters, xacro_args)
        readings = read_both(model, world, arguments, ignore, at)
        check_names(readings[0], parameters or {})
        plan = cls(
            *readings,
            parameters=given,
            spawn=check_pose(spawn),
            seed=seed,
            **others,
        )
        plan = plan.with_scenario(scenario).with_wind(wind)
        return plan if commands is None else plan.with_commands(commands)

    @property
    def step(self) -> float:
        """Step of the flight, s: `dt`, or by default the step of the world."""
        return self.world.max_step_size if self.dt is None else self.dt

    def with_scenario(self, scenario: Union[str, Path, Scenario, None]) -> FlightPlan:
        """Return the plan with a scenario; parameters of the plan override the scenario.

        Parameters
        ----------
        scenario : path, str or Scenario, optional
            Scenario, file, or name of a built-in scenario. Default: none.

        Raises
        ------
        InputError
            If the scenario is invalid; the message begins with ``FILE:LINE``.

        Warns
        -----
        QuadcoreWarning
            If an event happens after the end of the flight.
        """
        read = read_scenario(scenario)
        if read is None:
            return self
        model, tags = read.apply_to(self.model)
        world = read.add_obstacles(self.world)
        plan = replace(self, model=model, world=world, parameters={**tags, **self.parameters})
        # Other warnings follow when the vehicle is made.
        with read.locate_errors(), suppress_warnings():
            make_simulation(**plan._vehicle())
        unseen = read.describe_late_events(self.duration)
        if unseen:
            warn(unseen)
        return plan

    def with_wind(self, velocity: Optional[Sequence[float]]) -> FlightPlan:
        """Return the plan with a constant wind.

        Parameters
        ----------
        velocity : sequence of 3 floats, optional
            Velocity of the air, world axes, m/s. Default: no change.
        """
        if velocity is None:
            return self
        model, tags = add_wind(self.model, velocity)
        return replace(self, model=model, parameters={**self.parameters, **tags})

    def with_commands(self, commands: CommandsLike) -> FlightPlan:
        """Return the plan with other commands.

        Parameters
        ----------
        commands : ndarray (rows, 1 + n) or path
            As for `Simulation.run`. A file is read immediately.

        Raises
        ------
        InputError
            If the commands or other attributes of the plan are invalid.
        """
        vehicle = make_simulation(**self._vehicle())
        return replace(self, commands=check_commands(commands, vehicle.command_width))

    def simulation(self, placed: Optional[List[State]] = None) -> Simulation:
        """Make the simulation in its initial state; errors and warnings are those of `Simulation`.

        Parameters
        ----------
        placed : list of State, optional
            List to which the function adds the states passed to `set_state`.
        """
        simulation = make_simulation(**self._vehicle())
        for state in self.list_placements(simulation):
            simulation.set_state(state)
            if placed is not None:
                placed.append(state)
        return simulation

    def list_placements(self, simulation: Simulation) -> Iterator[State]:
        """Yield the states that `set_state` sets before the flight; the last one is its start.

        Parameters
        ----------
        simulation : Simulation
            Simulation of this plan, in the state that was yielded last.
        """
        if self.rotor_velocity is not None:
            state = simulation.state.copy()
            state.rotor_velocity = np.array(self.rotor_velocity, dtype=float)
            yield state
        start = self.find_start(simulation)
        if start is not None:
            yield start

    def find_start(self, simulation: Simulation) -> Optional[State]:
        """Return the initial state on the reference, or None if the flight starts elsewhere.

        Parameters
        ----------
        simulation : Simulation
            Simulation of this plan.

        Raises
        ------
        InputError
            If the plan starts on a reference, but has none.
        """
        check_start(self.on_reference, self.reference)
        if not self.on_reference or self.reference is None:
            return None
        return find_start(simulation, self.controller, self.reference)

    def pilot(
        self, simulation: Simulation, timed: bool = False
    ) -> Union[ControllerPilot, PluginPilot, None]:
        """Make the pilot of the controller, if any; the errors are those of `Simulation.run`.

        Parameters
        ----------
        simulation : Simulation
            Simulation of this plan, as returned by `simulation()`.
        timed : bool
            Whether to measure the duration of each call.
        """
        if self.controller is None:
            return None
        return make_pilot(self.controller, simulation, self.reference, timed)

    def fly(self, progress: Optional[Progress] = None) -> Log:
        """Simulate the flight; errors and warnings are those of `Simulation` and `Simulation.run`.

        Parameters
        ----------
        progress : callable, optional
            Function called as progress(steps_done, steps_total) every few hundredths of a second.

        Returns
        -------
        Log
            Log of the whole flight, including the initial state.
        """
        return self.fly_with(self.simulation(), progress)

    def fly_with(self, simulation: Simulation, progress: Optional[Progress] = None) -> Log:
        """Simulate the flight as `fly` does, but with an existing simulation.

        Parameters
        ----------
        simulation : Simulation
            Simulation of this plan, as returned by `simulation()`.
        progress : callable, optional
            As for `fly`.
        """
        return simulation.run(
            self.duration,
            self.commands,
            self.log_every,
            progress,
            self.wrenches,
            self.topics,
            controller=self.controller,
            reference=self.reference,
        )

    def fingerprint(self) -> str:
        """Return a digest of everything that affects the flight; it is equal in every process.

        Comments in documents affect the digest; names and folders of files do not. The digest does
        not cover plugin libraries.

        Returns
        -------
        str
            Digest in hexadecimal.

        Raises
        ------
        InputError
            If the controller or the reference is user-defined.
        """
        text = json.dumps(self._describe(), sort_keys=True, allow_nan=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def _vehicle(self) -> Dict[str, Any]:
        names = ("model", "world", "engine", "dt", "seed", "parameters", "spawn")
        vehicle = {name: getattr(self, name) for name in names}
        if isinstance(self.controller, PluginController):
            vehicle["model"] = add_controller(self.model, self.controller)
        return vehicle

    def _describe(self) -> Dict[str, Any]:
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        for name in ("model", "world"):
            values[name] = [values[name].document.text, values[name].ignored_elements.ignored]
        for name, own in (("controller", BuiltInController), ("reference", references.Shape)):
            if values[name] is None:
                del values[name]  # for compatibility with earlier plans
            elif not isinstance(values[name], own):
                raise _core.InputError(f"a plan whose {name} is your own has no fingerprint")
            else:
                values[name] = values[name].to_dict()
        values["dt"] = self.step
        if self.commands is not None:  # 10 and 10.0 must give the same digest
            values["commands"] = np.asarray(self.commands, dtype=float).tolist()
        return {"version": _VERSION, **values}
