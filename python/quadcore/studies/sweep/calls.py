"""Rows that a function gives, in the place of flights."""

from __future__ import annotations

from dataclasses import dataclass
from types import FunctionType
from typing import Any, Callable, Dict, List, Mapping, Sequence

from ..._core import InputError, QuadcoreError
from ...support.arguments import brief
from ..design import LARGEST, Design
from ..time_limit import time_limit
from .row_spec import Measures, compute_digest, read_source


class Calls:
    """Rows that a function gives, in the place of a `Plan`.

    Parameters
    ----------
    design
        The points.
    function
        Called with a dictionary of a point's values, numbers where they are; returns a number, or a
        mapping.
    measures
        Names of what it returns.
    time_limit
        Of the wall clock for one row, s.
    """

    def __init__(
        self,
        design: Design,
        function: Callable[[Dict[str, Any]], Any],
        measures: Sequence[str],
        time_limit: float,
    ) -> None:
        if not callable(function):
            raise InputError(f"function is {brief(function)}; give what is called with a point")
        if not measures or len(set(measures)) < len(measures):
            raise InputError(f"measures is {brief(measures)}; name what the function returns")
        self.design, self.measures = design, list(measures)
        self.units = dict.fromkeys(self.measures, "")
        self.meanings = dict.fromkeys(self.measures, "what the function returned")
        self._function, self._limit = function, time_limit
        if len(design) > LARGEST:
            raise InputError(f"these are {len(design)} points; at most {LARGEST} are swept")

    at_once = 32
    """Rows of a task at most."""
    apart = False
    whole = ()
    """Columns that hold whole numbers, besides ``row``."""

    def __len__(self) -> int:
        return len(self.design)

    @property
    def names(self) -> List[str]:
        """Of the first columns."""
        return self.design.names

    def list_cells(self, row: int) -> Dict[str, Any]:
        """Tell a row's point."""
        return dict(self.design[row])

    def make_spec(self, row: int) -> Call:
        """Describe a row."""
        return Call(row, self.list_cells(row), self._function, self.measures, self._limit)

    def describe(self) -> Dict[str, Any]:
        """Say what is called."""
        return {
            "function": getattr(self._function, "__qualname__", repr(self._function)),
            **self.design.describe(),
        }


@dataclass(frozen=True)
class Call:
    """A row that a function gives."""

    row: int
    names: Mapping[str, Any]
    function: Callable[[Dict[str, Any]], Any]
    wanted: Sequence[str]
    """Names of what it returns."""
    limit: float

    def fingerprint(self) -> str:
        """Digest of its name, its module's text, and what it is called with.

        "" of what holds more than its text tells: closures, partial functions, objects.
        """
        function, text = self.function, b""
        if isinstance(function, FunctionType) and not function.__closure__:
            text = read_source(function.__module__)
        if not text:
            return ""
        called = f"{function.__module__} {function.__qualname__} {dict(self.names)}"
        return compute_digest(f"{called} {compute_digest(text)}".encode())

    def measure(self) -> Measures:
        """Call it.

        Raises
        ------
        QuadcoreError
            It raised something, or did not return the numbers that were told.
        """
        with time_limit(self.limit):
            found = self.function({name: _number(value) for name, value in self.names.items()})
        values = found if isinstance(found, Mapping) else {self.wanted[0]: found}
        try:
            return {name: float(values[name]) for name in self.wanted}
        except (KeyError, TypeError, ValueError) as error:
            raise QuadcoreError(
                f"the function returned {brief(found)}; give a number, or a mapping of "
                f"{', '.join(self.wanted)} to numbers"
            ) from error


def _number(value: Any) -> Any:
    try:
        return float(value)
    except ValueError:
        return value
