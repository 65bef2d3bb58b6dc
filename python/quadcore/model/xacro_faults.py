"""Readable messages for errors of xacro."""

from __future__ import annotations

import ast
import os
import re
from typing import List

_EXPRESSION = re.compile(r"when evaluating expression '(.*)'", re.DOTALL)


def explain_error(error: BaseException) -> str:
    """Describe an error of xacro in one line."""
    cause, inner = error, error
    while isinstance(getattr(cause, "exc", None), Exception):
        cause, inner = cause.exc, cause  # type: ignore[attr-defined]
    if isinstance(cause, OSError) and cause.filename is not None:
        return f"{os.path.normpath(cause.filename)}: cannot be read: {cause.strerror}"
    if isinstance(cause, RecursionError):
        return "a macro or an include contains itself without end"
    if isinstance(cause, KeyError):
        return _explain_key_error(cause, str(getattr(inner, "suffix", "")))
    text = str(cause if "<class" in str(error) else error)
    hint = ". Define it with <xacro:property>." if isinstance(cause, NameError) else ""
    return (" ".join(text.split()) or type(error).__name__) + hint


def _explain_key_error(error: KeyError, suffix: str) -> str:
    found = _EXPRESSION.search(suffix)
    expression = " ".join(found[1].split()) if found else ""
    keys = _list_keys(expression)
    remedy = f"Use one of {', '.join(keys)}." if keys else f"Correct '{expression or error}'."
    return f"key {' '.join(str(error).split())} does not exist. {remedy}"


def _list_keys(expression: str) -> List[str]:
    """List the keys in an expression dict(name=...)[...]."""
    try:
        tree = ast.parse(expression, mode="eval")
    except SyntaxError:
        return []
    return [
        keyword.arg
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript)
        and isinstance(node.value, ast.Call)
        and getattr(node.value.func, "id", "") == "dict"
        for keyword in node.value.keywords
        if keyword.arg
    ]
