"""Options of a command, written in a YAML file by their names."""

from __future__ import annotations

import argparse
import re
from contextlib import contextmanager
from pathlib import Path
from typing import Callable, Iterator, TypeVar

import yaml

from .._core import InputError
from ..support.yaml_nodes import line_of, pairs, root, scalar

_SIGNS = {"set": "=", "vary": "=", "xacro": ":="}
"""Options that give values to keys, with the sign between."""

_PAIRS = "options as KEY: VALUE"

Plan = TypeVar("Plan")


def planned(
    arguments: argparse.Namespace, plan: Callable[[argparse.Namespace], Plan]
) -> tuple[argparse.Namespace, Plan]:
    """Make a plan of arguments, with those of a file of options beneath them if they name one."""
    path = getattr(arguments, "file", None) or arguments.options
    if path is None:
        return arguments, plan(arguments)
    file = OptionsFile(path, arguments.parser)
    arguments = file.beneath(arguments)
    with file.blamed():
        return arguments, plan(arguments)


class OptionsFile:
    """The options in a file.

    Parameters
    ----------
    path
        Of the file.
    parser
        Of the command.

    Raises
    ------
    InputError
        Something wrong in the file, with its line.
    """

    def __init__(self, path: Path, parser: argparse.ArgumentParser) -> None:
        self._path = path
        self._parser = parser
        self._lines: dict[str, int] = {}
        self._read = argparse.Namespace()
        for key, node in pairs(path, root(path), _PAIRS):
            name = key.value
            action = parser._option_string_actions.get(f"--{name}")
            if action is None or name in ("help", "options"):
                raise InputError(
                    f"{path}:{line_of(key)}: there is no option '{name}'; see {parser.prog} -h"
                )
            for text, line in self._texts(name, action, node):
                self._take(action, text, line)

    def beneath(self, arguments: argparse.Namespace) -> argparse.Namespace:
        """Put the file's options beneath those of the command line, which win.

        Of options that give values to keys, key by key; others that may be repeated, such as
        --ignore, hold what both say.
        """
        for name in _SIGNS:
            mine = {key for key, _ in getattr(arguments, name)}
            pairs = getattr(self._read, name, [])
            setattr(self._read, name, [pair for pair in pairs if pair[0] not in mine])
        both: argparse.Namespace = self._parser.parse_args(arguments.words[1:], self._read)
        return both

    @contextmanager
    def blamed(self) -> Iterator[None]:
        """Name file and line in an error of the block that names what stands there."""
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

    def _take(self, action: argparse.Action, text: str, line: int) -> None:
        try:
            read = True if action.nargs == 0 else self._parser._get_values(action, [text])
        except argparse.ArgumentError as error:
            where = f"{self._path}:{line}"
            raise InputError(f"{where}: {error}; see {self._parser.prog} --help") from None
        before = getattr(self._read, action.dest, [])
        setattr(self._read, action.dest, [*before, read] if _repeats(action) else read)

    def _texts(
        self, name: str, action: argparse.Action, node: yaml.Node
    ) -> Iterator[tuple[str, int]]:
        """Write each value of an option as a command line does, with the line that it stands on."""
        if action.nargs == 0:
            if self._text(name, node) not in ("true", "false"):
                raise InputError(f"{self._path}:{line_of(node)}: {name}: write true or false")
            if self._text(name, node) == "true":
                yield "", line_of(node)
        elif name in _SIGNS and isinstance(node, yaml.MappingNode):
            for key, value in pairs(self._path, node, _PAIRS):
                self._lines[key.value] = line_of(key)
                yield f"{key.value}{_SIGNS[name]}{self._list(name, value)}", line_of(key)
        elif _repeats(action):
            for item in node.value if isinstance(node, yaml.SequenceNode) else [node]:
                yield self._text(name, item), line_of(item)
        else:
            yield self._list(name, node), line_of(node)

    def _list(self, name: str, node: yaml.Node) -> str:
        if isinstance(node, yaml.SequenceNode):
            return ",".join(self._text(name, item) for item in node.value)
        return self._text(name, node)

    def _text(self, name: str, node: yaml.Node) -> str:
        written = scalar(self._path, name, node)
        if not written[:1].isdigit() and written not in ("true", "false"):  # those say nothing
            self._lines[written] = line_of(node)
        return written


def _repeats(action: argparse.Action) -> bool:
    """Whether an option may be repeated, and holds all."""
    return isinstance(action, argparse._AppendAction)
