"""Checks of the types of arguments."""

from __future__ import annotations

import math
import os
import reprlib
from numbers import Integral, Real
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Tuple

import numpy as np

from .._core import InputError
from .parameters import suggest

Kind = Tuple[Callable[[Any], bool], str]
"""Predicate that accepts valid values, and description of these values."""

_LONGEST = 1e9  # s of wall-clock time


def check(arguments: Mapping[str, Any], kinds: Mapping[str, Kind]) -> None:
    """Raise `InputError` if the type of an argument is wrong.

    Parameters
    ----------
    arguments
        Values by name.
    kinds
        Kinds by name; `OPTIONS` contains the kinds of names that are missing here.
    """
    for name, value in arguments.items():
        kind = kinds.get(name) or OPTIONS.get(name)
        if kind is None:
            near = suggest(name, [*kinds, *OPTIONS])
            raise InputError(
                f"option '{name}' does not exist.{near} Use those of help(), or one of "
                f"{', '.join(OPTIONS)}."
            )
        if not kind[0](value):
            raise InputError(f"{name} is {shorten(value)}. Give {kind[1]}.")


def or_none(kind: Kind) -> Kind:
    """Return a kind that also accepts None."""
    return (lambda value: value is None or kind[0](value)), kind[1]


def to_list(value: Any) -> List[Any]:
    """Convert one or several names or functions to a list."""
    return [value] if _is_text(value) or callable(value) else list(value)


def read_once(value: Any) -> Any:
    """Convert an iterator to a list; other values are returned unchanged."""
    return list(value) if isinstance(value, Iterator) else value


def shorten(value: Any) -> str:
    """Return the representation of a value in one line, shortened if it is long."""
    return " ".join(reprlib.repr(value).split())


def _is_text(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def _are_names(value: Any) -> bool:
    return _is_text(value) or _is_list(value)


def _is_list(value: Any) -> bool:
    return _is_lasting(value) and not _is_text(value) and all(map(_is_text, value))


def _is_lasting(value: Any) -> bool:
    """Return whether a value can be iterated more than once."""
    return isinstance(value, Iterable) and not isinstance(value, Iterator)


def _count_numbers(value: Any) -> int:
    """Return the length of a sequence of finite numbers; 0 for any other value."""
    if not _is_lasting(value) or isinstance(value, (str, Mapping)):
        return 0
    numbers = list(value)
    return len(numbers) if all(isinstance(x, Real) and math.isfinite(x) for x in numbers) else 0


def _are_guides(value: Any) -> bool:
    guides = value if isinstance(value, (list, tuple)) else [value]
    return all(isinstance(one, str) or callable(one) for one in guides)


def _are_metrics(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and all(_is_text(x) or callable(x) for x in value)


def _are_named(value: Any) -> bool:
    return isinstance(value, Mapping) and all(isinstance(name, str) for name in value)


def _are_axes(value: Any) -> bool:
    return _are_named(value) and all(
        _is_lasting(one) and not isinstance(one, (str, bytes)) for one in value.values()
    )


def _are_values(value: Any) -> bool:
    return _are_named(value) and all(
        _is_lasting(one) or hasattr(one, "ppf") for one in value.values()
    )


def _are_pairs(value: Any) -> bool:
    return _are_named(value) and all(
        isinstance(pair, (list, tuple))
        and len(pair) == 2
        and all(isinstance(x, Real) for x in pair)
        for pair in value.values()
    )


def _is_whole(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def _is_count(value: Any) -> bool:
    return _is_whole(value) and int(value) >= 1


def _is_limit(value: Any) -> bool:
    return isinstance(value, Real) and 0 < float(value) <= _LONGEST


NAME: Kind = (_is_text, "a name or a path")
NAMES: Kind = (_are_names, "a name, or several")
SOME: Kind = (lambda value: _are_names(value) and len(to_list(value)) > 0, NAMES[1])
LIST: Kind = (_is_list, "a list of names")
GUIDES: Kind = (_are_guides, "names, or functions that are called as reference(t)")
NAMED: Kind = (_are_named, "a mapping of names to values")
AXES: Kind = (_are_axes, "a mapping of names to lists of values")
VALUES: Kind = (_are_values, "a mapping of names to lists of values, texts, or distributions")
BOUNDS: Kind = (_are_pairs, "a mapping of names to (lowest, highest)")
SECONDS: Kind = (lambda value: isinstance(value, Real) and math.isfinite(value), "seconds")
POSITIVE: Kind = (
    lambda value: isinstance(value, Real) and 0 < float(value) < math.inf,
    "seconds, more than 0",
)
DISTANCE: Kind = (POSITIVE[0], "metres, more than 0")
METRICS: Kind = (_are_metrics, "names, or functions that are called as function(log)")
LAG: Kind = (
    lambda value: isinstance(value, Real) and 0 <= float(value) <= 10,
    "seconds, from 0 to 10",
)
VECTOR: Kind = (lambda value: _count_numbers(value) == 3, "three numbers")
PLACE: Kind = (
    lambda value: _count_numbers(value) in (2, 3),
    "latitude and longitude in degrees, and perhaps an altitude in m",
)
LIMIT: Kind = (_is_limit, f"seconds, more than 0 and at most {_LONGEST:g}")
WHOLE: Kind = (_is_whole, "a whole number")
MEASURED = "measured"
"""Value that requests computation times measured on this machine."""
COMPUTATION_TIME: Kind = (
    lambda value: (
        value in (None, MEASURED) or (isinstance(value, Real) and 0 <= float(value) < math.inf)
    ),
    f"seconds, at least 0, or '{MEASURED}'",
)
COUNT: Kind = (_is_count, "a whole number from 1 on")
FLAG: Kind = (lambda value: isinstance(value, (bool, np.bool_)), "True or False")
ANY: Kind = (lambda value: True, "")  # checked when it is read
PROGRESS: Kind = (callable, "a function that is called as progress(done, total)")

OPTIONS: Dict[str, Kind] = {
    "world": or_none(NAME),
    "dt": or_none((lambda value: isinstance(value, Real), "a step in s")),
    "seed": ANY,
    "parameters": or_none(NAMED),
    "xacro_args": or_none(NAMED),
    "ignore": LIST,
}
"""Kinds of the options that studies pass to their simulations."""
