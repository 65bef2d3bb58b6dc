"""Controllers and references, as studies take them and hand them to each of their flights."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any, Callable, Iterable, Optional, Sequence

from .._core import InputError
from ..control import laws, references
from ..control.controller import check_callable
from ..simulation.controller_pilot import Guided
from ..simulation.flight_plan import FlightPlan
from ..simulation.simulation import Simulation
from ..support.arguments import brief
from ..support.values import SPAWN, pose
from .variation import give_all


class Guidance:
    """What flies the flights of one study, and where to.

    Parameters
    ----------
    controller
        As the command line names it, or as `Simulation.run` takes it; None: nothing does.
    reference
        The same; None: hover at `spawn`.
    spawn
        Where flights begin; None: on the reference, if one is given.
    controller_rate, delay
        Of the controller; None leaves it its own.
    vehicles
        Names of the robots that fly.

    Raises
    ------
    InputError
        What is known to be wrong before anything flies; a controller of the user's own by its name
        is brought in by each flight.
    """

    def __init__(
        self,
        controller: Any,
        reference: Any,
        spawn: Optional[Sequence[Any]],
        controller_rate: Optional[float],
        delay: Optional[float],
        vehicles: Sequence[str],
    ) -> None:
        self.is_given = controller is not None
        self._is_own = self.is_given and is_own(controller)
        self._values = {"rate": controller_rate, "delay": delay}
        self._on_reference = reference is not None and spawn is None
        if not self.is_given:
            given = {"reference": reference, "controller_rate": controller_rate, "delay": delay}
            for name, value in given.items():
                if value is not None:
                    raise InputError(f"{name} needs a controller; give one")
            return
        self._maker = lru_cache(maxsize=None)(lambda vehicle: maker(controller, vehicle))
        for name in vehicles:
            self._maker(name)
        if reference is None:
            self._reference = references.hover_at(pose(SPAWN if spawn is None else spawn))
        else:
            self._reference = shape(reference)

    @property
    def apart(self) -> bool:
        """Whether flights call what others wrote, which may remember one when it flies another."""
        return self.is_given and (self._is_own or not isinstance(self._reference, references.Shape))

    def onto(self, plan: FlightPlan) -> FlightPlan:
        """Make the same flight guided, its controller made anew; raises what making it raises."""
        if not self.is_given:
            return plan
        return replace(
            plan,
            controller=self._controller(plan.model.name),
            reference=self._reference,
            on_reference=self._on_reference,
        )

    def check(self, vehicles: Iterable[Simulation]) -> None:
        """Raise `InputError` if a law of quadcore can begin on none of some vehicles."""
        if not self.is_given or self._is_own:
            return
        refused = None
        for vehicle in vehicles:
            try:
                law = self._controller(vehicle.model.name)
                Guided(law, vehicle, self._reference).reset(vehicle)
                return
            except InputError as error:
                refused = refused or error
        if refused is not None:
            raise refused

    def _controller(self, vehicle: str) -> Any:
        return give_all(self._maker(vehicle)(), self._values.items())


def maker(thing: Any, vehicle: str) -> Callable[[], Any]:
    """Make what makes a controller for a flight; one of the user's own is brought in then.

    An object is given as it is: flights of what others wrote have processes of their own.
    """
    if names_own(thing):
        return lambda: laws.parse(thing, vehicle)
    if isinstance(thing, str):
        thing = laws.parse(thing, vehicle)
    check_callable(thing)
    return thing.copy if isinstance(thing, laws.Law) else lambda: thing


def shape(thing: Any) -> Any:
    """Make a reference of its name; what is one already is given as it is."""
    if isinstance(thing, str):
        return references.parse(thing)
    if not callable(thing):
        raise InputError(
            f"reference is {brief(thing)}; give one of quadcore.references, or a function that is "
            "called as reference(t)"
        )
    return thing


def names_own(thing: Any) -> bool:
    """Whether a text names a module of the user's own."""
    return isinstance(thing, str) and ":" in thing and thing.partition(":")[0] not in laws.NAMES


def is_own(thing: Any) -> bool:
    """Whether a controller is none of quadcore's laws."""
    return names_own(thing) if isinstance(thing, str) else not isinstance(thing, laws.Law)
