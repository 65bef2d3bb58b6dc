"""Functions that take the options of a study as keyword arguments."""

from __future__ import annotations

import functools
import inspect
import textwrap
from dataclasses import fields
from typing import Any, Callable, Type, TypeVar, get_type_hints

from ..support import arguments
from ..support.arguments import Kind
from .option_info import explain, list_kinds
from .options import Options

Function = TypeVar("Function", bound=Callable[..., Any])


def accept_options(kind: Type[Options], **own: Kind) -> Callable[[Function], Function]:
    """Let a function take options as ``**options``; its signature and docstring list them.

    Parameters
    ----------
    kind
        The options.
    **own
        Kinds of the other arguments. All arguments are checked before the function is called.
    """

    def decorate(function: Function) -> Function:
        signature, hints = inspect.signature(function), get_type_hints(kind)
        *named, rest = signature.parameters.values()
        known = {**{each.name: arguments.ANY for each in named}, **own, **list_kinds(kind)}

        @functools.wraps(function)
        def call(*values: Any, **given: Any) -> Any:
            bound = signature.bind(*values, **given)
            read = {name: arguments.read_once(value) for name, value in bound.arguments.items()}
            bound.arguments.update(read)
            arguments.check({**read.pop(rest.name, {}), **read}, known)
            return function(*bound.args, **bound.kwargs)

        options = [
            inspect.Parameter(
                each.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=each.default,
                annotation=hints[each.name],
            )
            for each in fields(kind)
        ]
        call.__signature__ = signature.replace(parameters=[*named, *options])  # type: ignore[attr-defined]
        call.__doc__ = (function.__doc__ or "").replace("    **options\n", _paragraphs(kind))
        return call  # type: ignore[return-value]

    return decorate


def _paragraphs(kind: Type[Options]) -> str:
    """Format the options as the parameters of a docstring."""
    lines = []
    for each in fields(kind):
        meaning = explain(each.metadata["about"], each.default)
        description = textwrap.fill(f"{meaning[0].upper()}{meaning[1:]}.", 88)
        lines.append(f"    {each.name}\n{textwrap.indent(description, ' ' * 8)}\n")
    return "".join(lines)
