"""Axes of a study: varied quantities with their values."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, List, Mapping, NamedTuple, Sequence, Union

import numpy as np

from .._core import InputError, parse_number
from ..support.values import Value, format_value

WHOLE = ("engine", "world", "scenario")
"""Names of the axes that do not vary a parameter."""

OF_CONTROLLER = "controller."
"""Prefix of axes that vary a controller: its rate, delay or a parameter."""

Values = Union[Sequence[Value], Sequence[Path], np.ndarray]


class Axis(NamedTuple):
    """A varied quantity."""

    name: str
    """``PLUGIN.TAG``, a value such as ``LINK.mass``, ``xacro.ARG``, several of these joined by
    commas, or one of `WHOLE`."""
    values: Sequence[str]

    @property
    def tags(self) -> List[str]:
        """Plugin tags that take the value; empty for an axis of `WHOLE`."""
        return [] if self.name in WHOLE else self.name.split(",")


class Range(Sequence[str]):
    """Evenly or geometrically spaced numbers as texts, computed on access."""

    def __init__(self, first: float, last: float, count: int, geometric: bool) -> None:
        self._first, self._last, self._size, self._geometric = first, last, count, geometric

    def __len__(self) -> int:
        return self._size

    def __getitem__(self, i: Any) -> Any:
        if not 0 <= i < self._size:
            raise IndexError(i)
        part = i / max(1, self._size - 1)
        if self._geometric:
            value = self._first * (self._last / self._first) ** part
        else:
            value = self._first + part * (self._last - self._first)
        return f"{value:.12g}"  # short form, such as 0.3


def parse_axis(name: str, text: str) -> Axis:
    """Read the values of ``--vary NAME=TEXT``: ``a,b,c``, ``a:b:n`` or ``log:a:b:n``.

    Raises
    ------
    InputError
        If there is no value, or the range is invalid.
    """
    if ":" in text and name not in ("world", "scenario"):
        return Axis(name, _parse_range(name, text))
    return Axis(name, [part.strip() for part in text.split(",") if part.strip()])


def make_axes(vary: Mapping[str, Values]) -> List[Axis]:
    """Make axes from names and values; numbers become texts as in a URDF.

    Raises
    ------
    InputError
        If an axis has no values, or combines quantities that need separate axes.
    """
    axes = []
    for key, values in vary.items():
        name = ",".join(part.strip() for part in key.split(","))
        if isinstance(values, str) or len(values) == 0:
            raise InputError(f"vary {name}: no values are given. Give at least one.")
        if set(WHOLE) & set(name.split(",")) and "," in name:
            own = f"{', '.join(WHOLE[:-1])} and {WHOLE[-1]}"
            raise InputError(f"vary {name}: {own} cannot share values. Use an axis for each.")
        if OF_CONTROLLER in name and "," in name:
            raise InputError(
                f"vary {name}: a controller parameter cannot share values. Use an axis for it."
            )
        axes.append(
            Axis(name, values if isinstance(values, Range) else [format_value(v) for v in values])
        )
    return axes


def _parse_range(name: str, text: str) -> Range:
    number = r"([-+0-9.eE]+)"
    match = re.fullmatch(rf"(log:)?{number}:{number}:([0-9]{{1,18}})", text)
    first, last = (parse_number(match[2]), parse_number(match[3])) if match else (None, None)
    if match is None or first is None or last is None or not math.isfinite(first - last):
        raise InputError(
            f"vary {name}: '{text}' is not a range. Write FIRST:LAST:COUNT or log:FIRST:LAST:COUNT."
        )
    count = int(match[4])
    if count == 0:
        raise InputError(f"vary {name}: the range '{text}' is empty. Write a count of at least 1.")
    if match[1] and not first * last > 0:
        raise InputError(
            f"vary {name}: '{text}' is not a geometric range. Write two ends of the same sign, "
            "not 0."
        )
    return Range(first, last, count, bool(match[1]))
