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

_MOST = 256  # a study of an argument of xacro asks for each of its values again and again


class Dependencies:
    """Values outside the text that an expansion depends on, such as environment variables."""

    def __init__(self) -> None:
        self.may_be_kept = True
        self._answers: List[Tuple[Callable[[str], Any], str, Any]] = []

    def ask(self, question: Callable[[str], Answer], subject: str) -> Answer:
        """Return question(subject), and record it as a dependency."""
        answer = question(subject)
        self._answers.append((question, subject, answer))
        return answer

    def is_the_same(self) -> bool:
        """Return whether all dependencies have the same values now."""
        try:
            return all(question(subject) == answer for question, subject, answer in self._answers)
        except Exception:  # the expansion will say what
            return False


def read_content(path: str) -> Optional[bytes]:
    """Return the contents of a regular file, or None if it cannot be read."""
    try:
        return read_bytes(Path(path), LARGEST)
    except InputError:
        return None


def _get_working_folder() -> str:
    try:
        return os.getcwd()
    except OSError:  # it was removed
        return ""


class _Entry(NamedTuple):
    outside: Dependencies
    expansion: Any


class ExpansionCache(Generic[Expansion]):
    """Cache of xacro expansions by file, arguments and working folder."""

    def __init__(self) -> None:
        self._entries: OrderedDict[Any, _Entry] = OrderedDict()

    def get(self, key: Any, expand: Callable[[Dependencies], Expansion]) -> Expansion:
        """Return the cached value if its dependencies are unchanged, or else expand(outside)."""
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
