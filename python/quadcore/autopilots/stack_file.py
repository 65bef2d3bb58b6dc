"""Stack files: YAML files that define an autopilot and its start."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Tuple, Union

import yaml

from .._core import InputError, parse_number
from ..support.output_files import printable_name
from ..support.parameters import suggest
from ..support.yaml_nodes import find_line, read_pairs, read_root, read_scalar

KEY = "autopilot"
"""Key that identifies a YAML file as a stack file."""

_FORM = "a mapping with autopilot: and program:"


class StackFile(NamedTuple):
    """Contents of a stack file.

    Attributes
    ----------
    file : str
        Name of the file, for messages.
    kind : str
        Name of the stack.
    values : dict
        Values by key, for the keys in the file.
    lines : dict of str to int
        Line of each key.
    """

    file: str
    kind: str
    values: Dict[str, Any]
    lines: Dict[str, int]

    def locate(self, key: str) -> str:
        """Return the location ``FILE:LINE: `` of a key, or of the file."""
        return f"{self.file}:{self.lines.get(key, 1)}: "


def is_stack_file(path: Union[str, Path]) -> bool:
    """Whether a YAML file is a stack file; False if it cannot be read."""
    try:
        root = read_root(Path(path))
    except InputError:
        return False
    return isinstance(root, yaml.MappingNode) and any(
        isinstance(key, yaml.ScalarNode) and key.value == KEY for key, _ in root.value
    )


def read_stack_file(path: Union[str, Path], kinds: Tuple[str, ...]) -> StackFile:
    """Read a stack file.

    Parameters
    ----------
    path : str or path
        YAML file.
    kinds : tuple of str
        Names of the stacks.

    Raises
    ------
    InputError
        If the file is missing or invalid; the message begins with ``FILE:LINE``.
    """
    path = Path(path)
    file = printable_name(path)
    values: Dict[str, Any] = {}
    lines: Dict[str, int] = {}
    for key, node in read_pairs(file, read_root(path), _FORM):
        name = key.value
        if name not in _READERS:
            raise InputError(
                f"{file}:{find_line(key)}: a stack file has no '{name}'."
                f"{suggest(name, list(_READERS))} Use some of {', '.join(_READERS)}."
            )
        lines[name] = find_line(key)
        values[name] = _READERS[name](file, name, node)
    for name in (KEY, "program"):
        if name not in values:
            raise InputError(f"{file}:1: {name}: is missing. Add it.")
    kind = values.pop(KEY)
    if kind not in kinds:
        raise InputError(
            f"{file}:{lines[KEY]}: autopilot '{kind}' does not exist.{suggest(kind, kinds)} "
            f"Use one of {', '.join(kinds)}."
        )
    for name in ("program", "pilot"):
        if "/" in values.get(name, ""):  # relative to the stack file, not to the working folder
            values[name] = str((path.parent / values[name]).absolute())
    return StackFile(file, kind, values, lines)


def _read_number(file: str, name: str, node: yaml.Node) -> float:
    number = parse_number(read_scalar(file, name, node))
    if number is None:
        raise InputError(f"{file}:{find_line(node)}: {name} is not a number. Write one.")
    return float(number)


def _read_list(file: str, name: str, node: yaml.Node) -> List[str]:
    if not isinstance(node, yaml.SequenceNode):
        raise InputError(f"{file}:{find_line(node)}: {name} is not a list. Write [A, B, ...].")
    return [read_scalar(file, name, item) for item in node.value]


def _read_parameters(file: str, name: str, node: yaml.Node) -> Dict[str, str]:
    pairs = read_pairs(file, node, "parameters as NAME: VALUE")
    return {key.value: read_scalar(file, key.value, value) for key, value in pairs}


def _read_curve(file: str, name: str, node: yaml.Node) -> Any:
    if not isinstance(node, yaml.SequenceNode):
        return read_scalar(file, name, node)
    pairs = []
    for item in node.value:
        if not isinstance(item, yaml.SequenceNode) or len(item.value) != 2:
            raise InputError(
                f"{file}:{find_line(item)}: {name} needs pairs. Write [[0, 0], [1, rad/s]]."
            )
        pairs.append([_read_number(file, name, part) for part in item.value])
    return pairs


_READERS: Dict[str, Callable[[str, str, yaml.Node], Any]] = {
    KEY: read_scalar,
    "program": read_scalar,
    "arguments": _read_list,
    "parameters": _read_parameters,
    "commands": _read_list,
    "rotors": _read_list,
    "motor_curve": _read_curve,
    "imu": read_scalar,
    "pilot": read_scalar,
    "hold": _read_number,
    "lockstep": read_scalar,
}
