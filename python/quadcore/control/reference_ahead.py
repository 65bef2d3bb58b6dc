"""Reference at other times, for controllers that look ahead."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, Callable, Dict, Iterator, List, Sequence, Tuple

import numpy as np

from .. import _core
from ..support.arguments import shorten

_LENGTHS = {"position": 3, "velocity": 3, "acceleration": 3, "jerk": 3, "snap": 3}
_LENGTHS.update(yaw=1, yaw_rate=1, yaw_acceleration=1)
"""Members of a reference and their sizes, in the order of a message."""


def list_fields(wanted: Any) -> Sequence[float]:
    """List the fields of a message of kind ``reference``."""
    vectors = (wanted.position, wanted.velocity, wanted.acceleration, wanted.jerk, wanted.snap)
    return [
        *(float(value) for vector in vectors for value in vector),
        float(wanted.yaw),
        float(wanted.yaw_rate),
        float(wanted.yaw_acceleration),
    ]


class ReferenceSamples(SimpleNamespace):
    """Reference at several times, or for several vehicles, as arrays of its members.

    Attributes
    ----------
    position, velocity, acceleration, jerk, snap : ndarray (..., 3)
        Position of the frame's origin in the world and its derivatives, m, s. For times, ``(...)``
        is their shape; for n vehicles, it is ``(n,)``.
    yaw, yaw_rate, yaw_acceleration : ndarray (...)
        Yaw and its derivatives, rad, s.
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    jerk: np.ndarray
    snap: np.ndarray
    yaw: np.ndarray
    yaw_rate: np.ndarray
    yaw_acceleration: np.ndarray

    @classmethod
    def repeat(cls, wanted: Any, n: int) -> ReferenceSamples:
        """Return the same reference for several vehicles, with all its members.

        Parameters
        ----------
        wanted : Reference
            Reference at one time, or an object with some of its members.
        n : int
            Number of vehicles.
        """
        found = {name: getattr(wanted, name) for name in _LENGTHS if hasattr(wanted, name)}
        arrays = {name: np.asarray(value, dtype=float) for name, value in found.items()}
        return cls(**{name: np.broadcast_to(x, (n, *x.shape)) for name, x in arrays.items()})


def sample_shape(shape: _core.ReferenceShape, times: Any) -> Any:
    """Return a built-in reference at one or several times (s), as `sample_function` does."""
    at = _check_times(times)
    if at.ndim == 0:
        return shape.at(float(at))
    rows = shape.sample(at.ravel())
    ends = np.cumsum(list(_LENGTHS.values()))
    return _make_samples(dict(zip(_LENGTHS, np.split(rows, ends[:-1], axis=1))), at.shape)


def sample_function(function: Callable[[float], Any], times: Any) -> Any:
    """Return a user-defined reference at one or several times.

    Parameters
    ----------
    function
        User-defined reference.
    times : float or array_like
        Simulation times, s.

    Returns
    -------
    Reference or ReferenceSamples
        For one time, the value of the function. For several times, arrays of the members that all
        values have.
    """
    at = _check_times(times)
    if at.ndim == 0:
        return function(float(at))
    points = [function(t) for t in at.ravel().tolist()]
    found = {
        name: np.array([getattr(point, name) for point in points], dtype=float).reshape(-1, length)
        for name, length in _LENGTHS.items()
        if all(hasattr(point, name) for point in points)
    }
    return _make_samples(found, at.shape)


class ReferenceWithFuture:
    """Value of a user-defined reference with an additional attribute ``at``."""

    def __init__(self, value: Any, at: Callable[[Any], Any]) -> None:
        self._value = value
        self.at = at

    def __getattr__(self, name: str) -> Any:
        if name == "_value" or name.startswith("__"):  # copy and pickle access it before it is set
            raise AttributeError(name)
        return getattr(self._value, name)

    def __getitem__(self, index: Any) -> Any:
        return self._value[index]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._value)

    def __len__(self) -> int:
        return len(self._value)

    def __repr__(self) -> str:
        return repr(self._value)


def add_future(reference: Callable[[float], Any]) -> Callable[[float], Any]:
    """Add the method ``at`` to the values of a reference.

    Parameters
    ----------
    reference
        Built-in reference or function. Its values get the attribute ``at`` unless they already have
        one.
    """
    at: Callable[[Any], Any] = getattr(reference, "at", None) or (
        lambda times: sample_function(reference, times)
    )

    shape = getattr(reference, "shape", None)
    if isinstance(shape, _core.ReferenceShape):
        give_point = shape.at

        def give_built_in(t: float) -> Any:
            value = give_point(t)
            value.at = at  # type: ignore[attr-defined]
            return value

        return give_built_in

    def give(t: float) -> Any:
        value = reference(t)
        if value is None or hasattr(value, "at"):
            return value
        try:
            value.at = at
        except AttributeError:  # the value is a tuple or frozen
            return ReferenceWithFuture(value, at)
        return value

    return give


def _check_times(times: Any) -> np.ndarray:
    try:
        at = np.asarray(times, dtype=float)
    except (TypeError, ValueError):
        at = np.array(np.nan)
    if not np.isfinite(at).all():
        raise _core.InputError(
            f"reference.at: the time is {shorten(times)}. Give seconds, one or several."
        )
    return at


def _make_samples(members: Dict[str, np.ndarray], shape: Tuple[int, ...]) -> ReferenceSamples:
    sizes: Dict[str, List[int]] = {
        name: [*shape, length] if length > 1 else [*shape] for name, length in _LENGTHS.items()
    }
    return ReferenceSamples(**{name: rows.reshape(sizes[name]) for name, rows in members.items()})
