"""Flights of the margin search: scaled vehicle, delay or update rate, and initial disturbance."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Tuple

from ..._core import InputError, ParameterInfo, parse_number
from ...control.built_in import BuiltInController
from ...control.controller import SENSED, set_parameter
from ...control.fair_controller import FairController
from ...control.inner_loop import InnerLoop
from ...control.plugin_controller import PluginController
from ...control.vehicle import Vehicle
from ...control.wrapped_controller import WrappedController
from ...simulation.flight_plan import FlightPlan
from ...simulation.simulation import Simulation
from ...simulation.state import State
from ..cases import Case, Cases

EFFECTS = ("thrust", "drag", "lag")
"""Effects that tags can scale, as in the tables of tags."""


KICK = 0.1
"""Initial disturbance: change of each component of velocity (m/s) and rates (rad/s)."""


class Trial(NamedTuple):
    """A controller with modified timing and vehicle."""

    controller: int
    """Index of the controller in the plan."""
    delay: float = 0.0
    """Additional delay, s."""
    rate: Optional[float] = None
    """Update rate, 1/s. None: that of the controller."""
    thrust: float = 1.0
    """Factor on thrust and torque of the rotors."""
    drag: float = 1.0
    lag: float = 1.0
    """Factor on the time constant of the motors."""
    kicked: bool = False
    """Whether the flight starts with the disturbance `KICK`."""

    def make_plan(self, plan: Cases) -> FlightPlan:
        """Make the plan of the flight; errors of the controller propagate."""
        flight = plan.make_plan(Case(self.controller))
        if self.kicked:
            flight = _KickedPlan(
                **{each.name: getattr(flight, each.name) for each in fields(flight)}
            )
        controller = flight.controller
        if isinstance(controller, PluginController):
            return self._delay_odometry(flight) if self.delay else flight
        if self.rate is not None:
            set_parameter(controller, "rate", self.rate)
        if self.delay:
            set_parameter(
                controller, "delay", float(getattr(controller, "delay", 0.0)) + self.delay
            )
        if self.thrust == self.drag == self.lag == 1:
            return flight
        described = replace(flight, on_reference=False).simulation()
        if isinstance(controller, BuiltInController):
            if controller.belief is None:
                controller.belief = described
        else:
            controller = _NominalModelController(controller, described)
        changed = {**flight.parameters, **self._scale_tags(described)}
        return replace(flight, controller=controller, parameters=changed)

    def _delay_odometry(self, flight: FlightPlan) -> FlightPlan:
        """Delay the odometry of a plugin, not its commands; the delay of the loop is the same."""
        simulation = replace(flight, on_reference=False).simulation()
        sensor = simulation.topics[SENSED].writer
        for plugin in simulation.plugins:
            for tag in plugin.parameters:
                if plugin.name == sensor and (tag.name, tag.unit) == ("delay", "s"):
                    delay = repr(float(tag.value) + self.delay)
                    key = f"{sensor}.{tag.name}"
                    return replace(flight, parameters={**flight.parameters, key: delay})
        raise InputError(
            f"plugin '{sensor}' of topic '{SENSED}' has no tag <delay>. Use libodometry_plugin.so."
        )

    def _scale_tags(self, simulation: Simulation) -> Dict[str, str]:
        """Return the tag values of the scaled vehicle."""
        return {
            key: repr(number * getattr(self, tag.effect) ** tag.power)
            for key, tag, number in _scaling_tags(simulation)
        }


@dataclass(frozen=True, eq=False)
class _KickedPlan(FlightPlan):
    """Plan of a flight with an initial disturbance."""

    def list_placements(self, simulation: Simulation) -> Iterator[State]:
        yield from super().list_placements(simulation)
        state = simulation.state.copy()
        state.linear_velocity += KICK
        state.angular_velocity += KICK
        yield state


def list_missing_effects(simulation: Simulation) -> List[str]:
    """List the effects that no tag of a vehicle can scale."""
    found = {tag.effect for _, tag, _ in _scaling_tags(simulation)}
    return [name for name in EFFECTS if name not in found]


def _scaling_tags(simulation: Simulation) -> Iterator[Tuple[str, ParameterInfo, float]]:
    """Yield ``PLUGIN.TAG``, the tag and its number, for each tag that scales an effect."""
    for plugin in simulation.plugins:
        for tag in plugin.parameters:
            number = parse_number(tag.value)
            if tag.effect in EFFECTS and number is not None:
                yield f"{plugin.name}.{tag.name}", tag, number


class _NominalModelController(WrappedController):
    """Wrap a user-defined controller, so that `reset` receives the nominal vehicle."""

    def __init__(self, controller: Any, vehicle: Simulation) -> None:
        super().__init__(controller)
        self._vehicle = vehicle
        own = getattr(controller, "inner_loop", None)
        if own is None:
            self.inner_loop = InnerLoop(belief=vehicle)
        elif isinstance(own, InnerLoop) and own.belief is None:
            parameters: Dict[str, Any] = own.parameters
            self.inner_loop = InnerLoop(own.spins, vehicle, **parameters)

    def reset(self, flown: Simulation) -> None:
        """Reset the controller with the nominal vehicle, but the sensors of the simulated one."""
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            is_fair = isinstance(self._controller, FairController)
            reset(Vehicle(self._vehicle, flown) if is_fair else self._vehicle)
