"""What a flight leaves behind."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Mapping, Sequence, Union

import numpy as np

from ._core import InputError, csv_rows, log_columns, log_remark
from .files import atomic_write, check_writable
from .forks import LOCK

PathLike = Union[str, "os.PathLike[str]"]

_STATE_SIZE = len(log_columns(0))
_PIECE = 4096  # rows


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
        with atomic_write(_named(path, ".csv")) as stream:
            stream.write(csv_head(self.columns, self.ignored))
            for begin in range(0, len(self), _PIECE):
                stream.write(csv_rows(self.table[begin : begin + _PIECE]))

    def to_mat(self, path: PathLike) -> None:
        """Write a MATLAB file of each column as a vector and each wrench as ``wrench_NAME``.

        What was `ignored`, if anything, is the cell array ``ignored``.
        """
        with LOCK:
            import scipy.io

        file = _named(path, ".mat")
        variables = {name: self.table[:, i] for i, name in enumerate(self.columns)}
        variables.update((f"wrench_{name}", value) for name, value in self.wrenches.items())
        if self.ignored:
            variables["ignored"] = np.array(self.ignored, dtype=object)
        with atomic_write(file) as stream:
            scipy.io.savemat(stream, variables, oned_as="column")

    def to_file(self, path: PathLike) -> None:
        """Write a ``.csv`` or ``.mat`` file, as its name says.

        Raises
        ------
        InputError
            Another suffix, or a file that cannot be written; nothing is left behind then.
        """
        {".csv": self.to_csv, ".mat": self.to_mat}[log_suffix(Path(path))](path)

    def plot(self, directory: PathLike) -> list[Path]:
        """Draw the flight into PNG files in `directory` (made if missing); returns their paths."""
        with LOCK:
            from .plots import draw  # matplotlib is slow to import

        return draw(self, Path(directory))


def check_log_path(path: PathLike) -> None:
    """Raise `InputError` now if `Log.to_file` could not write `path` later."""
    log_suffix(Path(path))
    check_writable(Path(path))


def csv_head(columns: Sequence[str], ignored: Sequence[str]) -> bytes:
    """First line of a CSV log, and what was ignored."""
    return (",".join(columns) + log_remark(ignored) + "\n").encode()


def log_suffix(path: Path) -> str:
    """Kind of log that a file's name asks for; raises `InputError` if there is none such."""
    suffix = path.suffix.lower()
    if suffix not in (".csv", ".mat"):
        raise InputError(f"{path}: logs are written to .csv and .mat files")
    return suffix


def _named(path: PathLike, suffix: str) -> Path:
    path = Path(path)
    if path.suffix.lower() != suffix:
        raise InputError(f"{path}: name a file that ends in {suffix}, which it would hold")
    return path
