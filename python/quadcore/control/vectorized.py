"""Controllers that command several vehicles at once."""

from __future__ import annotations

from typing import Any, NamedTuple, Sequence

import numpy as np

from .._core import FlightError, InputError
from ..support.arguments import shorten
from .reference_ahead import ReferenceSamples


class VectorState(NamedTuple):
    """Measured states of n vehicles; the members are those of `Odometry`."""

    position: np.ndarray
    """Positions in world axes, m; shape (n, 3)."""
    orientation: np.ndarray
    """Orientations of the frames in the world, unit quaternions x, y, z, w; shape (n, 4)."""
    linear_velocity: np.ndarray
    """Velocities in world axes, m/s; shape (n, 3)."""
    angular_velocity: np.ndarray
    """Angular velocities in frame axes, rad/s; shape (n, 3)."""

    @classmethod
    def of_rows(cls, rows: np.ndarray) -> VectorState:
        """Split rows of position, orientation and velocities, shape (n, 13)."""
        return cls(rows[:, :3], rows[:, 3:7], rows[:, 7:10], rows[:, 10:13])

    @classmethod
    def of_one(cls, state: Any) -> VectorState:
        """Convert the state of one vehicle."""
        return cls(*(np.array(getattr(state, name), dtype=float)[None] for name in cls._fields))


def is_vectorized(controller: Any) -> bool:
    """Whether a controller commands several vehicles at once, by its attribute `vectorized`.

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
    """Return the commands of n vehicles; raise `InputError` if their shape is not (n, width)."""
    commands = np.asarray(answer, dtype=float)
    if commands.shape != (n, width):
        raise InputError(
            f"the vectorized controller returned the shape {commands.shape}. Return "
            f"{(n, width)}, a row for each vehicle."
        )
    return commands


def _make_failure(t: float, commands: np.ndarray) -> FlightError:
    """Describe the first command that is not finite, as the core does for one vehicle."""
    vehicle, rotor = np.argwhere(~np.isfinite(commands))[0]
    failure = FlightError(
        f"the flight failed at t = {t:f} s: the controller returned {shorten(commands[vehicle])} "
        f"for vehicle {vehicle}: the command for rotor {rotor + 1} is not a finite number. "
        f"Return {commands.shape[1]} rotor speeds in rad/s."
    )
    failure.time = t
    return failure


class CommandAll:
    """Function that calls a vectorized controller for n vehicles with the same reference.

    Parameters
    ----------
    controller
        Controller.
    reference : callable, optional
        Reference as a function of time.
    n : int
        Number of vehicles.
    limits : ndarray (rotors,)
        Speeds at which the rotors count as saturated, rad/s.

    Attributes
    ----------
    calls : int
        Number of calls.
    saturated : ndarray (n,) of int
        Number of commands of each vehicle in which at least one rotor is saturated.
    """

    def __init__(self, controller: Any, reference: Any, n: int, limits: np.ndarray) -> None:
        self._controller, self._reference, self._limits = controller, reference, limits
        self._n = n
        self.calls = 0
        self.saturated = np.zeros(n, dtype=int)

    def __call__(self, t: float, rows: np.ndarray) -> np.ndarray:
        """Return the commands (n, rotors) for measured states (n, 13) at time `t` (s)."""
        wanted = None
        if self._reference is not None:
            wanted = ReferenceSamples.repeat(self._reference(t), self._n)
        answer = self._controller(t, VectorState.of_rows(rows), wanted)
        try:
            commands = check_commands(answer, self._n, len(self._limits))
        except InputError as error:
            error.time = t  # type: ignore[attr-defined]
            raise
        if not np.isfinite(commands).all():
            raise _make_failure(t, commands)
        self.calls += 1
        self.saturated += (np.abs(commands) >= self._limits).any(axis=1)
        return commands


def command_one(controller: Any, t: float, state: Any, wanted: Any, width: int) -> Sequence[float]:
    """Call a vectorized controller for a single vehicle, and return its command."""
    reference = None if wanted is None else ReferenceSamples.repeat(wanted, 1)
    row: Sequence[float] = check_commands(
        controller(t, VectorState.of_one(state), reference), 1, width
    )[0]
    return row
