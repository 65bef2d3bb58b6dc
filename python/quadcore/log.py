"""What a flight leaves behind."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Mapping, Sequence, Union

import numpy as np

from ._core import InputError, log_columns
from .files import check_writable
from .forks import LOCK
from .formats import format_of
from .formats.rows import LogFile

if TYPE_CHECKING:
    from .simulation import Simulation

PathLike = Union[str, "os.PathLike[str]"]

_STATE_SIZE = len(log_columns(0))
_WRITTEN = "logs are written to"


class Log:
    """States of a flight, one row per logged step, and the wrenches that act from each on.

    Parameters
    ----------
    table : ndarray, shape (rows, 14 + n)
        Columns as `columns` names them.
    wrenches : mapping of str to ndarray, shape (rows, 6)
        Force (N), then torque (N m), frame axes, about the vehicle's centre of mass.
    title : str
        What flew, for the plots.
    ignored : sequence of str
        What was left out of model and world at the user's wish.
    """

    def __init__(
        self,
        table: np.ndarray,
        wrenches: Mapping[str, np.ndarray],
        title: str = "",
        ignored: Sequence[str] = (),
    ) -> None:
        self.table = table
        self.wrenches = dict(wrenches)
        self.title = title
        self.ignored = list(ignored)

    def __len__(self) -> int:
        return len(self.table)

    @property
    def columns(self) -> list[str]:
        """Names of the table's columns, as they head the CSV file."""
        return log_columns(self.table.shape[1] - _STATE_SIZE)

    @property
    def time(self) -> np.ndarray:
        """Time since the start, s; shape (rows,)."""
        return self.table[:, 0]

    @property
    def position(self) -> np.ndarray:
        """Origin of the frame link in the world, m; shape (rows, 3)."""
        return self.table[:, 1:4]

    @property
    def orientation(self) -> np.ndarray:
        """Orientation of the frame link in the world, unit quaternion x, y, z, w; (rows, 4)."""
        return self.table[:, 4:8]

    @property
    def linear_velocity(self) -> np.ndarray:
        """Velocity of the frame link's origin, world axes, m/s; shape (rows, 3)."""
        return self.table[:, 8:11]

    @property
    def angular_velocity(self) -> np.ndarray:
        """Angular velocity of the frame link, body axes, rad/s; shape (rows, 3)."""
        return self.table[:, 11:14]

    @property
    def rotor_velocity(self) -> np.ndarray:
        """Velocity of the rotor joints, rad/s; shape (rows, n)."""
        return self.table[:, _STATE_SIZE:]

    def to_csv(self, path: PathLike) -> None:
        """Write `table` as text with 17 significant digits, so that reading restores every bit.

        What was `ignored`, if anything, stands in a comment below the names of the columns.
        """
        self._write(path, ".csv")

    def to_mat(self, path: PathLike) -> None:
        """Write a MATLAB file of each column as a vector and each wrench as ``wrench_NAME``.

        What was `ignored`, if anything, is the cell array ``ignored``.
        """
        self._write(path, ".mat")

    def to_file(self, path: PathLike) -> None:
        """Write a ``.csv`` or ``.mat`` file, as its name says.

        Raises
        ------
        InputError
            Another suffix, or a file that cannot be written; nothing is left behind then.
        """
        file = Path(path)
        format_of(file, _WRITTEN).write_log(
            file, self.columns, self.table, self.wrenches, self.ignored
        )

    def plot(self, directory: PathLike) -> list[Path]:
        """Draw the flight into PNG files in `directory` (made if missing); returns their paths."""
        with LOCK:
            from .plots import draw  # matplotlib is slow to import

        return draw(self, Path(directory))

    def _write(self, path: PathLike, suffix: str) -> None:
        if Path(path).suffix.lower() != suffix:
            raise InputError(f"{path}: name a file that ends in {suffix}, which it would hold")
        self.to_file(path)


def check_log_path(path: PathLike) -> None:
    """Raise `InputError` now if `Log.to_file` could not write `path` later."""
    format_of(Path(path), _WRITTEN)
    check_writable(Path(path))


def log_file(path: Path, simulation: Simulation) -> LogFile:
    """Make the recorder that a file's name asks for."""
    return format_of(path, _WRITTEN).log_file(
        path,
        log_columns(simulation.rotor_count),
        simulation.wrench_terms,
        simulation.ignored,
    )
