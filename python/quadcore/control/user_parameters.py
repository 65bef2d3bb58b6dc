"""Parameters of user-defined controllers: arguments of a class, or attributes of an object."""

from __future__ import annotations

import inspect
from numbers import Real
from typing import Any, Dict, Mapping

from .._core import InputError
from ..support.parameters import suggest

_TIMING = ("rate", "delay", "fixed_rate")


def make_controller(who: str, found: Any, values: Mapping[str, float]) -> Any:
    """Make a controller with parameters.

    Parameters
    ----------
    who
        Name of the controller for messages.
    found
        Class, or an object that can be called as a controller.
    values
        Parameter values. The constructor of a class receives those that it accepts. The others set
        attributes, which must exist.

    Raises
    ------
    InputError
        If a parameter does not exist. Exceptions of the constructor propagate.
    """
    rest = dict(values)
    made = found
    if inspect.isclass(found):
        accepted = _list_arguments(found)
        given = {name: rest.pop(name) for name in list(rest) if name in accepted}
        made = found(**{name: _convert(value, accepted[name]) for name, value in given.items()})
    for name, value in rest.items():
        set_attribute(who, made, name, value)
    return made


def set_attribute(who: str, controller: Any, name: str, value: float) -> None:
    """Set a parameter of a controller object; raise `InputError` if it does not exist."""
    known = _list_attributes(controller)
    if name not in known:
        listed = {**_list_arguments(type(controller)), **known}
        advice = f"Use some of {', '.join(listed)}." if listed else "It has none."
        raise InputError(f"{who} has no parameter '{name}'.{suggest(name, list(listed))} {advice}")
    try:
        setattr(controller, name, _convert(value, known[name]))
    except (AttributeError, TypeError) as error:
        raise InputError(f"{who}: its {name} cannot be set: {error}") from None


def list_parameters(found: Any) -> Dict[str, float]:
    """List the parameters of a class or object that have a numeric default, by name."""
    named = {
        **_list_attributes(found),
        **(_list_arguments(found) if inspect.isclass(found) else {}),
    }
    return {
        name: float(value)
        for name, value in named.items()
        if isinstance(value, Real) and not isinstance(value, bool)
    }


def _list_arguments(kind: type) -> Dict[str, Any]:
    """List the keyword arguments of a constructor with their default values."""
    if kind.__module__ == "builtins":  # type of a function
        return {}
    try:
        parameters = inspect.signature(kind).parameters.values()
    except (TypeError, ValueError):  # compiled classes may have no signature
        return {}
    by_keyword = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    return {each.name: each.default for each in parameters if each.kind in by_keyword}


def _list_attributes(thing: Any) -> Dict[str, Any]:
    """List the public numeric attributes of a controller, except for its timing."""
    owners = thing.__mro__ if inspect.isclass(thing) else (thing, *type(thing).__mro__)
    found: Dict[str, Any] = {}
    for owner in reversed(owners):
        found.update(getattr(owner, "__dict__", {}))
    return {
        name: value
        for name, value in found.items()
        if isinstance(value, Real) and not name.startswith("_") and name not in _TIMING
    }


def _convert(value: float, default: Any) -> Any:
    """Convert a number to the type of its default: a bool, or an int if it has no fraction."""
    if isinstance(default, bool) and value in (0, 1):
        return bool(value)
    if isinstance(default, int) and float(value).is_integer():
        return int(value)
    return value
