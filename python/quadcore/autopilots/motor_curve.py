"""Motor curve: rotor speed as a function of the autopilot's output."""

from __future__ import annotations

from typing import Optional, Sequence, Tuple, Union

import numpy as np

from .._core import InputError
from ..support.arguments import shorten

KINDS = ("speed", "thrust")
"""Names of the built-in curves."""

CurveLike = Union[str, Sequence[Tuple[float, float]]]


class MotorCurve:
    """Rotor speeds as a function of outputs from 0 to 1.

    Parameters
    ----------
    curve : {"speed", "thrust"} or sequence of pairs
        "speed": the speed is proportional to the output. "thrust": the thrust is proportional to
        the output, so the speed grows with its square root. Pairs of output and rotor speed
        (rad/s): linear interpolation.
    max_speeds : ndarray (n,)
        Speed of each rotor at full output, rad/s; not used for pairs.

    Raises
    ------
    InputError
        If the curve is invalid, or requires a maximum speed that the motors do not have.
    """

    def __init__(self, curve: CurveLike, max_speeds: np.ndarray) -> None:
        self._table = read_curve(curve)
        self._exponent = 0.5 if curve == "thrust" else 1.0
        self._max_speeds = np.asarray(max_speeds, dtype=float)
        if self._table is None and not np.all(np.isfinite(self._max_speeds)):
            raise InputError(
                f"motor_curve '{curve}' needs the maximum speed of the motors, which is unlimited. "
                "Give [[0, 0], [1, rad/s]]."
            )

    def find_speeds(self, outputs: np.ndarray) -> np.ndarray:
        """Return the speeds for the outputs of n motors, rad/s; shape (n,)."""
        if self._table is not None:
            return np.asarray(np.interp(outputs, *self._table))
        return np.asarray(self._max_speeds * _limit(outputs) ** self._exponent)

    def find_outputs(self, speeds: np.ndarray) -> np.ndarray:
        """Return the outputs at which n motors turn at these speeds (rad/s); shape (n,)."""
        if self._table is not None:
            return np.asarray(np.interp(speeds, self._table[1], self._table[0]))
        return np.asarray(_limit(speeds / self._max_speeds) ** (1 / self._exponent))


def _limit(outputs: np.ndarray) -> np.ndarray:
    return np.asarray(np.minimum(np.maximum(outputs, 0), 1))  # ten times faster than np.clip


def read_curve(curve: object) -> Optional[np.ndarray]:
    """Return the outputs and speeds of a curve, shape (2, rows); None for one of `KINDS`.

    Raises
    ------
    InputError
        If the curve is neither.
    """
    if isinstance(curve, str):
        if curve not in KINDS:
            raise InputError(
                f"motor_curve is {shorten(curve)}. Give speed, thrust, or [[output, rad/s], ...]."
            )
        return None
    try:
        table = np.array(curve, dtype=float).T
    except (TypeError, ValueError):
        table = np.empty(0)
    has_shape = table.ndim == 2 and table.shape[0] == 2 and table.shape[1] >= 2
    if not (has_shape and np.all(np.isfinite(table)) and np.all(np.diff(table) > 0)):
        raise InputError(
            f"motor_curve is {shorten(curve)}. Give two or more pairs [output, rad/s], both rising."
        )
    return table
