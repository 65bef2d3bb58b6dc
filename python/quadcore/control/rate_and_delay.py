"""Rate and delay of controllers: limits and defaults from the table of the core."""

from __future__ import annotations

from numbers import Real
from typing import Any

from .. import _core
from ..support.arguments import shorten

_ROWS = {row.name: row for row in _core.timing()}
_WORDS = {"rate": "calls per second", "delay": "seconds"}

RATE = float(_ROWS["rate"].default)
"""Default number of calls per simulated second, 1/s."""
DELAY = float(_ROWS["delay"].default)
"""Default actuation delay, s."""


def check_rate_or_delay(who: str, name: str, value: Any) -> float:
    """Return a `rate` or `delay` as a float; raise `InputError` if it is out of range."""
    if isinstance(value, Real) and _core.is_timing(name, float(value)):
        return float(value)
    raise _core.InputError(
        f"{who}: its {name} is {shorten(value)}. Give {_WORDS[name]}, {_ROWS[name].range}."
    )
