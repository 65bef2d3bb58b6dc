"""The controllers and references of a study."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, Callable, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

from .._core import InputError
from ..control import controllers, references
from ..control.built_in import BuiltInController
from ..control.controller import ControllerLike, check_callable, set_parameter
from ..control.keywords import ReferenceName
from ..control.references import ReferenceLike
from ..simulation.flight_plan import FlightPlan
from ..support.arguments import brief
from ..support.user_code import names_file
from ..support.values import SPAWN, pose

Controllers = Union[ControllerLike, Mapping[str, ControllerLike], Sequence[ControllerLike]]
"""One or several controllers, or a mapping of labels to controllers."""

_Reference = Union[ReferenceLike, ReferenceName]
References = Union[_Reference, Mapping[str, _Reference], Sequence[_Reference]]
"""One or several references, or a mapping of labels to references."""


class ControlSetup:
    """Controllers and references, each with a label; or none, for flights open loop.

    Parameters
    ----------
    controllers, references_
        Labels, and texts as on the command line or objects as `Simulation.run` takes them.
    controller_rate, delay
        Of each controller; None leaves it its own.
    on_reference
        Whether flights begin on the reference.

    Raises
    ------
    InputError
        If a reference is wrong.
    """

    def __init__(
        self,
        controllers: Sequence[Tuple[str, Any]] = (),
        references_: Sequence[Tuple[str, Any]] = (),
        controller_rate: Optional[float] = None,
        delay: Optional[float] = None,
        on_reference: bool = False,
    ) -> None:
        self.controllers = [label for label, _ in controllers]
        self.references = [label for label, _ in references_]
        self.things = [thing for _, thing in controllers]
        """The controllers as they were given."""
        self.shapes = [make_reference(thing) for _, thing in references_]
        self.timing = {"rate": controller_rate, "delay": delay}
        self.on_reference = on_reference
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
        """Take one controller and one reference, or neither.

        Without a reference the vehicle hovers at the spawn.
        """
        if controller is None:
            given = {"reference": reference, "controller_rate": controller_rate, "delay": delay}
            for name, value in given.items():
                if value is not None:
                    raise InputError(f"{name} needs a controller; give one")
            return cls()
        on_reference = reference is not None and spawn is None
        if reference is None:
            reference = references.hover_at(pose(SPAWN if spawn is None else spawn))
        return cls([("", controller)], [("", reference)], controller_rate, delay, on_reference)

    @property
    def is_closed_loop(self) -> bool:
        """Whether the flights are closed loop."""
        return bool(self.things)

    @property
    def runs_user_code(self) -> bool:
        """Whether flights call code of the user's, which may keep a state from flight to flight."""
        return any(map(_is_user_code, self.things)) or not all(
            isinstance(one, references.Shape) for one in self.shapes
        )

    def is_user_code(self, controller: int) -> bool:
        """Whether a controller is the user's."""
        return _is_user_code(self.things[controller])

    def make(self, controller: int, vehicle: str, values: Mapping[str, float]) -> Any:
        """Make a controller for one flight of a vehicle, which gives it some values."""
        made = self._make_factory(controller, vehicle)()
        return set_parameters(made, {**self.timing, **values})

    def guide(self, plan: FlightPlan) -> FlightPlan:
        """Make a flight guided by the only controller and reference."""
        return replace(
            plan,
            controller=self.make(0, plan.model.name, {}),
            reference=self.shapes[0],
            on_reference=self.on_reference,
        )

    def check(self, vehicles: Iterable[str]) -> None:
        """Raise `InputError` if a shipped controller cannot be made for one of some vehicles."""
        for vehicle in vehicles:
            for controller in range(len(self.things)):
                self._make_factory(controller, vehicle)


def add_labels(kind: str, things: Any, one: type) -> List[Tuple[str, Any]]:
    """Give each thing a label."""
    if isinstance(things, Mapping):
        return [(str(label), thing) for label, thing in things.items()]
    if isinstance(things, (str, one)) or callable(things):
        things = [things]
    if not isinstance(things, Iterable):
        raise InputError(
            f"{kind} is {brief(things)}; give a name, what is called, or several of these"
        )
    return [(_make_label(thing), thing) for thing in things]


def make_reference(thing: Any) -> Any:
    """Make a reference of its name; what is one already is given as it is."""
    if isinstance(thing, str):
        return references.parse(thing)
    if not callable(thing):
        raise InputError(
            f"reference is {brief(thing)}; give one of quadcore.references, or a function that is "
            "called as reference(t)"
        )
    return thing


def names_user_code(thing: Any) -> bool:
    """Whether a text names a module or a file of the user's own."""
    return isinstance(thing, str) and (
        names_file(thing) or (":" in thing and thing.partition(":")[0] not in controllers.NAMES)
    )


def _is_user_code(thing: Any) -> bool:
    return (
        names_user_code(thing)
        if isinstance(thing, str)
        else not isinstance(thing, BuiltInController)
    )


def set_parameters(controller: Any, values: Mapping[str, Any]) -> Any:
    """Give a controller its rate, delay and parameters, as far as they are not None."""
    for name, value in values.items():
        if value is not None:
            set_parameter(controller, name, value)
    return controller


def _make_factory(thing: Any, vehicle: str) -> Callable[[], Any]:
    """Make what makes a controller for a flight; a module of the user's is imported then.

    An object is given as it is: flights that run user code have processes of their own.
    """
    if names_user_code(thing):
        return lambda: controllers.parse(thing, vehicle)
    if isinstance(thing, str):
        thing = controllers.parse(thing, vehicle)
    check_callable(thing)
    return thing.copy if isinstance(thing, BuiltInController) else lambda: thing


def _make_label(thing: Any) -> str:
    if isinstance(thing, str):
        return thing
    if isinstance(thing, (BuiltInController, references.Shape)):
        values = ",".join(f"{name}={value:g}" for name, value in thing.parameters.items())
        return f"{thing.name}:{values}" if values else thing.name
    return getattr(thing, "__name__", type(thing).__name__)
