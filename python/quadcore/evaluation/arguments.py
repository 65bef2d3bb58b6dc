"""Arguments of `evaluate`: what kind each is, told before anything flies."""

from __future__ import annotations

import math
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Mapping, Tuple

from .._core import InputError

LONGEST = 1e9
"""Time limit, s."""


def check(arguments: Mapping[str, Any]) -> None:
    """Raise `InputError` for an argument of another kind, or of a name that there is not."""
    for name, value in arguments.items():
        if name not in _KINDS:
            options = ", ".join(_OPTIONS)
            raise InputError(
                f"there is no option '{name}'; besides those of help() there are {options}"
            )
        is_one, form = _KINDS[name]
        if not is_one(value):
            raise InputError(f"{name} is {value!r}; give {form}")


def _is_text(value: Any) -> bool:
    return isinstance(value, (str, Path))


def _are_names(value: Any) -> bool:
    return _is_text(value) or (isinstance(value, Iterable) and all(map(_is_text, value)))


def _are_named(value: Any) -> bool:
    return isinstance(value, Mapping) and all(isinstance(name, str) for name in value)


def _are_values(value: Any) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, (str, bytes))


def _is_count(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool) and int(value) >= 1


def _is_limit(value: Any) -> bool:
    return isinstance(value, Real) and 0 < float(value) <= LONGEST


def _or_none(is_one: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda value: value is None or is_one(value)


Kind = Tuple[Callable[[Any], bool], str]

_NAMES: Kind = (_are_names, "a name, or several")
_NAMED: Kind = (_or_none(_are_named), "a mapping of names to values")
_OPTIONS: Dict[str, Kind] = {
    "world": (_or_none(_is_text), "a name or a path"),
    "dt": (_or_none(lambda value: isinstance(value, Real)), "a step in s"),
    "seed": (lambda value: True, ""),  # told where it is read
    "parameters": _NAMED,
    "xacro_args": _NAMED,
    "ignore": _NAMES,
}
_KINDS: Dict[str, Kind] = {
    **_OPTIONS,
    "engines": _NAMES,
    "models": _NAMES,
    "vary": (
        _or_none(lambda value: _are_named(value) and all(map(_are_values, value.values()))),
        "a mapping of names to lists of values",
    ),
    "duration": (lambda value: isinstance(value, Real) and math.isfinite(value), "seconds"),
    "time_limit": (_is_limit, f"seconds, more than 0 and at most {LONGEST:g}"),
    "margins": (lambda value: isinstance(value, bool), "True or False"),
    "processes": (_or_none(_is_count), "a whole number from 1 on"),
    "progress": (_or_none(callable), "a function that is called as progress(done, total)"),
}
