"""Rows of a sweep that call a function instead of simulating a flight."""

from __future__ import annotations

from dataclasses import dataclass
from types import FunctionType
from typing import Any, Callable, Dict, List, Mapping, Sequence

from ..._core import InputError, QuadcoreError
from ...support.arguments import shorten
from ..design import LARGEST, Design
from ..time_limit import time_limit
from .row_spec import Measures, compute_digest, read_source


class Calls:
    """Plan of a sweep that calls a function.

    Parameters
    ----------
    design
        Points of the sweep.
    function
        Function called with a dictionary of the values of a point; returns a number or a mapping.
    measures
        Names of the returned values.
    time_limit
        Wall-clock limit per row, s.
    """

    def __init__(
        self,
        design: Design,
        function: Callable[[Dict[str, Any]], Any],
        measures: Sequence[str],
        time_limit: float,
    ) -> None:
        if not callable(function):
            raise InputError(f"function is {shorten(function)}. Give a callable.")
        if not measures or len(set(measures)) < len(measures):
            raise InputError(f"measures is {shorten(measures)}. Name each returned value once.")
        self.design, self.measures = design, list(measures)
        self.units = dict.fromkeys(self.measures, "")
        self.meanings = dict.fromkeys(self.measures, "value that the function returned")
        self._function, self._limit = function, time_limit
        if len(design) > LARGEST:
            raise InputError(
                f"{len(design)} points are more than {LARGEST}. Use fewer values or samples."
            )

    at_once = 32
    """Maximum number of rows per task."""
    apart = False
    whole = ()
    """Integer columns, in addition to ``row``."""

    def __len__(self) -> int:
        return len(self.design)

    @property
    def names(self) -> List[str]:
        """Names of the parameter columns."""
        return self.design.names

    def list_cells(self, row: int) -> Dict[str, Any]:
        """Return the parameter values of a row by name."""
        return dict(self.design[row])

    def make_spec(self, row: int) -> Call:
        """Make the specification of a row."""
        return Call(row, self.list_cells(row), self._function, self.measures, self._limit)

    def describe(self) -> Dict[str, Any]:
        """Return the settings of the sweep as plain values."""
        return {
            "function": getattr(self._function, "__qualname__", repr(self._function)),
            **self.design.describe(),
        }


@dataclass(frozen=True)
class Call:
    """A row that calls a function."""

    row: int
    names: Mapping[str, Any]
    function: Callable[[Dict[str, Any]], Any]
    wanted: Sequence[str]
    """Names of the returned values."""
    limit: float

    def fingerprint(self) -> str:
        """Return a digest of the function's name, its module's source, and the arguments.

        Closures, partial functions and callable objects have no digest ("").
        """
        function, text = self.function, b""
        if isinstance(function, FunctionType) and not function.__closure__:
            text = read_source(function.__module__)
        if not text:
            return ""
        called = f"{function.__module__} {function.__qualname__} {dict(self.names)}"
        return compute_digest(f"{called} {compute_digest(text)}".encode())

    def measure(self) -> Measures:
        """Call the function and return its values.

        Raises
        ------
        QuadcoreError
            If the function does not return numbers with the names in `measures`.
        """
        with time_limit(self.limit):
            found = self.function({name: _number(value) for name, value in self.names.items()})
        values = found if isinstance(found, Mapping) else {self.wanted[0]: found}
        try:
            return {name: float(values[name]) for name in self.wanted}
        except (KeyError, TypeError, ValueError) as error:
            raise QuadcoreError(
                f"the function returned {shorten(found)}. Return a number, or a mapping of "
                f"{', '.join(self.wanted)} to numbers."
            ) from error


def _number(value: Any) -> Any:
    try:
        return float(value)
    except ValueError:
        return value
