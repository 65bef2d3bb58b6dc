"""The engines that a flight can name: those of the core, and those that are added to them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Callable, Dict, List, Literal, NamedTuple, Optional, Tuple, Union

from .._core import InputError, engines
from ..support.arguments import brief

if TYPE_CHECKING:
    from .simulation import Simulation

EngineName = Literal["gazebo11", "ode", "eigen"]
"""Names of the core's engines, for type checkers; a test compares them with the core's table."""

AnyEngineName = Union[EngineName, Literal["lagrange"]]
"""Names of all engines that flight plans and studies accept."""

ENGINE: EngineName = engines()[0][0]
"""Default engine of a single flight."""

STUDIED: EngineName = "eigen"
"""Default engine of a study."""


class AddedEngine(NamedTuple):
    """A model that moves the vehicle in the place of one of the core's engines.

    No force of a plugin acts on it, so that there are no wrenches.

    Attributes
    ----------
    summary : str
        A noun phrase for lists of engines.
    make : callable
        Takes the arguments of `Simulation` except `engine`, and returns a `Simulation`.
    """

    summary: str
    make: Callable[..., Simulation]


_ADDED: Dict[str, AddedEngine] = {}


def add_engine(name: str, engine: AddedEngine) -> None:
    """Make an engine known to flight plans, studies and commands."""
    _ADDED[name] = engine


def added_engine(name: str) -> Optional[AddedEngine]:
    """Find an engine that was added; None if it is one of the core's, or unknown."""
    return _ADDED.get(name)


def list_engines() -> List[Tuple[str, str]]:
    """Name each engine, with a summary."""
    return [*engines(), *((name, engine.summary) for name, engine in _ADDED.items())]


def exerts_wrenches(engine: str) -> bool:
    """Whether forces of plugins act in an engine."""
    return engine not in _ADDED


def check_wrenches(engine: str) -> None:
    """Raise `InputError` if wrenches are to be logged in an engine that has none."""
    if not exerts_wrenches(engine):
        raise InputError(
            f"Engine {engine} applies no forces of plugins, so that it has no wrenches. "
            "Leave wrenches out, or use another engine."
        )


def check_engine_and_step(engine: EngineName, dt: object) -> Tuple[EngineName, Optional[float]]:
    """Check the name of an engine, known or not, and the length of a step or None."""
    known = ", ".join(name for name, _ in engines())
    if not (isinstance(engine, str) and engine.isprintable()):
        raise InputError(f"engine is {brief(engine)}; give one of {known}")
    if engine in _ADDED:
        raise InputError(
            f"Engine '{engine}' is available in quadcore.FlightPlan, in evaluate, and in the "
            f"commands that list it. Use one of {known} here."
        )
    if dt is None:
        return engine, None
    try:
        if not isinstance(dt, (str, bytes)):
            return engine, float(dt)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        pass
    raise InputError(f"dt is {brief(dt)}; give the length of a step in s")
