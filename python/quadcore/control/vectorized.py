"""Controllers that command several vehicles at once."""

from __future__ import annotations

from typing import Any, NamedTuple, Sequence

import numpy as np

from .._core import InputError
from ..support.arguments import shorten
from .reference_ahead import ReferenceSamples


class VectorState(NamedTuple):
    """Measured states of n vehicles; the members are those of `Odometry`."""

    position: np.ndarray
    """World axes, m; (n, 3)."""
    orientation: np.ndarray
    """Frame in the world, unit quaternions x, y, z, w; (n, 4)."""
    linear_velocity: np.ndarray
    """World axes, m/s; (n, 3)."""
    angular_velocity: np.ndarray
    """Frame axes, rad/s; (n, 3)."""

    @classmethod
    def of_rows(cls, rows: np.ndarray) -> VectorState:
        """Split rows of position, orientation and velocities, shape (n, 13)."""
        return cls(rows[:, :3], rows[:, 3:7], rows[:, 7:10], rows[:, 10:13])

    @classmethod
    def of_one(cls, state: Any) -> VectorState:
        """Return the state of one vehicle."""
        return cls(*(np.array(getattr(state, name), dtype=float)[None] for name in cls._fields))


def is_vectorized(controller: Any) -> bool:
    """Whether a controller commands several vehicles at once: its attribute `vectorized`.

    Raises
    ------
    InputError
        If the attribute is not a bool.
    """
    declared = getattr(controller, "vectorized", False)
    if not isinstance(declared, (bool, np.bool_)):
        raise InputError(f"controller: its vectorized is {shorten(declared)}. Give True or False.")
    return bool(declared)


def check_commands(answer: Any, n: int, width: int) -> np.ndarray:
    """Return the commands of n vehicles; raises `InputError` unless the shape is (n, width)."""
    commands = np.asarray(answer, dtype=float)
    if commands.shape != (n, width):
        raise InputError(
            f"the vectorized controller returned the shape {commands.shape}. Return "
            f"{(n, width)}, a row for each vehicle."
        )
    return commands


class CommandAll:
    """Call of a vectorized controller for n vehicles on one reference.

    Parameters
    ----------
    controller
        Controller.
    reference : callable, optional
        Function of time.
    n : int
        Number of vehicles.
    limits : ndarray (rotors,)
        Speeds at which a rotor counts as saturated, rad/s.

    Attributes
    ----------
    calls : int
        Number of calls.
    saturated : ndarray (n,) of int
        For each vehicle, number of commands in which a rotor is at its limit.
    """

    def __init__(self, controller: Any, reference: Any, n: int, limits: np.ndarray) -> None:
        self._controller, self._reference, self._limits = controller, reference, limits
        self._n = n
        self.calls = 0
        self.saturated = np.zeros(n, dtype=int)

    def __call__(self, t: float, rows: np.ndarray) -> np.ndarray:
        """Return the commands, shape (n, rotors), for measured states, shape (n, 13)."""
        wanted = None
        if self._reference is not None:
            wanted = ReferenceSamples.repeat(self._reference(t), self._n)
        answer = self._controller(t, VectorState.of_rows(rows), wanted)
        commands = check_commands(answer, self._n, len(self._limits))
        self.calls += 1
        self.saturated += (np.abs(commands) >= self._limits).any(axis=1)
        return commands


def command_one(controller: Any, t: float, state: Any, wanted: Any, width: int) -> Sequence[float]:
    """Return the command of a vectorized controller for one vehicle."""
    reference = None if wanted is None else ReferenceSamples.repeat(wanted, 1)
    row: Sequence[float] = check_commands(
        controller(t, VectorState.of_one(state), reference), 1, width
    )[0]
    return row
