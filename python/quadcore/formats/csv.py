"""CSV files: a header, followed by one line per row."""

from __future__ import annotations

import array
from pathlib import Path
from typing import Mapping, Optional, Sequence

import numpy as np

from .._core import InputError, csv_rows, log_remark
from ..support.input_files import read_text
from ..support.output_files import LineFile, atomic_write
from .rows import (
    LogRows,
    Table,
    append_wrenches,
    check_log_columns,
    check_log_rows,
    find_wrench_terms,
    list_wrench_columns,
)

_LARGEST = 10**9  # bytes; commands for more than three hours at 1 kHz
_PIECE = 4096  # rows that are written at once
_REMARK = log_remark(["?"]).strip("\n?")


def read_commands(path: Path, names: Sequence[str]) -> Table:
    """Read columns of numbers; the header must match these names exactly.

    Raises
    ------
    InputError
        If the header or a number is invalid; the message begins with ``FILE:LINE``.
    """
    header, *lines = read_text(path, _LARGEST).rstrip().splitlines() or [""]
    if header.replace(" ", "") != ",".join(names):
        raise InputError(
            f"{path}:1: the header is '{header[:80]}', but the model has {len(names) - 1} rotors. "
            f"Write '{','.join(names)}'."
        )
    rows = _read_numbers(path, lines, 2, names)
    return Table(rows, lambda row: f"{path}:{2 + row}", "")


def read_log(path: Path) -> LogRows:
    """Read a file written by `write_log`.

    Raises
    ------
    InputError
        If the header or a number is invalid; the message begins with ``FILE:LINE``.
    """
    header, *lines = read_text(path, _LARGEST).rstrip().splitlines() or [""]
    columns = header.split(",")
    of_state = check_log_columns(f"{path}:1", columns)
    terms = find_wrench_terms(columns)
    ignored: Sequence[str] = ()
    if lines and lines[0].startswith(_REMARK):
        ignored = lines.pop(0)[len(_REMARK) :].split(", ")
    first = 3 if ignored else 2
    rows = _read_numbers(path, lines, first, columns)
    check_log_rows(lambda row: f"{path}:{first + row}", rows, of_state)
    own = len(columns) - 6 * len(terms)
    wrenches = {name: rows[:, own + 6 * i :][:, :6] for i, name in enumerate(terms)}
    return LogRows(columns[:own], rows[:, :own], wrenches, ignored)


def _read_numbers(
    path: Path, lines: Sequence[str], first: int, columns: Sequence[str]
) -> np.ndarray:
    """Read rows of numbers; `first` is the line number of the first row."""
    values = array.array("d")
    for number, line in enumerate(lines, start=first):
        cells = line.split(",")
        if len(cells) != len(columns):
            raise InputError(f"{path}:{number}: {len(cells)} columns instead of {len(columns)}")
        try:
            if not _is_plain(line):
                raise ValueError
            values.extend([float(cell) for cell in cells])
        except ValueError:
            raise InputError(f"{path}:{number}: {_find_fault(columns, cells)}") from None
    return np.array(values).reshape(-1, len(columns))


def _is_plain(text: str) -> bool:
    """Return whether a text contains no number that only Python accepts, such as 1_000."""
    return "_" not in text and text.isascii()


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return _is_plain(cell)


def _find_fault(columns: Sequence[str], cells: Sequence[str]) -> str:
    column, cell = next(pair for pair in zip(columns, cells) if not _is_number(pair[1]))
    return f"column '{column}' contains '{cell.strip()[:80]}'. Write a number such as -471.5."


def write_log(
    path: Path,
    columns: Sequence[str],
    table: np.ndarray,
    wrenches: Mapping[str, np.ndarray],
    ignored: Sequence[str],
) -> None:
    """Write a log with the fewest digits that preserve every bit."""
    with atomic_write(path) as stream:
        stream.write(_write_head(columns, list(wrenches), ignored))
        for begin in range(0, len(table), _PIECE):
            piece = slice(begin, begin + _PIECE)
            acting = [wrench[piece] for wrench in wrenches.values()]
            stream.write(csv_rows(np.hstack([table[piece], *acting]) if acting else table[piece]))


class CsvFile:
    """Recorder of a CSV file; the file is valid up to its last row at any time."""

    def __init__(
        self, path: Path, columns: Sequence[str], terms: Sequence[str], ignored: Sequence[str]
    ) -> None:
        self.path = path
        self.wrenches = bool(terms)
        self._head = _write_head(columns, terms, ignored)
        self._file: Optional[LineFile] = None

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Write a piece of rows."""
        if self._file is None:  # a rejected flight must not overwrite an older log
            self._file = LineFile(self.path)
            self._file.write(self._head)
        self._file.write(csv_rows(append_wrenches(table, wrenches if self.wrenches else None)))

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()


def _write_head(columns: Sequence[str], terms: Sequence[str], ignored: Sequence[str]) -> bytes:
    """Format the header, and the comment with the ignored parts."""
    return (",".join([*columns, *list_wrench_columns(terms)]) + log_remark(ignored) + "\n").encode()
