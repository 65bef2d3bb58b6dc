"""Open-loop rotor commands from files and arrays."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Callable, List, Union

import numpy as np

from .._core import InputError, fault_of_commands
from ..formats import find_format

CommandsLike = Union[str, "os.PathLike[str]", np.ndarray]


def check_commands(commands: CommandsLike, rotor_count: int) -> np.ndarray:
    """Check a table of commands, or read it from a file.

    Parameters
    ----------
    commands : ndarray (rows, 1 + n) or path
        Strictly increasing times (s) and signed rotor speeds before the division by sim_slow
        (rad/s), or a file for `read_commands`.
    rotor_count : int
        Number of rotors, n.

    Returns
    -------
    ndarray, shape (rows, 1 + n)
        Table as a C-contiguous float64 array.

    Raises
    ------
    InputError
        If the shape is wrong, a number is not finite, or the times do not increase.
    """
    if isinstance(commands, (str, os.PathLike)):
        return read_commands(commands, rotor_count)
    try:
        given = np.asarray(commands)
    except (TypeError, ValueError) as error:
        raise InputError(f"commands: not a table of numbers: {error}") from error
    if given.dtype.kind not in "iuf" or isinstance(commands, np.ma.MaskedArray):
        kind = "masked" if isinstance(commands, np.ma.MaskedArray) else given.dtype
        raise InputError(f"commands: not a table of real numbers: {kind}. Give floats.")
    table = np.ascontiguousarray(given, dtype=float)
    if table.ndim != 2 or table.shape[1] != 1 + rotor_count:
        raise InputError(
            f"commands: an array of shape {table.shape}, but the model has {rotor_count} "
            f"rotors. Give (rows, {1 + rotor_count}): {','.join(_list_columns(rotor_count))}."
        )
    counted = " (rows count from 0, as numpy's do)"
    _check(table, lambda row: f"commands: row {row}", "commands", counted)
    return table


def read_commands(path: Union[str, os.PathLike[str]], rotor_count: int) -> np.ndarray:
    """Read a table of commands from a file.

    Parameters
    ----------
    path : str or path
        ``.csv`` file with the header ``t,w1,...,wn``, ``.mat`` file with vectors of these names, or
        bag. The times (s) must be strictly increasing, and the rotor speeds (rad/s) are signed.
    rotor_count : int
        Number of rotors, n.

    Returns
    -------
    ndarray, shape (rows, 1 + n)

    Raises
    ------
    InputError
        If the file is missing, its columns are wrong, a number is not finite, or the times do not
        increase. The message begins with ``FILE:LINE`` if a line causes the error.
    """
    path = Path(path)
    file = find_format(path, "commands are read from")
    table, place, counted = file.read_commands(path, _list_columns(rotor_count))
    _check(table, place, str(path), counted)
    return table


def _check(table: np.ndarray, place: Callable[[int], str], whole: str, counted: str) -> None:
    if len(table) == 0:
        raise InputError(f"{whole}: holds no commands")
    fault = fault_of_commands(table)
    if fault is not None:
        row, what = fault
        raise InputError(f"{place(row)}: {what}{counted}")


def _list_columns(rotor_count: int) -> List[str]:
    return ["t", *(f"w{i}" for i in range(1, 1 + rotor_count))]
