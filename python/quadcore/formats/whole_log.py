"""Recorder for formats that require all rows at once."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Mapping, Sequence

import numpy as np

from ..support.output_files import make_write_error
from .rows import append_wrenches

Write = Callable[[Path, Sequence[str], np.ndarray, Mapping[str, np.ndarray], Sequence[str]], None]


class DeferredLogFile:
    """Recorder that writes the log at the end of the flight.

    Until then, the rows are in an unnamed file in the folder of the log.

    Parameters
    ----------
    write
        Function write(path, columns, table, wrenches, ignored) that writes the log.
    path, columns, terms, ignored
        As for `Format.log_file`.
    """

    def __init__(
        self,
        write: Write,
        path: Path,
        columns: Sequence[str],
        terms: Sequence[str],
        ignored: Sequence[str],
    ) -> None:
        import tempfile  # slow to import

        self.path = path
        self.wrenches = bool(terms)
        self._write = write
        self._columns, self._terms, self._ignored = columns, terms, ignored
        self._count = 0
        try:
            self._rows = tempfile.TemporaryFile(dir=str(path.parent))  # noqa: SIM115
        except OSError as error:
            raise make_write_error(path, error) from error

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Append a piece of rows."""
        rows = append_wrenches(table, wrenches if self.wrenches else None)
        try:
            self._rows.write(rows.tobytes())
            self._rows.flush()
        except OSError as error:
            raise make_write_error(self.path, error) from error
        self._count += len(table)

    def close(self) -> None:
        """Write the file."""
        n = len(self._columns)
        with self._rows as stream:
            if self._count == 0:
                return
            rows = np.memmap(
                stream, dtype=float, mode="r", shape=(self._count, n + 6 * len(self._terms))
            )
            wrenches = {
                name: rows[:, n + 6 * i : n + 6 * (i + 1)] for i, name in enumerate(self._terms)
            }
            self._write(self.path, self._columns, rows[:, :n], wrenches, self._ignored)
