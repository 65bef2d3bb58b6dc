"""Open-loop rotor speed commands from a CSV or MATLAB file, or an array."""

from __future__ import annotations

import array
import math
import os
from pathlib import Path
from typing import Union

import numpy as np

from ._core import InputError, QuadcoreError
from .files import check_regular, read_text
from .forks import LOCK

CommandsLike = Union[str, "os.PathLike[str]", np.ndarray]

# More than three hours at 1 kHz.
_LARGEST = 10**9  # bytes
_MOST_VALUES = 10**7


def as_commands(commands: CommandsLike, rotor_count: int) -> np.ndarray:
    """Check a table of commands, or read it from a file.

    Parameters
    ----------
    commands
        Path of a file for `read_commands`, or an array of shape (rows, 1 + n): time in s, strictly
        increasing, and the signed speed of each rotor in rad/s (before the division by sim_slow).
    rotor_count
        n, the number of rotors.

    Returns
    -------
    ndarray, shape (rows, 1 + n)
        C-contiguous float64.

    Raises
    ------
    InputError
        A wrong shape, a value that is no finite number, or times that do not increase.
    """
    if isinstance(commands, (str, os.PathLike)):
        return read_commands(commands, rotor_count)
    try:
        given = np.asarray(commands)
    except (TypeError, ValueError) as error:
        raise InputError(f"commands: not a table of numbers: {error}") from error
    if given.dtype.kind not in "iuf" or isinstance(commands, np.ma.MaskedArray):
        kind = "masked" if isinstance(commands, np.ma.MaskedArray) else given.dtype
        raise InputError(f"commands: not a table of real numbers: {kind}; give floats, all of them")
    table = np.ascontiguousarray(given, dtype=float)
    if table.ndim != 2 or table.shape[1] != 1 + rotor_count:
        raise InputError(
            f"commands: an array of shape {table.shape}; this model with {rotor_count} rotors "
            f"takes (rows, {1 + rotor_count}): {_header(rotor_count)}"
        )
    places = [f"commands: row {row}" for row in range(len(table))]
    _check(table, places, "commands", " (rows count from 0, as numpy's do)")
    return table


def read_commands(path: Union[str, os.PathLike[str]], rotor_count: int) -> np.ndarray:
    """Read a table of commands.

    Parameters
    ----------
    path
        A ``.csv`` file with the header ``t,w1,...,wn``, or a ``.mat`` file with vectors of these
        names. Times in s, strictly increasing; signed rotor speeds in rad/s.
    rotor_count
        n, the number of rotors.

    Returns
    -------
    ndarray, shape (rows, 1 + n)

    Raises
    ------
    InputError
        A missing file, other columns, a value that is no finite number, or times that do not
        increase; the message begins with ``FILE:LINE:`` where a line is at fault.
    """
    path = Path(path)
    if path.suffix.lower() == ".csv":
        return _read_csv(path, rotor_count)
    if path.suffix.lower() == ".mat":
        return _read_mat(path, rotor_count)
    raise InputError(f"{path}: commands are read from .csv and .mat files")


def _read_csv(path: Path, rotor_count: int) -> np.ndarray:
    header, *lines = read_text(path, _LARGEST).rstrip().splitlines() or [""]
    if header.replace(" ", "") != _header(rotor_count):
        raise InputError(
            f"{path}:1: the header is '{header[:80]}'; this model with {rotor_count} rotors "
            f"takes '{_header(rotor_count)}'"
        )
    values = array.array("d")
    for number, line in enumerate(lines, start=2):
        cells = line.split(",")
        if len(cells) != 1 + rotor_count:
            raise InputError(f"{path}:{number}: {len(cells)} columns instead of {1 + rotor_count}")
        try:
            if "_" in line or not line.isascii():  # 1_000 and other scripts' digits, to Python
                raise ValueError(f"'{line[:80]}' holds what is no number; write digits 0 to 9")
            values.extend([float(cell) for cell in cells])
        except ValueError as error:
            raise InputError(f"{path}:{number}: {error}") from error
    table = np.array(values).reshape(-1, 1 + rotor_count)
    _check(table, [f"{path}:{number}" for number in range(2, 2 + len(table))], str(path))
    return table


def _read_mat(path: Path, rotor_count: int) -> np.ndarray:
    with LOCK:
        import scipy.io

    names = _header(rotor_count).split(",")
    try:
        check_regular(path)
        with path.open("rb") as stream:
            # Sizes first: a few compressed bytes can stand for more than there is memory.
            held = {name: math.prod(shape) for name, shape, _ in scipy.io.whosmat(stream)}
            missing = [name for name in names if name not in held]
            large = [name for name in names if held.get(name, 0) > _MOST_VALUES]
            if not missing and not large:
                stream.seek(0)
                variables = scipy.io.loadmat(stream, variable_names=names)
    except QuadcoreError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except NotImplementedError as error:
        raise InputError(f"{path}: a MATLAB 7.3 file; save it with the option -v7") from error
    except Exception as error:  # scipy has no common base class for what a broken file raises
        raise InputError(f"{path}: not a MATLAB file: {error}") from error
    if missing or f"w{rotor_count + 1}" in held:
        found = ", ".join(sorted(held))
        raise InputError(
            f"{path}: holds {found or 'no variables'}; this model with {rotor_count} rotors "
            f"takes {', '.join(names)}"
        )
    if large:
        raise InputError(
            f"{path}: {large[0]} has {held[large[0]]} values; at most {_MOST_VALUES} are read"
        )
    columns = [_vector(path, name, variables[name]) for name in names]
    for name, column in zip(names, columns):
        if len(column) != len(columns[0]):
            raise InputError(f"{path}: {name} has {len(column)} values, t has {len(columns[0])}")
    table = np.column_stack(columns)
    places = [f"{path}: row {row}" for row in range(1, 1 + len(table))]
    _check(table, places, str(path), " (rows count from 1, as MATLAB's do)")
    return table


def _vector(path: Path, name: str, value: np.ndarray) -> np.ndarray:
    if value.dtype.kind not in "iuf" or value.size != max(value.shape, default=0):
        raise InputError(f"{path}: {name} is no vector of real numbers")
    return value.ravel().astype(float)


def _check(table: np.ndarray, places: list[str], whole: str, counted: str = "") -> None:
    if len(table) == 0:
        raise InputError(f"{whole}: holds no commands")
    columns = _header(table.shape[1] - 1).split(",")
    bad = np.argwhere(~np.isfinite(table))
    if len(bad):
        row, column = bad[0]
        raise InputError(
            f"{places[row]}: {columns[column]} is {table[row, column]}; write a finite number"
            f"{counted}"
        )
    late = np.flatnonzero(np.diff(table[:, 0]) <= 0)
    if len(late):
        row = late[0] + 1
        raise InputError(
            f"{places[row]}: t = {table[row, 0]:.9g} does not come after {table[row - 1, 0]:.9g}"
            f"{counted}"
        )


def _header(rotor_count: int) -> str:
    return ",".join(["t"] + [f"w{i}" for i in range(1, 1 + rotor_count)])
