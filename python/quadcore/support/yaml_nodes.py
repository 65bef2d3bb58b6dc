"""Reading of YAML files as nodes, so that error messages can contain lines."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Iterator, Tuple, Union

import yaml

from .._core import InputError, parse_number
from .input_files import read_text

_SCALAR = "tag:yaml.org,2002:"


def read_root(path: Path) -> yaml.Node:
    """Read the root node of a file; raise `InputError` if the file is missing or not YAML."""
    try:
        return yaml.compose(read_text(path), yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        at = mark.line + 1 if mark else 1
        problem = getattr(error, "problem", None) or "not YAML"
        raise InputError(f"{path}:{at}: {problem}") from None
    except RecursionError:
        raise InputError(f"{path}:1: nested too deeply") from None


def read_pairs(
    path: Union[str, Path], node: Any, what: str
) -> Iterator[Tuple[yaml.ScalarNode, yaml.Node]]:
    """Yield the keys and values of a mapping; raise `InputError` if the node is not a mapping."""
    if not isinstance(node, yaml.MappingNode):
        raise InputError(f"{path}:{find_line(node) if node else 1}: write {what}")
    names = set()
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise InputError(f"{path}:{find_line(key)}: a key is not text. Write {what}.")
        if key.value in names:
            raise InputError(f"{path}:{find_line(key)}: {key.value} is given twice. Keep one.")
        names.add(key.value)
        yield key, value


def read_scalar(path: Union[str, Path], name: str, node: yaml.Node) -> str:
    """Return the text of a value; raise `InputError` if the node is not a value."""
    where = f"{path}:{find_line(node)}"
    if not isinstance(node, yaml.ScalarNode):
        kind = "a list" if isinstance(node, yaml.SequenceNode) else "a mapping"
        raise InputError(f"{where}: {name} is {kind} here. Write a value, or a list of values.")
    if node.tag == f"{_SCALAR}null":
        raise InputError(f"{where}: {name} is empty. Write a value, or remove the line.")
    if node.tag == f"{_SCALAR}bool":  # includes yes and on
        return "true" if yaml.SafeLoader.bool_values[node.value.lower()] else "false"
    return str(node.value)


def read_numbers(path: Union[str, Path], name: str, node: yaml.Node, count: int) -> str:
    """Return `count` numbers separated by spaces, or a text if `count` is 0.

    Raises
    ------
    InputError
        If the node has other contents.
    """
    items = node.value if isinstance(node, yaml.SequenceNode) else [node]
    texts = [read_scalar(path, name, item) for item in items]
    if count == 0 and len(texts) == 1:
        return texts[0]
    values = [parse_number(text) for text in texts]
    if len(values) != count or any(v is None or not math.isfinite(v) for v in values):
        form = {0: "a name", 1: "a number"}.get(count, f"a list of {count} numbers")
        raise InputError(f"{path}:{find_line(node)}: {name} is {' '.join(texts)}. Write {form}.")
    return " ".join(texts)


def find_line(node: yaml.Node) -> int:
    """Return the line number of a node, starting at 1."""
    at: int = node.start_mark.line + 1
    return at
