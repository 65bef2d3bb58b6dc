"""Text, a row per line under the names of the columns."""

from __future__ import annotations

import array
from pathlib import Path
from typing import Mapping, Optional, Sequence

import numpy as np

from .._core import InputError, csv_rows, log_remark
from ..files import Appended, atomic_write, read_text
from .rows import Table

_LARGEST = 10**9  # bytes; of commands more than three hours at 1 kHz
_PIECE = 4096  # rows


def read_commands(path: Path, names: Sequence[str]) -> Table:
    """Read columns of numbers; the header must name these, and nothing else.

    Raises
    ------
    InputError
        Another header, or what is no number; the message begins with ``FILE:LINE:``.
    """
    header, *lines = read_text(path, _LARGEST).rstrip().splitlines() or [""]
    if header.replace(" ", "") != ",".join(names):
        raise InputError(
            f"{path}:1: the header is '{header[:80]}'; this model with {len(names) - 1} rotors "
            f"takes '{','.join(names)}'"
        )
    values = array.array("d")
    for number, line in enumerate(lines, start=2):
        cells = line.split(",")
        if len(cells) != len(names):
            raise InputError(f"{path}:{number}: {len(cells)} columns instead of {len(names)}")
        try:
            if "_" in line or not line.isascii():  # 1_000 and other scripts' digits, to Python
                raise ValueError(f"'{line[:80]}' holds what is no number; write digits 0 to 9")
            values.extend([float(cell) for cell in cells])
        except ValueError as error:
            raise InputError(f"{path}:{number}: {error}") from error
    rows = np.array(values).reshape(-1, len(names))
    return Table(rows, lambda row: f"{path}:{2 + row}", "")


def write_log(
    path: Path,
    columns: Sequence[str],
    table: np.ndarray,
    _: Mapping[str, np.ndarray],
    ignored: Sequence[str],
) -> None:
    """Write a log with 17 significant digits, so that reading restores every bit."""
    with atomic_write(path) as stream:
        stream.write(_head(columns, ignored))
        for begin in range(0, len(table), _PIECE):
            stream.write(csv_rows(table[begin : begin + _PIECE]))


class CsvFile:
    """A log that is written as it is flown, and complete up to its last row at any time."""

    wrenches = False

    def __init__(
        self, path: Path, columns: Sequence[str], _: Sequence[str], ignored: Sequence[str]
    ) -> None:
        self.path = path
        self._head = _head(columns, ignored)
        self._file: Optional[Appended] = None

    def receive(self, table: np.ndarray, _: np.ndarray) -> None:
        """Write a piece."""
        if self._file is None:  # not sooner: a flight that is refused leaves an older log alone
            self._file = Appended(self.path)
            self._file.write(self._head)
        self._file.write(csv_rows(table))

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()


def _head(columns: Sequence[str], ignored: Sequence[str]) -> bytes:
    """First line, and what was ignored."""
    return (",".join(columns) + log_remark(ignored) + "\n").encode()
