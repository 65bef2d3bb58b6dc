"""File with the rows of a sweep, which is valid at any time."""

from __future__ import annotations

import csv
import io
import os
import re
from pathlib import Path
from typing import Any, Dict, Iterator, List, Sequence, Tuple

import numpy as np

from ..._core import InputError, QuadcoreError, parse_number
from ...support.output_files import LineFile, atomic_write, check_writable, encode_text, escape_cell
from .plan import AnyPlan
from .row_spec import Row, compute_digest


class RowFile:
    """CSV file with one row per flight, in the order of completion.

    The columns are ``row``, the conditions, ``failure``, the metrics and ``fingerprint``. A
    complete file is sorted.

    Parameters
    ----------
    path
        Path of the file.
    plan
        Plan of the sweep.
    resume
        Whether to keep existing rows; they must match the plan.

    Raises
    ------
    InputError
        If rows exist without `resume`, are damaged, or result from different inputs.
    """

    def __init__(self, path: Path, plan: AnyPlan, resume: bool) -> None:
        self.path, self._plan = path, plan
        self.columns = ["row", *plan.names, "failure", *plan.measures, "fingerprint"]
        for name in self.columns:
            if self.columns.count(name) > 1:
                raise InputError(
                    f"the table would have two columns '{name}'. Rename an axis or a metric."
                )
        self._where = np.full((len(plan), 2), -1, dtype=np.int64)  # start and length of each row
        self.whole = ("row", *plan.whole)
        self._head = _write_line(self.columns)
        check_writable(path)
        if path.exists() and path.stat().st_size > 0 and not resume:
            raise self._make_conflict()
        self._file = LineFile(path, older=True)
        try:
            self.is_resumed = os.fstat(self._file.fileno()).st_size > 0
            if self.is_resumed and not resume:
                raise self._make_conflict()
            self._end = self._index_rows() if self.is_resumed else 0
        except InputError:
            self._file.close()
            raise
        self._file.keep(self._end)
        if not self._end:
            self._append(self._head)

    @property
    def missing(self) -> Iterator[int]:
        """Numbers of the missing rows."""
        return (int(row) for row in np.flatnonzero(self._where[:, 0] < 0))

    @property
    def count(self) -> int:
        """Number of existing rows."""
        return int((self._where[:, 0] >= 0).sum())

    def take(self, row: Row) -> None:
        """Append a row; if the disk is full, raise `InputError` and keep the other rows."""
        line = _write_line(self._cells(row))
        begin = self._end
        self._append(line)
        self._where[row.row] = begin, len(line)

    def close(self) -> None:
        """Sort the rows if none is missing, and close the file."""
        if self.count == len(self._plan) and (np.diff(self._where[:, 0]) < 0).any():
            with atomic_write(self.path) as ordered:
                ordered.write(self._head)
                for line in self._file.parts(self._list_places()):
                    ordered.write(line)
            lengths = self._where[:, 1]
            self._where[:, 0] = len(self._head) + np.cumsum(lengths) - lengths
        self._file.close()

    def read(self) -> Iterator[Dict[str, str]]:
        """Yield the existing rows, sorted by number."""
        file = LineFile(self.path, older=True) if self._file.closed else self._file
        try:
            for line in file.parts(self._list_places()):
                yield dict(zip(self.columns, _split_line(line)))
        finally:
            if file is not self._file:
                file.close()

    def _list_places(self) -> Iterator[Tuple[int, int]]:
        """Yield the start and length of each existing row."""
        return ((begin, length) for begin, length in self._where.tolist() if begin >= 0)

    def _make_conflict(self) -> InputError:
        return InputError(
            f"{self.path}: the file contains rows. Add --resume, or name another folder."
        )

    def _cells(self, row: Row) -> List[Any]:
        measured = row.measures or {}
        return [
            row.row,
            *self._plan.list_cells(row.row).values(),
            row.failure,
            *(measured.get(name, np.nan) for name in self._plan.measures),
            row.fingerprint,
        ]

    def _append(self, line: bytes) -> None:
        self._file.write(line)
        self._end += len(line)

    def _index_rows(self) -> int:
        """Index the rows, and return the number of valid bytes; an incomplete row is dropped."""
        lines = self._file.lines()
        head = next(lines, b"")
        if head != self._head:
            if not head.endswith(b"\n") and self._head.startswith(head):
                return 0
            raise InputError(
                f"{self.path}:1: the columns are not those of this sweep. Name another folder, or "
                "repeat the sweep with its inputs."
            )
        end = len(head)
        for number, line in enumerate(lines, start=2):
            if not line.endswith(b"\n"):
                break
            row = self._check_row(number, _split_line(line))
            self._where[row] = end, len(line)
            end += len(line)
        return end

    def _check_row(self, number: int, cells: Sequence[str]) -> int:
        """Return the number of a row; raise `InputError` unless it matches the plan."""
        place = f"{self.path}:{number}"
        if len(cells) != len(self.columns) or not re.fullmatch(r"[0-9]{1,18}", cells[0]):
            raise InputError(f"{place}: not a row of a sweep. Remove the line.")
        row = int(cells[0])
        if row >= len(self._plan):
            raise InputError(
                f"{place}: row {row} of a sweep with {len(self._plan)} rows. Remove the line."
            )
        if self._where[row, 0] >= 0:
            raise InputError(f"{place}: row {row} occurs twice. Remove one of them.")
        known, planned = dict(zip(self.columns, cells)), self._plan.list_cells(row)
        for name in self._plan.measures:
            if not _is_measure(known[name]):
                raise InputError(
                    f"{place}: column '{name}' contains '{known[name][:80]}', not a number. "
                    "Remove the line."
                )
        for name, value in planned.items():
            if known[name] != _split_line(_write_line([value]))[0]:
                raise InputError(
                    f"{place}: the row has {name} {known[name]}, this sweep {value}. Name another "
                    "folder, or repeat the sweep with its inputs."
                )
        if known["fingerprint"] != compute_fingerprint(self._plan, row):
            raise InputError(
                f"{place}: the row has other inputs: a model, a world, a file or an option has "
                "changed. Name another folder, or repeat the sweep with its inputs."
            )
        if not known["fingerprint"]:
            raise InputError(
                f"{place}: the inputs of the row cannot be compared. Name another folder."
            )
        return row


def compute_fingerprint(plan: AnyPlan, row: int) -> str:
    """Return a digest of the inputs of a row, or of its error; "" if there is no digest."""
    try:
        return plan.make_spec(row).fingerprint()
    except QuadcoreError as error:
        return compute_digest(str(error).encode())


def _write_line(cells: Sequence[Any]) -> bytes:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerow([_escape(value) for value in cells])
    return encode_text(stream.getvalue())


def _is_measure(text: str) -> bool:
    """Whether a cell contains the value of a metric."""
    return text in ("", "inf", "-inf") or parse_number(text) is not None


def _escape(value: Any) -> Any:
    if isinstance(value, str):
        if parse_number(value) is not None:
            return value
        # Each row must fit on one line.
        return escape_cell(value.replace("\n", "\\n").replace("\r", "\\r"))
    return "" if value != value else value


def _split_line(line: bytes) -> List[str]:
    try:
        return next(csv.reader([line.decode("utf-8", "replace")]), [])
    except csv.Error:  # the file is damaged
        return []
