"""Control laws, as `Simulation.run` flies them.

Each function makes one, e.g. ``quadcore.laws.geometric(kp_xy=4)``; its docstring lists the
parameters. ``NAMES`` holds them all. `of_file` makes one of a gains file.
"""

from __future__ import annotations

from typing import Callable, List, Optional, Sequence

from . import _core
from .gains import of_file
from .law import Law
from .parameters import docstring

_COMMON = """\
rate, delay : float
    Calls per simulated second; s after which a command reaches the motors.
spins : sequence of float
    1 or -1 for each rotor; without, neighbours around the vehicle turn against each other.
belief : Simulation, optional
    A vehicle to take for the one that is flown."""


def _function(name: str, summary: str, table: List[_core.ParameterSpec]) -> Callable[..., Law]:
    def make(
        *,
        rate: float = 500,
        delay: float = 0,
        spins: Sequence[float] = (),
        belief: Optional[_core.Simulation] = None,
        **parameters: float,
    ) -> Law:
        return Law(name, rate, delay, spins, belief, **parameters)

    make.__name__ = make.__qualname__ = name
    make.__doc__ = docstring(summary, table, _COMMON)
    return make


_MAKERS = {entry[0]: _function(*entry) for entry in _core.laws()}
NAMES = tuple(_MAKERS)
__all__ = ["NAMES", "Law", "of_file", *NAMES]


def __getattr__(name: str) -> Callable[..., Law]:
    try:
        return _MAKERS[name]
    except KeyError:
        raise AttributeError(f"there is no law '{name}'; there are {', '.join(NAMES)}") from None
