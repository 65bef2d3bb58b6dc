"""What a plan is made of: things with labels, conditions."""

from __future__ import annotations

import itertools
from contextlib import contextmanager
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Sequence, Tuple, Union

from ..._core import InputError
from ...control import laws, references
from ...simulation.engines import list_engines
from ...support.arguments import brief
from ..axes import Values, axes_of
from ..variation import OF_CONTROLLER

Named = Union[str, Any, Mapping[str, Any], Sequence[Any]]


def labelled(kind: str, things: Named, one: type) -> List[Tuple[str, Any]]:
    """Give each thing a label."""
    if isinstance(things, Mapping):
        return [(str(label), thing) for label, thing in things.items()]
    if isinstance(things, (str, one)) or callable(things):
        things = [things]
    if not isinstance(things, Iterable):
        raise InputError(
            f"{kind} is {brief(things)}; give a name, what is called, or several of these"
        )
    return [(_name(thing), thing) for thing in things]


def scenarios(vary: Mapping[str, Values]) -> List[Dict[str, str]]:
    """Make all combinations of the values of each axis."""
    axes = axes_of(vary)
    for axis in axes:
        if axis.name == "engine":
            raise InputError("vary engine: name the engines by themselves")
        if "," in axis.name and OF_CONTROLLER in axis.name:
            raise InputError(f"vary {axis.name}: vary what is the controller's alone")
    names = [axis.name for axis in axes]
    return [dict(zip(names, values)) for values in itertools.product(*(a.values for a in axes))]


def one_by_one(scenarios: Sequence[Mapping[str, str]]) -> List[Dict[str, str]]:
    """Choose scenarios, the first first, in which each value of each axis comes once."""
    first = dict(scenarios[0])
    chosen = {tuple(first.items()): first}
    for scenario in scenarios:
        for name, value in scenario.items():
            one = {**first, name: value}
            chosen.setdefault(tuple(one.items()), one)
    return list(chosen.values())


def label_of(scenario: Mapping[str, str]) -> str:
    """Name a scenario."""
    return " ".join(
        value if name == "scenario" else f"{name}={value}" for name, value in scenario.items()
    )


@contextmanager
def blaming(scenario: Mapping[str, str]) -> Iterator[None]:
    """Name what a scenario gives to controllers in an error of the block."""
    try:
        yield
    except InputError as error:
        given = {name: text for name, text in scenario.items() if name.startswith(OF_CONTROLLER)}
        if not given or str(error).startswith("vary "):
            raise
        raise InputError(f"vary {label_of(given)}: {error}") from error


def check_engines(engines: Iterable[str]) -> None:
    """Raise `InputError` if there is no such plant."""
    known = [name for name, _ in list_engines()]
    for engine in engines:
        if engine not in known:
            raise InputError(f"there is no engine '{engine}'; give some of {', '.join(known)}")


def check_labels(sides: Sequence[Sequence[str]]) -> None:
    """Raise `InputError` if no controller, reference, engine or model is named, or one twice."""
    for kind, names in zip(("controller", "reference", "engine", "model"), sides):
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"{kind} '{name}' is named twice; keep one, or label them")
        if not names:
            raise InputError(f"no {kind} is named; name at least one")


def _name(thing: Any) -> str:
    if isinstance(thing, str):
        return thing
    if isinstance(thing, (laws.Law, references.Shape)):
        values = ",".join(f"{name}={value:g}" for name, value in thing.parameters.items())
        return f"{thing.name}:{values}" if values else thing.name
    return getattr(thing, "__name__", type(thing).__name__)
