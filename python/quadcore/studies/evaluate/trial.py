"""One flight of a controller on a vehicle that is not quite as it was told."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Tuple

from ..._core import ParameterInfo, parse_number
from ...control.built_in import BuiltInController
from ...control.controller import check_callable, set_parameter
from ...control.inner_loop import InnerLoop
from ...simulation.flight_plan import FlightPlan
from ...simulation.simulation import Simulation
from ..cases import Case, Cases

EFFECTS = ("thrust", "drag", "lag")
"""Properties of a vehicle that margins vary, as the tables of the plugins' tags name them."""


class Trial(NamedTuple):
    """A controller on the first of everything else, and in what flight and vehicle differ."""

    controller: int
    """By its position in the plan."""
    delay: float = 0.0
    """Besides its own, s."""
    rate: Optional[float] = None
    """Instead of its own, 1/s."""
    thrust: float = 1.0
    """Factor on thrust and torque of the rotors."""
    drag: float = 1.0
    lag: float = 1.0
    """Factor on the time constant of the motors."""

    def make_plan(self, plan: Cases) -> FlightPlan:
        """Describe the flight; raises what making the controller raises."""
        flight = plan.make_plan(Case(self.controller))
        controller = flight.controller
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

    def _scale_tags(self, simulation: Simulation) -> Dict[str, str]:
        """Return the tags of the vehicle that flies."""
        return {
            key: repr(number * getattr(self, tag.effect) ** tag.power)
            for key, tag, number in _scaling_tags(simulation)
        }


def list_missing_effects(simulation: Simulation) -> List[str]:
    """Name the effects that no tag of a vehicle scales."""
    found = {tag.effect for _, tag, _ in _scaling_tags(simulation)}
    return [name for name in EFFECTS if name not in found]


def _scaling_tags(simulation: Simulation) -> Iterator[Tuple[str, ParameterInfo, float]]:
    """Find the tags that scale an effect: PLUGIN.TAG, tag, number."""
    for plugin in simulation.plugins:
        for tag in plugin.parameters:
            number = parse_number(tag.value)
            if tag.effect in EFFECTS and number is not None:
                yield f"{plugin.name}.{tag.name}", tag, number


class _NominalModelController:
    """A controller of one's own that is told of another vehicle than flies; the rest is its own."""

    def __init__(self, controller: Any, vehicle: Simulation) -> None:
        check_callable(controller)
        self._controller, self._vehicle = controller, vehicle
        own = getattr(controller, "inner_loop", None)
        if own is None:
            self.inner_loop = InnerLoop(belief=vehicle)
        elif isinstance(own, InnerLoop) and own.belief is None:
            parameters: Dict[str, Any] = own.parameters
            self.inner_loop = InnerLoop(own.spins, vehicle, **parameters)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._controller, name)

    def reset(self, _: Simulation) -> None:
        """Let the controller begin anew."""
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(self._vehicle)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Ask the controller."""
        return self._controller(t, state, reference)
