"""Flights of the experiment of chapter 6.1, with an engine or the model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..._core import InputError, QuadcoreError
from ...simulation.commands import CommandsLike, check_commands
from ...simulation.flight import check_log_length
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...simulation.simulation import Simulation
from ...simulation.state import State
from ...support.values import SPAWN, Value, format_value
from ..chapter2 import GYROSTAT, MathematicalModel, Terms, Vehicle
from ..chapter2.vehicle import (
    find_air_plugin,
    find_motor_plugin,
    list_command_order,
    read_parameters,
)
from .ascent import make_ascent
from .drags import DRAGS
from .prescribed_speeds import compute_stiff_gain, fly_prescribed_speeds

MODEL = "model"
LAG, NO_LAG = "motors that lag", "motors without lag"
# Variants of the model, in addition to that of chapter 2.
TERMS: Mapping[str, Terms] = {
    LAG: Terms(),
    NO_LAG: Terms(motor_lag=False),
    "the torque of rotors that spin up": Terms(spin_up=True),
    "rotors that do not turn with the frame": Terms(dragged_rotors=True),
    "both: a gyrostat": GYROSTAT,
}


class Case(NamedTuple):
    """Description of a flight."""

    plant: str
    """Name of an engine, or `MODEL`."""
    sim_slow: float = 1.0
    drag: str = "all"
    """Drag that acts: a key of `DRAGS`, "all" or "none"."""
    variant: str = ""
    """Variant of an engine: "chapter2" (drag model) or "given speeds" (drag model and prescribed
    rotor speeds). Variant of the model: a key of `TERMS`, or "" for chapter 2."""


class Flight(NamedTuple):
    """Result of a case."""

    case: Case
    log: Optional[Log]
    failure: str
    """Reason why the log is missing; "" for success."""


@dataclass(frozen=True)
class Experiment:
    """Settings that all flights share; use `Experiment.of` to make an experiment."""

    asked: Dict[str, Any]
    """Arguments of the caller: model, world, parameters, xacro_args, ignore and spawn."""
    plan: FlightPlan
    """Flight of the plant, with the commands aligned to steps."""
    motor_lag: bool
    air: str
    """Name of the aerodynamic plugin."""
    motor: str
    rotors: Tuple[int, ...]
    """Rotor index of each value in a command."""

    @classmethod
    def of(
        cls,
        model: str = "quadrotor",
        world: Optional[str] = None,
        parameters: Optional[Mapping[str, Value]] = None,
        xacro_args: Optional[Mapping[str, str]] = None,
        ignore: Sequence[str] = (),
        dt: Optional[float] = None,
        duration: float = 10.0,
        spawn: Sequence[float] = SPAWN,
        commands: Optional[CommandsLike] = None,
        motor_lag: bool = True,
        log_every: int = 10,
    ) -> Experiment:
        """Make an experiment; the default commands are those of `make_ascent`.

        Raises
        ------
        InputError
            If an argument is invalid, or the mathematical model has no equations for the vehicle.
        """
        asked: Dict[str, Any] = {
            "model": model,
            "world": world,
            "parameters": dict(parameters or {}),
            "xacro_args": dict(xacro_args or {}),
            "ignore": tuple(ignore),
            "spawn": tuple(spawn),
        }
        for key in asked["parameters"]:
            if key.endswith(".sim_slow"):
                raise InputError(f"{key}: every flight has its own. Give a list of sim_slow.")
        plan = FlightPlan.of(**asked, engine="eigen", dt=dt, duration=duration, log_every=log_every)
        simulation = plan.simulation()
        check_log_length(duration, simulation.dt, log_every)
        vehicle = Vehicle.of(simulation)
        rotors = len(vehicle.arms)
        table = make_ascent(vehicle) if commands is None else check_commands(commands, rotors)
        if table[0, 0] > 0:
            raise InputError(f"commands: the first row is for t = {table[0, 0]:g}. Begin at t = 0.")
        air, motor = find_air_plugin(simulation).name, find_motor_plugin(simulation).name
        table = align_to_steps(table, simulation.dt)
        plan = replace(plan, dt=simulation.dt, commands=table)
        return cls(asked, plan, motor_lag, air, motor, tuple(list_command_order(simulation)))

    @property
    def commands(self) -> np.ndarray:
        """Commands, shape (rows, 1 + n)."""
        assert self.plan.commands is not None
        return self.plan.commands

    def flight(self, case: Case, more: Optional[Mapping[str, Value]] = None) -> FlightPlan:
        """Make the plan of a case: the vehicle starts at rest, with rotors at their first command.

        Parameters
        ----------
        more
            Additional values by ``PLUGIN.TAG``.
        """
        parameters: Dict[str, Value] = dict(self.plan.parameters)
        for plugin in (self.air, self.motor):
            parameters[f"{plugin}.sim_slow"] = case.sim_slow
        for drag, tags in DRAGS.items():
            if case.drag not in ("all", drag):
                parameters.update((f"{self.air}.{tag}", 0) for tag in tags)
        if case.variant in ("chapter2", "given speeds"):
            parameters[f"{self.air}.dragModel"] = "chapter2"
        parameters.update(more or {})
        speeds = np.zeros(len(self.plan.model.joints))
        speeds[list(self.rotors)] = self.commands[0, 1:] / case.sim_slow
        return replace(
            self.plan,
            engine="eigen" if case.plant == MODEL else case.plant,
            parameters={key: format_value(value) for key, value in parameters.items()},
            rotor_velocity=tuple(speeds.tolist()),
        )

    def fly(self, case: Case) -> Flight:
        """Simulate a case; the result contains the reason for a failure."""
        try:
            return Flight(case, self._fly(case), "")
        except QuadcoreError as error:
            return Flight(case, None, str(error))

    def _fly(self, case: Case) -> Log:
        flight = self.flight(case)
        if case.plant == MODEL:
            terms = TERMS.get(case.variant, Terms(motor_lag=self.motor_lag))
            simulation = flight.simulation()
            model = MathematicalModel(Vehicle.of(simulation), terms)
            step = flight.log_every * simulation.dt
            return model.fly(flight.duration, self.commands, _order_rotors(simulation), step)
        if case.variant == "given speeds":
            plain = flight.simulation()
            vehicle = Vehicle.of(plain)
            gain = {f"{self.motor}.kp": compute_stiff_gain(vehicle, plain.dt)}
            stiff = self.flight(case, {**gain, f"{self.motor}.maxVelocity": 1e9})
            return fly_prescribed_speeds(
                stiff.simulation(),
                vehicle,
                self.commands,
                flight.duration,
                flight.log_every,
                self.motor_lag,
            )
        return flight.fly()

    def drags(self) -> List[str]:
        """List the drags that differ for this vehicle: "none", each single drag, and "all"."""
        values = read_parameters(find_air_plugin(self.flight(Case("eigen")).simulation()))
        acting = [d for d, tags in DRAGS.items() if any(float(values[tag]) for tag in tags)]
        return ["none", *acting, "all"]


def align_to_steps(commands: np.ndarray, dt: float) -> np.ndarray:
    """Move each row to the first step that it affects; the last row of a step applies."""
    steps = np.ceil((commands[:, 0] - 1e-9) / dt)
    steps[steps < 0] = 0
    last = np.append(np.diff(steps) > 0, True)
    table: np.ndarray = np.column_stack([steps * dt, commands[:, 1:]])[last]
    return table


def _order_rotors(simulation: Simulation) -> State:
    """Return the current state with the rotors in the order of a command."""
    state = simulation.state.copy()
    state.rotor_velocity = state.rotor_velocity[list_command_order(simulation)]
    return state
