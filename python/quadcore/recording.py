"""Where the rows of a flight go while it flies: what is told or drawn afterwards, and files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, List, Optional, Sequence

import numpy as np

from . import _core
from .formats.rows import LogFile, Recorder
from .log import Log

if TYPE_CHECKING:
    from .simulation import Simulation

_DRAWN = 20_000  # rows, more than a picture can show


class Thinned:
    """Rows enough to draw: all, or each so many of a long flight, and the last."""

    wrenches = True

    def __init__(self, rows: int, simulation: Simulation) -> None:
        self.every = -(-rows // _DRAWN)
        self._terms = simulation.wrench_terms
        self._columns = len(_core.log_columns(simulation.rotor_count))
        self._seen = 0
        self._pieces: List[List[np.ndarray]] = [[], []]
        self._last: List[np.ndarray] = []

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Pick from a piece."""
        if len(table) == 0:
            return
        table = table[:, : self._columns]
        picked = slice(-self._seen % self.every, None, self.every)
        self._seen += len(table)
        is_picked = (self._seen - 1) % self.every == 0
        for pieces, rows in zip(self._pieces, (table, wrenches)):
            pieces.append(rows[picked].copy())
        self._last = [] if is_picked else [rows[-1:].copy() for rows in (table, wrenches)]

    def close(self) -> None:
        """Nothing is open."""

    def log(self) -> Log:
        """Give what was picked; the title tells if that is not all."""
        title = f"each {self.every}th row" if self.every > 1 else ""
        table, wrenches = (
            np.concatenate([*pieces, *self._last[i : i + 1]])
            for i, pieces in enumerate(self._pieces)
        )
        return Log(table, {name: wrenches[:, i] for i, name in enumerate(self._terms)}, title)


class Fastest:
    """The largest speed of a rotor, rad/s, and the time of the last row, s."""

    wrenches = False

    def __init__(self, simulation: Simulation) -> None:
        of_state = len(_core.log_columns(0))
        self._rotors = slice(of_state, of_state + simulation.rotor_count)
        self.speed = 0.0
        self.time = 0.0

    def receive(self, table: np.ndarray, _: np.ndarray) -> None:
        """Look at a piece."""
        if len(table):
            self.speed = max(self.speed, np.abs(table[:, self._rotors]).max(initial=0.0))
            self.time = table[-1, 0]

    def close(self) -> None:
        """Nothing is open."""


class Recording:
    """Everything that records one flight; a file that fails does not take the others with it."""

    def __init__(self, files: Sequence[LogFile], others: Sequence[Recorder]) -> None:
        self._files, self._others = list(files), list(others)
        self._failure: Optional[_core.InputError] = None

    @property
    def wrenches(self) -> bool:
        """Whether any of them wants the wrenches."""
        return any(recorder.wrenches for recorder in [*self._files, *self._others])

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Give a piece to all; raises `InputError` when the last of the files has failed."""
        for recorder in self._others:
            recorder.receive(table, wrenches)
        self._each(lambda file: file.receive(table, wrenches))
        if self._failure is not None and not self._files:
            raise self._failure

    def close(self) -> List[Path]:
        """Finish all; returns the files that hold the flight."""
        self._each(lambda file: file.close())
        return [file.path for file in self._files]

    def check(self) -> None:
        """Raise `InputError` if a file failed."""
        if self._failure is not None:
            raise self._failure

    def _each(self, act: Callable[[Any], None]) -> None:
        for file in list(self._files):
            try:
                act(file)
            except _core.InputError as error:
                self._files.remove(file)
                self._failure = self._failure or error
