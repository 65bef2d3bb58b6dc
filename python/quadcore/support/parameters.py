"""Parameters of controllers and references, from the tables of the core."""

from __future__ import annotations

import inspect
from numbers import Real
from typing import Any, Callable, Dict, Iterable, Mapping, Sequence

from .. import _core


def check_values(who: str, given: Mapping[str, Any]) -> Dict[str, float]:
    """Convert parameters to floats; the core checks their names and ranges."""
    for name, value in given.items():
        if not isinstance(value, (bool, Real)):
            raise _core.InputError(f"{who}: '{name}' is {value!r}. Give a number or a flag.")
    return {name: float(value) for name, value in given.items()}


_FLAGS = {"true": 1.0, "false": 0.0}


def read_values(who: str, text: str) -> Dict[str, float]:
    """Parse ``KEY=VALUE,...``, where each value is a number, true or false.

    Raises
    ------
    InputError
        If the text has another format, or a key occurs twice.
    """
    read: Dict[str, float] = {}
    for part in filter(None, text.split(",")):
        key, _, value = part.partition("=")
        number = _FLAGS.get(value, _core.parse_number(value))
        if key in read:
            raise _core.InputError(f"{who}: '{key}' is given twice. Keep one.")
        if number is None or not key:
            raise _core.InputError(
                f"{who}: '{part}' is not of the form KEY=NUMBER. Write NAME:KEY=NUMBER,..."
            )
        read[key] = number
    return read


def write_docstring(summary: str, table: Iterable[_core.ParameterSpec], more: str = "") -> str:
    """Write the docstring of a function with the parameters of a table."""
    lines = [summary[0].upper() + summary[1:] + ".", "", "Parameters", "----------"]
    lines += [more] if more else []
    for spec in table:
        kind = "bool" if spec.is_flag else "float"
        unit = f" [{spec.unit}]" if spec.unit else ""
        source = f"; {spec.equation}" if spec.equation else ""
        lines += [
            f"{spec.name} : {kind}, default {spec.default}",
            f"    {spec.meaning}{unit}{source}.",
        ]
    return "\n".join(lines)


def make_signature(
    function: Callable[..., Any], table: Iterable[_core.ParameterSpec]
) -> inspect.Signature:
    """Return the signature of a function in which a table's parameters replace ``**parameters``."""
    signature = inspect.signature(function)
    own = [each for each in signature.parameters.values() if each.kind is not each.VAR_KEYWORD]
    named = [
        inspect.Parameter(
            spec.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=spec.default == "true" if spec.is_flag else _core.parse_number(spec.default),
            annotation=bool if spec.is_flag else float,
        )
        for spec in table
    ]
    return signature.replace(parameters=[*own, *named])


_CLOSE = 0.7  # minimum similarity of difflib, from 0 to 1


def suggest(name: str, known: Sequence[str]) -> str:
    """Return " Did you mean 'x'?" for the closest known name; "" if no name is close.

    Leading dashes of options are ignored.
    """
    import difflib  # slow to import

    bare = {each.lstrip("-"): each for each in known}
    near = difflib.get_close_matches(name.lstrip("-"), bare, 1, _CLOSE)
    return f" Did you mean '{bare[near[0]]}'?" if near else ""
