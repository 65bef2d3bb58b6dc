"""Parameters of laws and references, as their tables in the core have them."""

from __future__ import annotations

from numbers import Real
from typing import Any, Dict, Iterable, Mapping

from . import _core


def values(who: str, given: Mapping[str, Any]) -> Dict[str, float]:
    """Make numbers of parameters; the core checks their names and ranges."""
    for name, value in given.items():
        if not isinstance(value, (bool, Real)):
            raise _core.InputError(f"{who}: '{name}' is {value!r}; give a number or a flag")
    return {name: float(value) for name, value in given.items()}


def docstring(summary: str, table: Iterable[_core.ParameterSpec], more: str = "") -> str:
    """Write what a function with these parameters does."""
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
