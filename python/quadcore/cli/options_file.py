"""Options of a command from a YAML file."""

from __future__ import annotations

import argparse
import re
from contextlib import contextmanager
from pathlib import Path
from typing import Callable, Iterator, TypeVar

import yaml

from .._core import InputError
from ..report.drawing import set_formats
from ..support.yaml_nodes import find_line, read_pairs, read_root, read_scalar
from .parser import end_sentence

_SIGNS = {"set": "=", "vary": "=", "xacro": ":="}
"""Options that assign values to keys, with their assignment sign."""

_PAIRS = "options as KEY: VALUE"

Plan = TypeVar("Plan")


def make_plan(
    arguments: argparse.Namespace, plan: Callable[[argparse.Namespace], Plan]
) -> tuple[argparse.Namespace, Plan]:
    """Make a plan from arguments and the options file that they name, if any."""
    path = getattr(arguments, "file", None) or arguments.options
    if path is None:
        return arguments, plan(arguments)
    file = OptionsFile(path, arguments.parser)
    arguments = file.put_beneath(arguments)
    set_formats(arguments.format)
    with file.locate_errors():
        return arguments, plan(arguments)


class OptionsFile:
    """Options in a file.

    Parameters
    ----------
    path
        Path of the file.
    parser
        Parser of the command.

    Raises
    ------
    InputError
        If the file is invalid; the message contains the line.
    """

    def __init__(self, path: Path, parser: argparse.ArgumentParser) -> None:
        self._path = path
        self._parser = parser
        self._lines: dict[str, int] = {}
        self._read = argparse.Namespace()
        for key, node in read_pairs(path, read_root(path), _PAIRS):
            name = key.value
            action = parser._option_string_actions.get(f"--{name}")
            if action is None or name in ("help", "options"):
                raise InputError(
                    f"{path}:{find_line(key)}: option '{name}' does not exist. "
                    f"See {parser.prog} --help."
                )
            for text, line in self._write_values(name, action, node):
                self._store(action, text, line)

    def put_beneath(self, arguments: argparse.Namespace) -> argparse.Namespace:
        """Merge the options of the file with those of the command line, which take precedence.

        Options with keys are merged key by key. Other repeatable options, such as --ignore, keep
        all values.
        """
        for name in _SIGNS:
            mine = {key for key, _ in getattr(arguments, name)}
            given = getattr(self._read, name, [])
            setattr(self._read, name, [pair for pair in given if pair[0] not in mine])
        both: argparse.Namespace = self._parser.parse_args(arguments.words[1:], self._read)
        return both

    @contextmanager
    def locate_errors(self) -> Iterator[None]:
        """Add file and line to an error in the block that names a value of the file."""
        try:
            yield
        except InputError as error:
            text = str(error)
            named = [
                part
                for part in self._lines
                if re.search(rf"(?<![\w.]){re.escape(part)}(?![\w.])", text)
                and not text.startswith(part)
            ]
            if not named:
                raise
            line = self._lines[max(named, key=len)]
            raise InputError(f"{self._path}:{line}: {text}") from error

    def _store(self, action: argparse.Action, text: str, line: int) -> None:
        try:
            read = True if action.nargs == 0 else self._parser._get_values(action, [text])
        except argparse.ArgumentError as error:
            where = f"{self._path}:{line}"
            raise InputError(
                f"{where}: {end_sentence(str(error))} See {self._parser.prog} --help."
            ) from None
        before = getattr(self._read, action.dest, [])
        setattr(self._read, action.dest, [*before, read] if _may_repeat(action) else read)

    def _write_values(
        self, name: str, action: argparse.Action, node: yaml.Node
    ) -> Iterator[tuple[str, int]]:
        """Yield each value of an option as text for the command line, with its line in the file."""
        if action.nargs == 0:
            if self._write_value(name, node) not in ("true", "false"):
                raise InputError(f"{self._path}:{find_line(node)}: {name}: write true or false")
            if self._write_value(name, node) == "true":
                yield "", find_line(node)
        elif name in _SIGNS and isinstance(node, yaml.MappingNode):
            for key, value in read_pairs(self._path, node, _PAIRS):
                self._lines[key.value] = find_line(key)
                yield f"{key.value}{_SIGNS[name]}{self._write_list(name, value)}", find_line(key)
        elif _may_repeat(action):
            for item in node.value if isinstance(node, yaml.SequenceNode) else [node]:
                yield self._write_value(name, item), find_line(item)
        else:
            yield self._write_list(name, node), find_line(node)

    def _write_list(self, name: str, node: yaml.Node) -> str:
        if isinstance(node, yaml.SequenceNode):
            return ",".join(self._write_value(name, item) for item in node.value)
        return self._write_value(name, node)

    def _write_value(self, name: str, node: yaml.Node) -> str:
        written = read_scalar(self._path, name, node)
        if not written[:1].isdigit() and written not in ("true", "false"):  # identify nothing
            self._lines[written] = find_line(node)
        return written


def _may_repeat(action: argparse.Action) -> bool:
    """Return whether an option is repeatable, which keeps all its values."""
    return isinstance(action, argparse._AppendAction)
