"""Controllers and references of a study."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

from .._core import InputError
from ..control import controllers, gains, references
from ..control.built_in import BuiltInController
from ..control.controller import ControllerLike, check_callable, set_parameter
from ..control.fair_controller import PRIVILEGED, restrict
from ..control.keywords import ReferenceName
from ..control.plugin_controller import PluginController
from ..control.rate_and_delay import DELAY
from ..control.references import ReferenceLike
from ..simulation.flight_plan import FlightPlan
from ..support.arguments import shorten
from ..support.user_code import names_file
from ..support.values import SPAWN, check_pose

Controllers = Union[ControllerLike, Mapping[str, ControllerLike], Sequence[ControllerLike]]
"""One or several controllers, or a mapping of labels to controllers."""

_Reference = Union[ReferenceLike, ReferenceName]
References = Union[_Reference, Mapping[str, _Reference], Sequence[_Reference]]
"""One or several references, or a mapping of labels to references."""


class ControlSetup:
    """Controllers and references with labels; both are empty for open-loop flights.

    Parameters
    ----------
    controllers, references_
        Pairs of a label and a name (as on the command line) or an object (as for `Simulation.run`).
    controller_rate, delay
        Update rate (1/s) and actuation delay (s) of all controllers. None keeps the controller's
        own value.
    on_reference
        Whether flights start on the reference.
    privileged
        Whether user-defined controllers receive the simulation (marked in their labels) or only a
        view of the vehicle. None: they receive the simulation without a mark, for studies that do
        not rank controllers.

    Raises
    ------
    InputError
        If a reference is invalid.
    """

    def __init__(
        self,
        controllers: Sequence[Tuple[str, Any]] = (),
        references_: Sequence[Tuple[str, Any]] = (),
        controller_rate: Optional[float] = None,
        delay: Optional[float] = None,
        on_reference: bool = False,
        privileged: Optional[bool] = None,
    ) -> None:
        self.privileged = privileged
        self.controllers = [
            label + PRIVILEGED if _is_privileged(thing, privileged) else label
            for label, thing in controllers
        ]
        self.references = [label for label, _ in references_]
        self.things = [thing for _, thing in controllers]
        """Controllers as passed by the user."""
        self.shapes = [make_reference(thing) for _, thing in references_]
        self.timing = {"rate": controller_rate, "delay": delay}
        self.on_reference = on_reference
        self.computation_times: Dict[int, float] = {}
        """Computation times by index of the controller, s, which increase its actuation delay."""
        self._own_delays: Dict[Tuple[int, str], float] = {}
        self._make_factory = lru_cache(maxsize=None)(
            lambda i, vehicle: _make_factory(self.things[i], vehicle)
        )

    @classmethod
    def single(
        cls,
        controller: Any,
        reference: Any,
        spawn: Optional[Sequence[Any]],
        controller_rate: Optional[float],
        delay: Optional[float],
    ) -> ControlSetup:
        """Make a setup with one controller and one reference, or an empty one.

        Without a reference, the vehicle hovers at the spawn position.
        """
        if controller is None:
            given = {"reference": reference, "controller_rate": controller_rate, "delay": delay}
            for name, value in given.items():
                if value is not None:
                    raise InputError(f"{name} requires a controller. Give one.")
            return cls()
        on_reference = reference is not None and spawn is None
        if reference is None:
            reference = references.make_hover(check_pose(SPAWN if spawn is None else spawn))
        return cls([("", controller)], [("", reference)], controller_rate, delay, on_reference)

    @property
    def is_closed_loop(self) -> bool:
        """Whether the flights are closed loop."""
        return bool(self.things)

    @property
    def runs_user_code(self) -> bool:
        """Whether flights call user code, which may keep state between flights."""
        return any(map(_is_user_code, self.things)) or not all(
            isinstance(one, references.Shape) for one in self.shapes
        )

    def is_user_code(self, controller: int) -> bool:
        """Whether a controller is user-defined."""
        return _is_user_code(self.things[controller])

    def is_plugin(self, controller: int) -> bool:
        """Whether a controller uses a C++ plugin."""
        return _is_plugin(self.things[controller])

    def is_privileged(self, controller: int) -> bool:
        """Whether a controller is marked as privileged; see `PRIVILEGED`."""
        return _is_privileged(self.things[controller], self.privileged)

    def make(self, controller: int, vehicle: str, values: Mapping[str, float]) -> Any:
        """Make the controller of one flight, with some parameter values."""
        given = {name: x for name, x in {**self.timing, **values}.items() if x is not None}
        made = self._make_factory(controller, vehicle)(given)
        time = self.computation_times.get(controller, 0.0)
        if time:
            # Flights share the object, so its delay may already contain the computation time.
            own = self._own_delays.setdefault(
                (controller, vehicle), float(getattr(made, "delay", DELAY))
            )
            set_parameter(made, "delay", given.get("delay", own) + time)
        return restrict(made) if self.privileged is False else made

    def guide(self, plan: FlightPlan) -> FlightPlan:
        """Add the only controller and reference to a plan."""
        return replace(
            plan,
            controller=self.make(0, plan.model.name, {}),
            reference=self.shapes[0],
            on_reference=self.on_reference,
        )

    def check(self, vehicles: Iterable[str]) -> None:
        """Raise `InputError` if a built-in controller does not support one of the vehicles."""
        for vehicle in vehicles:
            for controller in range(len(self.things)):
                self._make_factory(controller, vehicle)


def add_labels(kind: str, things: Any, one: type) -> List[Tuple[str, Any]]:
    """Add a label to each controller or reference."""
    if isinstance(things, Mapping):
        return [(str(label), thing) for label, thing in things.items()]
    if isinstance(things, (str, one)) or callable(things):
        things = [things]
    if not isinstance(things, Iterable):
        raise InputError(
            f"{kind} is {shorten(things)}. Give a name, a callable, or several of these."
        )
    return [(_make_label(thing), thing) for thing in things]


def make_reference(thing: Any) -> Any:
    """Make a reference from its name; callables are returned unchanged."""
    if isinstance(thing, str):
        return references.parse(thing)
    if not callable(thing):
        raise InputError(
            f"reference is {shorten(thing)}. Give one of quadcore.references, or a function "
            "that is called as reference(t)."
        )
    return thing


def names_user_code(thing: Any) -> bool:
    """Whether `thing` is the name of a user-defined controller."""
    if not isinstance(thing, str):
        return False
    if controllers.names_added_file(thing) or controllers.names_plugin(thing):
        return True
    if controllers.names_gains_file(thing):
        return gains.read(thing).law not in controllers.NAMES
    return names_file(thing) or (":" in thing and thing.partition(":")[0] not in controllers.NAMES)


def _is_user_code(thing: Any) -> bool:
    return (
        names_user_code(thing)
        if isinstance(thing, str)
        else not isinstance(thing, BuiltInController)
    )


def _is_plugin(thing: Any) -> bool:
    if isinstance(thing, str):
        return controllers.uses_plugin(thing)
    return isinstance(thing, PluginController)


def _is_privileged(thing: Any, privileged: Optional[bool]) -> bool:
    """Whether a controller is marked as privileged.

    C++ plugins have access to the whole simulation, and autopilots read the true state as their
    sensors.
    """
    if _is_plugin(thing) or (isinstance(thing, str) and controllers.names_added_file(thing)):
        return privileged is not None
    return bool(privileged) and _is_user_code(thing)


def set_parameters(controller: Any, values: Mapping[str, Any]) -> Any:
    """Set rate, delay and parameters of a controller; None values are skipped."""
    for name, value in values.items():
        if value is not None:
            set_parameter(controller, name, value)
    return controller


def _make_factory(thing: Any, vehicle: str) -> Callable[[Mapping[str, float]], Any]:
    """Return a function that makes the controller of a flight from parameter values.

    This function imports user modules.

    Flights share user-defined objects, because they run in separate processes.
    """
    if names_user_code(thing):
        return lambda values: controllers.parse(thing, vehicle, values)
    if isinstance(thing, str):
        thing = controllers.parse(thing, vehicle)
    check_callable(thing)
    if isinstance(thing, BuiltInController):
        return lambda values: set_parameters(thing.copy(), values)
    return lambda values: set_parameters(thing, values)


def _make_label(thing: Any) -> str:
    if isinstance(thing, str):
        return thing
    if isinstance(thing, (BuiltInController, references.Shape)):
        values = ",".join(f"{name}={value:g}" for name, value in thing.parameters.items())
        return f"{thing.name}:{values}" if values else thing.name
    return getattr(thing, "__name__", type(thing).__name__)
