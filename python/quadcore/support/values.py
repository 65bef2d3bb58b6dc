"""Checks of numbers, poses and seeds, and their text in a URDF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Sequence, Tuple, Union

import numpy as np

from .. import _core
from .arguments import shorten

if TYPE_CHECKING:
    import numpy.typing as npt

    FloatArray = npt.NDArray[np.float64]

Number = Union[float, str]
Value = Union[float, str, bool, Path, Sequence[str], Sequence[float], np.ndarray]

SPAWN = (0.0, 0.0, 10.0)
"""Default initial position in the world, m."""


def check_whole(seed: object, name: str = "seed", bits: int = 64) -> int:
    """Return a seed or another integer; raise `InputError` if it exceeds this number of bits."""
    is_whole = isinstance(seed, (int, np.integer)) and not isinstance(seed, bool)
    if not is_whole or not 0 <= seed < 2**bits:  # type: ignore[operator]
        raise _core.InputError(
            f"{name} is {shorten(seed)}. Give a whole number from 0 to 2^{bits} - 1."
        )
    return int(seed)  # type: ignore[call-overload,no-any-return]


def format_value(value: Value) -> str:
    """Format the value of a parameter as in a URDF."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, np.ndarray)):
        return " ".join(format_value(part) for part in value)
    text = str(value)
    try:
        text.encode()
    except UnicodeEncodeError:
        raise _core.InputError(f"{shorten(value)} is not text in UTF-8. Give another.") from None
    return text


def check_pose(spawn: Sequence[Number]) -> Tuple[float, ...]:
    """Return an initial pose as x, y, z, roll, pitch, yaw; raise `InputError` if it is invalid."""
    try:
        given = [_to_number(value) for value in spawn]
    except (TypeError, ValueError):
        given = []
    if len(given) not in (3, 6):
        raise _core.InputError(
            f"spawn is {shorten(spawn)}. Give x, y, z[, roll, pitch, yaw] in m and rad."
        )
    return (*given, *[0.0] * (6 - len(given)))


def _to_number(value: Number) -> float:
    if not isinstance(value, str):
        return float(value)
    number = _core.parse_number(value)
    if number is None:
        raise ValueError(value)
    return number


def check_poses(spawn: npt.ArrayLike, n: int) -> np.ndarray:
    """Return the initial poses (n, 6) of n vehicles from one pose or n poses."""
    try:
        given = np.atleast_2d(np.asarray(spawn, dtype=float))
    except (TypeError, ValueError):
        given = np.empty((0, 0))
    if given.shape not in {(rows, width) for rows in (1, n) for width in (3, 6)}:
        raise _core.InputError(
            f"spawn does not contain poses of {n} vehicles. Give x, y, z[, roll, pitch, yaw] in m "
            "and rad, for each or once for all."
        )
    padded = np.zeros((n, 6))
    padded[:, : given.shape[1]] = given
    return padded


def check_seeds(seed: Union[int, npt.ArrayLike], n: int) -> np.ndarray:
    """Return the seeds of n vehicles; a single seed is counted up."""
    if isinstance(seed, (int, np.integer)):
        first = check_whole(seed)
        return np.array([(first + i) % 2**64 for i in range(n)], np.uint64)
    try:
        given = np.asarray(seed)
    except ValueError:  # rows of different lengths
        given = np.empty((0, 0))
    if given.shape != (n,):
        raise _core.InputError(
            f"seed does not contain {n} whole numbers. Give one per vehicle, or one."
        )
    if given.dtype == np.uint64:
        return given
    return np.array([check_whole(number) for number in given], np.uint64)
