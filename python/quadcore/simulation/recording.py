"""Recorders that receive the rows of a flight, for summaries, plots and files."""

from __future__ import annotations

import collections
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Deque, List, Optional, Sequence, Tuple

import numpy as np

from .. import _core
from ..formats.rows import LogFile, Recorder
from .log import Log

if TYPE_CHECKING:
    from .simulation import Simulation

TAIL = 10.0
"""Duration of the final part of a flight that `TrackingError.final` covers, s."""

_DRAWN = 20_000  # rows; a plot cannot show more


class DecimatedRows:
    """Recorder of the rows to plot: all rows, or every N-th row of a long flight."""

    def __init__(self, rows: int, columns: Sequence[str], terms: Sequence[str]) -> None:
        self.every = -(-rows // _DRAWN)
        self.wrenches = bool(terms)
        self._terms = terms
        self._columns = columns
        self._seen = 0
        self._pieces: List[List[np.ndarray]] = [[], []]
        self._last: List[np.ndarray] = []

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Pick rows from a piece."""
        if len(table) == 0:
            return
        picked = slice(-self._seen % self.every, None, self.every)
        self._seen += len(table)
        is_picked = (self._seen - 1) % self.every == 0
        for pieces, rows in zip(self._pieces, (table, wrenches)):
            pieces.append(rows[picked].copy())
        self._last = [] if is_picked else [rows[-1:].copy() for rows in (table, wrenches)]

    def close(self) -> None:
        """Do nothing, because no file is open."""

    def log(self) -> Log:
        """Return the picked rows as a log; its title contains N unless all rows are picked."""
        title = f"every {_format_ordinal(self.every)} row" if self.every > 1 else ""
        table, wrenches = (
            np.concatenate([*pieces, *self._last[i : i + 1]])
            for i, pieces in enumerate(self._pieces)
        )
        named = (
            {name: wrenches[:, i] for i, name in enumerate(self._terms)} if len(wrenches) else {}
        )
        return Log.of_rows(table, self._columns, named, title=title)


def _format_ordinal(number: int) -> str:
    """Format an ordinal number: 1st, 2nd, 3rd, 4th and so on."""
    suffixes = {1: "st", 2: "nd", 3: "rd"}
    is_teen = 10 < number % 100 < 20
    return f"{number}{'th' if is_teen else suffixes.get(number % 10, 'th')}"


class FastestRotor:
    """Recorder of the maximum rotor speed (rad/s) and the time of the last row (s)."""

    wrenches = False

    def __init__(self, simulation: Simulation) -> None:
        of_state = len(_core.log_columns(0))
        self._rotors = slice(of_state, of_state + simulation.rotor_count)
        self.speed = 0.0
        self.time = 0.0

    def receive(self, table: np.ndarray, _: np.ndarray) -> None:
        """Update the results with new rows."""
        if len(table):
            self.speed = max(self.speed, np.abs(table[:, self._rotors]).max(initial=0.0))
            self.time = table[-1, 0]

    def close(self) -> None:
        """Do nothing, because no file is open."""


class TrackingError:
    """Recorder of the tracking error. The results are NaN if no row was recorded."""

    wrenches = False

    def __init__(self, columns: Sequence[str]) -> None:
        self._error = [columns.index(f"error.{name}") for name in ("x", "y", "z")]
        self._count, self._squares, self._largest = 0, 0.0, 0.0
        self._late: Deque[Tuple[np.ndarray, np.ndarray]] = collections.deque()

    def receive(self, table: np.ndarray, _: np.ndarray) -> None:
        """Update the results with new rows."""
        if len(table) == 0:
            return
        lengths = np.linalg.norm(table[:, self._error], axis=1)
        self._count += len(lengths)
        self._squares += float(lengths @ lengths)
        self._largest = max(self._largest, float(lengths.max()))
        self._late.append((table[:, 0].copy(), lengths))
        while self._late[0][0][-1] <= table[-1, 0] - TAIL:
            self._late.popleft()

    def close(self) -> None:
        """Do nothing, because no file is open."""

    @property
    def max(self) -> float:
        """Maximum tracking error of all rows, m."""
        return self._largest if self._count else math.nan

    @property
    def rms(self) -> float:
        """RMS tracking error of all rows, m."""
        return math.sqrt(self._squares / self._count) if self._count else math.nan

    @property
    def final(self) -> float:
        """Maximum tracking error in the last `TAIL` seconds, m."""
        if not self._count:
            return math.nan
        end = self._late[-1][0][-1]
        return max(float(e[t > end - TAIL].max(initial=0.0)) for t, e in self._late)


class Recording:
    """All recorders of a flight. If a file fails, the other recorders continue."""

    def __init__(self, files: Sequence[LogFile], others: Sequence[Recorder]) -> None:
        self._files, self._others = list(files), list(others)
        self._failure: Optional[_core.InputError] = None

    @property
    def wrenches(self) -> bool:
        """Whether a recorder needs wrenches."""
        return any(recorder.wrenches for recorder in [*self._files, *self._others])

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Pass on a piece; raise `InputError` when every file has failed."""
        for recorder in self._others:
            recorder.receive(table, wrenches)
        self._try_each(lambda file: file.receive(table, wrenches))
        if self._failure is not None and not self._files:
            raise self._failure

    def close(self) -> List[Path]:
        """Close all recorders, and return the files that contain the whole flight."""
        for recorder in self._others:
            recorder.close()
        self._try_each(lambda file: file.close())
        return [file.path for file in self._files]

    def check(self) -> None:
        """Raise `InputError` if a file failed."""
        if self._failure is not None:
            raise self._failure

    def _try_each(self, act: Callable[[Any], None]) -> None:
        for file in list(self._files):
            try:
                act(file)
            except _core.InputError as error:
                self._files.remove(file)
                self._failure = self._failure or error
