"""State of a vehicle, as a copy and as live views."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping

import numpy as np

if TYPE_CHECKING:
    from .. import _core
    from ..support.values import FloatArray

_VECTORS = (
    "position",
    "orientation",
    "linear_velocity",
    "angular_velocity",
    "rotor_velocity",
    "rotor_angle",
)


class State:
    """State of a vehicle; all attributes can be assigned.

    Attributes
    ----------
    time : float
        Simulation time, s.
    position : ndarray (3,)
        Position of the frame origin in the world, m.
    orientation : ndarray (4,)
        Orientation of the frame in the world, unit quaternion x, y, z, w.
    linear_velocity : ndarray (3,)
        Velocity of the frame origin, world axes, m/s.
    angular_velocity : ndarray (3,)
        Angular velocity of the frame, body axes, rad/s.
    rotor_velocity : ndarray (n,)
        Joint velocities in the engine, after the division by sim_slow, rad/s.
    rotor_angle : ndarray (n,)
        Joint angles in (-pi, pi], rad.
    """

    __slots__ = ("time", *_VECTORS)

    time: float
    position: FloatArray
    orientation: FloatArray
    linear_velocity: FloatArray
    angular_velocity: FloatArray
    rotor_velocity: FloatArray
    rotor_angle: FloatArray

    def copy(self) -> State:
        """Return an independent copy."""
        other = State()
        other.time = self.time
        for name in _VECTORS:
            setattr(other, name, np.array(getattr(self, name), dtype=float))
        return other

    def __repr__(self) -> str:
        members: List[str] = [f"time={self.time!r}"]
        members += [f"{name}={getattr(self, name)!r}" for name in _VECTORS]
        return f"{type(self).__name__}({', '.join(members)})"


class LiveState:
    """Current state of a simulation: read-only views that change at each step.

    The attributes are those of `State`. `copy()`, `copy.copy` and `pickle` make an independent
    `State` at one instant. During `run`, the views change when a Python controller is called, when
    a row is logged, and at the end. If another thread steps the simulation, a view may mix two
    instants; `copy()` raises an error in this case.
    """

    __slots__ = ("_clock", "_copy", *_VECTORS)

    _clock: FloatArray
    _copy: Callable[[], Dict[str, Any]]
    position: FloatArray
    orientation: FloatArray
    linear_velocity: FloatArray
    angular_velocity: FloatArray
    rotor_velocity: FloatArray
    rotor_angle: FloatArray

    def __init__(self, simulation: _core.Simulation) -> None:
        views = simulation._views()
        object.__setattr__(self, "_clock", views["time"])
        object.__setattr__(self, "_copy", views["copy"])
        for name in _VECTORS:
            object.__setattr__(self, name, views[name])

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(
            f"state.{name} is read-only. Change a state.copy() and give it to set_state()."
        )

    @property
    def time(self) -> float:
        """Simulation time, s."""
        return float(self._clock[0])

    def copy(self) -> State:
        """Return an independent copy.

        Raises
        ------
        InputError
            If another thread is stepping the simulation.
        """
        return make_state(self._copy())

    def __reduce__(self) -> Any:
        return make_state, (self._copy(),)

    __repr__ = State.__repr__


def make_state(members: Mapping[str, Any]) -> State:
    """Make a state from a mapping of its attributes."""
    state = State()
    for name, value in members.items():
        setattr(state, name, value)
    return state
