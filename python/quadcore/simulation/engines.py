"""Engines of the core, and engines that other packages register."""

from __future__ import annotations

from typing import TYPE_CHECKING, Callable, Dict, List, Literal, NamedTuple, Optional, Tuple, Union

from .._core import InputError, engines
from ..support.arguments import shorten

if TYPE_CHECKING:
    from .simulation import Simulation

EngineName = Literal["gazebo11", "ode", "eigen"]
"""Names of the core's engines for type checkers; a test compares them with the core."""

AnyEngineName = Union[EngineName, Literal["lagrange"]]
"""Names of all engines that flight plans and studies accept."""

ENGINE: EngineName = engines()[0][0]
"""Default engine of a single flight."""

STUDY_ENGINE: EngineName = "eigen"
"""Default engine of a study."""


class AddedEngine(NamedTuple):
    """Registered model that moves the vehicle instead of an engine of the core.

    Plugins exert no forces in it, so it has no wrenches.

    Attributes
    ----------
    summary : str
        Noun phrase for lists of engines.
    make : callable
        Function that takes the arguments of `Simulation` except `engine` and returns a
        `Simulation`.
    """

    summary: str
    make: Callable[..., Simulation]


_ADDED: Dict[str, AddedEngine] = {}


def add_engine(name: str, engine: AddedEngine) -> None:
    """Register an engine for flight plans, studies and commands."""
    _ADDED[name] = engine


def find_added_engine(name: str) -> Optional[AddedEngine]:
    """Return a registered engine; None for an engine of the core or an unknown name."""
    return _ADDED.get(name)


def list_engines() -> List[Tuple[str, str]]:
    """Return the name and summary of each engine."""
    return [*engines(), *((name, engine.summary) for name, engine in _ADDED.items())]


def exerts_wrenches(engine: str) -> bool:
    """Return whether plugins exert forces in an engine."""
    return engine not in _ADDED


def check_wrenches(engine: str) -> None:
    """Raise `InputError` if an engine has no wrenches to log."""
    if not exerts_wrenches(engine):
        raise InputError(
            f"Engine {engine} applies no forces of plugins, so that it has no wrenches. "
            "Leave wrenches out, or use another engine."
        )


def check_engine_and_step(engine: EngineName, dt: object) -> Tuple[EngineName, Optional[float]]:
    """Check the type of an engine name, and convert a step (s), if given, to float."""
    known = ", ".join(name for name, _ in engines())
    if not (isinstance(engine, str) and engine.isprintable()):
        raise InputError(f"engine is {shorten(engine)}. Give one of {known}.")
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
    raise InputError(f"dt is {shorten(dt)}. Give the length of a step in s.")
