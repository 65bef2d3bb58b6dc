"""One flight, described so that it can be flown anywhere."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Mapping, Optional, Sequence, Tuple, TypedDict, Union

import numpy as np

from .. import _core
from .._core import Model, World
from ..control import references
from ..control.built_in import BuiltInController
from ..control.controller import ControllerLike
from ..control.references import ReferenceLike
from ..model.description import read_both
from ..model.overrides import apply_link_values, check_names, split_xacro_arguments
from ..support.values import SPAWN, Number, Value, check_pose, check_whole, format_value
from ..support.warning import suppress_warnings, warn
from .commands import CommandsLike, check_commands
from .controller_pilot import ControllerPilot
from .engines import ENGINE, AnyEngineName
from .flight import Progress
from .log import Log
from .scenarios import Scenario, add_wind
from .scenarios import read_scenario as read_scenario
from .simulation import Simulation, make_simulation

if TYPE_CHECKING:
    from typing_extensions import Unpack

_VERSION = 1  # of what a fingerprint stands for


class _Others(TypedDict, total=False):
    """Keyword arguments that `FlightPlan.of` takes as they are."""

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
    """One flight: what flies, where, and how it is commanded.

    It holds documents and numbers, no paths, so that it can be pickled and flown in another process
    or on another machine: the same bytes come out. `FlightPlan.of` makes one from files and names;
    `dataclasses.replace` makes one that differs in some member.

    Attributes
    ----------
    model, world
        As they were read.
    engine, dt, seed
        As for `Simulation`.
    parameters : mapping of str to str
        "PLUGIN.TAG" -> value. "LINK.mass" and the like may be given, too, and become part of the
        model.
    spawn : tuple of 6 floats
        x, y, z (m), roll, pitch, yaw (rad) of the frame link in the world.
    rotor_velocity : tuple of float, optional
        Of the rotor joints at the start, rad/s; None is at rest.
    duration : float
        s; infinite where whoever flies it says when it ends.
    commands : ndarray (rows, 1 + n), optional
        As for `Simulation.run`.
    controller, reference : optional
        As for `Simulation.run`.
    on_reference : bool
        Whether the flight begins in the full flat state of the reference, not at `spawn`.
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
        """Bring what was given into the form in which it is kept and compared."""
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
        **others: Unpack[_Others],
    ) -> FlightPlan:
        """Read what a flight needs.

        Parameters
        ----------
        model, world, xacro_args, ignore, parameters, spawn, seed
            As for `Simulation`.
        commands
            As for `Simulation.run`; a file is read now.
        scenario
            What befalls the vehicle: a file, or the name of a shipped one.
        wind
            Velocity of a constant wind in world axes, m/s.
        **others
            Members as they stand.

        Raises
        ------
        InputError
            The model, the world, the commands, the scenario or an argument is at fault.
        """
        arguments, given = split_xacro_arguments(parameters, xacro_args)
        readings = read_both(model, world, arguments, ignore)
        check_names(readings[0], parameters or {})
        plan = cls(
            *readings,
            parameters=given,
            spawn=check_pose(spawn),
            seed=seed,
            **others,
        )
        plan = plan.apply_scenario(scenario).with_wind(wind)
        return plan if commands is None else plan.replace_commands(commands)

    @property
    def step(self) -> float:
        """Of the flight, s: the world's unless `dt` is another."""
        return self.world.max_step_size if self.dt is None else self.dt

    def apply_scenario(self, scenario: Union[str, Path, Scenario, None]) -> FlightPlan:
        """Make the same flight in a scenario; what the plan sets wins over it.

        Parameters
        ----------
        scenario : path, str or Scenario, optional
            A file, the name of a shipped one, or what was read; None leaves the flight as it is.

        Raises
        ------
        InputError
            The scenario is at fault: one line with file and line.

        Warns
        -----
        QuadcoreWarning
            Events that come when the flight has ended.
        """
        read = read_scenario(scenario)
        if read is None:
            return self
        model, tags = read.apply_to(self.model)
        plan = replace(self, model=model, parameters={**tags, **self.parameters})
        # Other warnings follow when the vehicle is made.
        with read.locate_errors(), suppress_warnings():
            make_simulation(**plan._vehicle())
        unseen = read.describe_late_events(self.duration)
        if unseen:
            warn(unseen)
        return plan

    def with_wind(self, velocity: Optional[Sequence[float]]) -> FlightPlan:
        """Make the same flight in a constant wind.

        Parameters
        ----------
        velocity : sequence of 3 floats, optional
            Of the air in world axes, m/s; None leaves the flight as it is.
        """
        if velocity is None:
            return self
        model, tags = add_wind(self.model, velocity)
        return replace(self, model=model, parameters={**self.parameters, **tags})

    def replace_commands(self, commands: CommandsLike) -> FlightPlan:
        """Make the same flight under other commands.

        Parameters
        ----------
        commands : ndarray (rows, 1 + n) or path
            As for `Simulation.run`; a file is read now.

        Raises
        ------
        InputError
            The commands, or what else makes a simulation, are at fault.
        """
        vehicle = make_simulation(**self._vehicle())
        return replace(self, commands=check_commands(commands, vehicle.command_width))

    def simulation(self) -> Simulation:
        """Make the vehicle as it takes off; raises and warns as `Simulation` does."""
        simulation = make_simulation(**self._vehicle())
        if self.rotor_velocity is not None:
            state = simulation.state.copy()
            state.rotor_velocity = np.array(self.rotor_velocity, dtype=float)
            simulation.set_state(state)
        if self.on_reference and self.reference is not None:
            spins = self.controller.spins if isinstance(self.controller, BuiltInController) else ()
            simulation.set_state(references.start(simulation, self.reference, spins))
        return simulation

    def pilot(self, simulation: Simulation) -> Optional[ControllerPilot]:
        """Make what asks the controller, if the flight has one; raises as `Simulation.run`.

        Parameters
        ----------
        simulation : Simulation
            Which is to fly, as `simulation()` makes it.
        """
        if self.controller is None:
            return None
        return ControllerPilot(self.controller, simulation, self.reference)

    def fly(self, progress: Optional[Progress] = None) -> Log:
        """Fly it; raises and warns as `Simulation` and `Simulation.run` do.

        Parameters
        ----------
        progress : callable, optional
            Called as progress(steps_done, steps_total) every few hundredths of a second.

        Returns
        -------
        Log
            Of the whole flight, from the state in which it begins.
        """
        return self.fly_with(self.simulation(), progress)

    def fly_with(self, simulation: Simulation, progress: Optional[Progress] = None) -> Log:
        """Do as `fly` with what is made already.

        Parameters
        ----------
        simulation : Simulation
            As `simulation()` makes it.
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
        """Digest of all that the flight depends on, the same in every process and place.

        Hexadecimal. Documents that differ in a comment only count as different; where they lie and
        what they are called does not. The modules of the plugins are taken to be the same.

        Raises
        ------
        InputError
            The controller or the reference is one's own, of which nobody can tell what it does.
        """
        text = json.dumps(self._describe(), sort_keys=True, allow_nan=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def _vehicle(self) -> Dict[str, Any]:
        names = ("model", "world", "engine", "dt", "seed", "parameters", "spawn")
        return {name: getattr(self, name) for name in names}

    def _describe(self) -> Dict[str, Any]:
        told = {item.name: getattr(self, item.name) for item in fields(self)}
        for name in ("model", "world"):
            told[name] = [told[name].document.text, told[name].ignored_elements.ignored]
        for name, own in (("controller", BuiltInController), ("reference", references.Shape)):
            if told[name] is None:
                del told[name]  # as plans of before had none
            elif not isinstance(told[name], own):
                raise _core.InputError(f"a plan whose {name} is your own has no fingerprint")
            else:
                told[name] = told[name].to_dict()
        told["dt"] = self.step
        if self.commands is not None:  # 10 and 10.0 are the same
            told["commands"] = np.asarray(self.commands, dtype=float).tolist()
        return {"version": _VERSION, **told}
