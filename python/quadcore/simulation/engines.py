"""Everything that can be flown: the engines, and the mathematical model in the place of one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Tuple

from .._core import InputError, engines

if TYPE_CHECKING:
    from .simulation import Simulation

ENGINE = engines()[0][0]
"""What flies unless told."""

STUDIED = "eigen"
"""What flies where many flights are asked for, unless told."""

LAGRANGE = "lagrange"


def plants() -> List[Tuple[str, str]]:
    """Name each, with a summary."""
    summary = "the mathematical model of chapter 2: no contact, no forces of plugins"
    return [*engines(), (LAGRANGE, summary)]


def check_wrenches(engine: str) -> None:
    """Raise `InputError` if wrenches are asked of what has none to tell."""
    if engine == LAGRANGE:
        raise InputError(
            f"engine {LAGRANGE}: wrenches are told of plugins, none of whose forces acts on the "
            "mathematical model; leave wrenches out, or fly another engine"
        )


def build(engine: str, **options: Any) -> Simulation:
    """Make what is to be flown.

    Parameters
    ----------
    engine : str
        One of `plants`.
    **options
        As for `Simulation`.

    Raises
    ------
    InputError
        As from `Simulation`; or a vehicle that the mathematical model has no equation for.
    """
    if engine != LAGRANGE:
        from .simulation import Simulation  # which checks what it is given by what is known here

        return Simulation(engine=engine, **options)
    from ..thesis.chapter2.plant import Plant  # scipy is slow to import

    return Plant(**options)
