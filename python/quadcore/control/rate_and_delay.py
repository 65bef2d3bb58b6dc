"""When a controller is asked, and how late it acts: bounds and defaults, from the core's table."""

from __future__ import annotations

from numbers import Real
from typing import Any

from .. import _core
from ..support.arguments import brief

_ROWS = {row.name: row for row in _core.timing()}
_WORDS = {"rate": "calls per second", "delay": "seconds"}

RATE = float(_ROWS["rate"].default)
"""Calls per simulated second where none are told."""
DELAY = float(_ROWS["delay"].default)
"""Time after which a command reaches the motors where none is told, s."""


def check_rate_or_delay(who: str, name: str, value: Any) -> float:
    """Give a `rate` or a `delay` as a number; raises `InputError` if it is out of range."""
    if isinstance(value, Real) and _core.is_timing(name, float(value)):
        return float(value)
    raise _core.InputError(
        f"{who}: its {name} is {brief(value)}; give {_WORDS[name]}, {_ROWS[name].range}"
    )
