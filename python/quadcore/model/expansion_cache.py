"""Cache of expanded xacro files."""

from __future__ import annotations

import os
from collections import OrderedDict
from pathlib import Path
from typing import Any, Callable, Generic, List, NamedTuple, Optional, Tuple, TypeVar

from .._core import InputError
from ..support.input_files import LARGEST, read_bytes

Expansion = TypeVar("Expansion")
Answer = TypeVar("Answer")

_MOST = 256  # a study over a xacro argument expands the file repeatedly for each value


class Dependencies:
    """Values other than the text on which an expansion depends, such as environment variables."""

    def __init__(self) -> None:
        self.may_be_kept = True
        self._answers: List[Tuple[Callable[[str], Any], str, Any]] = []

    def ask(self, question: Callable[[str], Answer], subject: str) -> Answer:
        """Return question(subject), and record it as a dependency."""
        answer = question(subject)
        self._answers.append((question, subject, answer))
        return answer

    def is_the_same(self) -> bool:
        """Return whether the values of all dependencies are unchanged."""
        try:
            return all(question(subject) == answer for question, subject, answer in self._answers)
        except Exception:  # the expansion reports the error
            return False


def read_content(path: str) -> Optional[bytes]:
    """Return the contents of a regular file; None if it cannot be read."""
    try:
        return read_bytes(Path(path), LARGEST)
    except InputError:
        return None


def _get_working_folder() -> str:
    try:
        return os.getcwd()
    except OSError:  # the folder was removed
        return ""


class _Entry(NamedTuple):
    outside: Dependencies
    expansion: Any


class ExpansionCache(Generic[Expansion]):
    """Cache of xacro expansions by file, arguments and working folder."""

    def __init__(self) -> None:
        self._entries: OrderedDict[Any, _Entry] = OrderedDict()

    def get(self, key: Any, expand: Callable[[Dependencies], Expansion]) -> Expansion:
        """Return the cached value if its dependencies are unchanged, else the value of `expand`."""
        key = (_get_working_folder(), key)
        entry = self._entries.pop(key, None)
        if entry is None or not entry.outside.is_the_same():
            outside = Dependencies()
            entry = _Entry(outside, expand(outside))
        if entry.outside.may_be_kept:
            self._entries[key] = entry
            while len(self._entries) > _MOST:
                self._entries.popitem(last=False)
        expansion: Expansion = entry.expansion
        return expansion
