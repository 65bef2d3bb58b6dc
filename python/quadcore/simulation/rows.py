"""Collector of the logged rows of a flight."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from .. import _core
from .log import Log
from .trajectory import per_command


class Rows:
    """Collector of the rows that `fly` passes on. If memory runs out, earlier rows remain."""

    def __init__(self, simulation: _core.Simulation, columns: Sequence[str]) -> None:
        self._columns = list(columns)
        self._terms = simulation.wrench_terms
        self._ignored = simulation.ignored
        self._per_command = per_command(simulation)
        self._count = 0
        self._table = np.empty((0, len(self._columns)))
        self._wrenches = np.empty((0, len(self._terms), 6))
        self._with_wrenches = False

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Append a piece of rows."""
        self._table = _append(self._table, self._count, table)
        if len(wrenches):
            self._with_wrenches = True
            self._wrenches = _append(self._wrenches, self._count, wrenches)
        self._count += len(table)

    def log(self) -> Log:
        """Return the rows so far as a log."""
        wrenches = self._wrenches[: self._count]
        named = {name: wrenches[:, i] for i, name in enumerate(self._terms)}
        log = Log.of_rows(
            self._table[: self._count],
            self._columns,
            named if self._with_wrenches else {},
            self._ignored,
        )
        log.per_command = self._per_command
        return log


def _append(array: np.ndarray, count: int, piece: np.ndarray) -> np.ndarray:
    """Append a piece to the first `count` rows of an array, and return the extended array."""
    if len(piece) == 0:
        return array
    if count == 0:
        return piece[:]  # most flights have a single piece, which other recorders may use as well
    if not array.flags.owndata:
        array = array.copy()
    _grow(array, count + len(piece))
    array[count : count + len(piece)] = piece
    return array


def _grow(array: np.ndarray, rows: int) -> None:
    """Enlarge an array to at least this number of rows, in place if possible."""
    if rows <= len(array):
        return
    # resize() uses realloc, which moves large blocks without copying.
    try:
        array.resize((rows + rows // 8, *array.shape[1:]), refcheck=False)
    except MemoryError:
        array.resize((rows, *array.shape[1:]), refcheck=False)
