"""Windows of real flights: measured states at the start and at later instants."""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence

import numpy as np

from ..._core import InputError
from .prepared import PreparedFlight, sample_state
from .smoothing import NODES

INSTANTS = (0.05, 0.1, 0.15, 0.25, 0.35, 0.5)
"""Times after the start of a window at which predictions are compared, s."""

HORIZONS = (0.05, 0.1, 0.25, 0.5)
"""Horizons in tables, s; a subset of `INSTANTS`."""

CHANNELS = {"position": "m", "attitude": "deg", "velocity": "m/s", "rates": "rad/s"}
"""Compared quantities with their units in tables."""

_EVERY = 0.25  # s; time between the starts of windows
_BEFORE = 0.5  # s; time with inputs before the first window
_FEWEST = 5


class Windows(NamedTuple):
    """Windows of several flights.

    Attributes
    ----------
    flights : list of PreparedFlight
        Flights.
    flight : ndarray (n,) of int
        Index of the flight of each window.
    start : ndarray (n,)
        Start time of each window, s.
    states : dict of str to ndarray (n, instants + 1, k)
        Measured states at the start and at each of `INSTANTS`.
    """

    flights: List[PreparedFlight]
    flight: np.ndarray
    start: np.ndarray
    states: Dict[str, np.ndarray]

    @property
    def channels(self) -> List[str]:
        """Names of the measured quantities."""
        return list(CHANNELS) if "position" in self.states else ["rates"]

    def choose(self, kept: np.ndarray) -> Windows:
        """Return a subset of the windows."""
        states = {name: values[kept] for name, values in self.states.items()}
        return Windows(self.flights, self.flight[kept], self.start[kept], states)

    def choose_flight(self, number: int) -> Windows:
        """Return the windows of one flight."""
        own = self.choose(self.flight == number)
        return own._replace(flights=[self.flights[number]], flight=np.zeros_like(own.flight))


def make_windows(flights: Sequence[PreparedFlight], nodes: int = NODES) -> Windows:
    """Make windows at regular times; windows that touch a gap are omitted.

    Parameters
    ----------
    flights
        Prepared flights.
    nodes
        Minimum number of samples on each side of the polynomials that give the measured states.

    Raises
    ------
    InputError
        If a flight has too few windows, or only some flights have a pose.
    """
    if len({flight.has_pose for flight in flights}) > 1:
        without = next(flight for flight in flights if not flight.has_pose)
        raise InputError(f"{without.where}: the pose is missing, but other logs have one.")
    numbers, starts, parts = [], [], []
    for number, flight in enumerate(flights):
        begin, end = flight.span
        start = np.arange(begin + _BEFORE, end - INSTANTS[-1], _EVERY)
        for gap_begin, gap_end in flight.gaps:
            start = start[(start + INSTANTS[-1] < gap_begin) | (start - 0.1 > gap_end)]
        if len(start) < _FEWEST:
            raise InputError(
                f"{flight.where}: only {len(start)} windows of {INSTANTS[-1]:g} s remain."
            )
        at = start[:, None] + np.array([0.0, *INSTANTS])
        sampled = sample_state(flight, at.ravel(), nodes)
        parts.append({name: v.reshape(*at.shape, -1) for name, v in sampled.items()})
        numbers.append(np.full(len(start), number))
        starts.append(start)
    states = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return Windows(list(flights), np.concatenate(numbers), np.concatenate(starts), states)


def compare_states(
    measured: Dict[str, np.ndarray], predicted: Dict[str, np.ndarray]
) -> Dict[str, np.ndarray]:
    """Return predicted minus measured states, with attitude errors as rotation vectors (body, rad).

    Arrays have the shape (..., k).
    """
    errors: Dict[str, np.ndarray] = {
        name: predicted[name] - measured[name]
        for name in ("position", "velocity", "rates")
        if name in measured
    }
    if "orientation" in measured:
        errors["attitude"] = _turn_between(measured["orientation"], predicted["orientation"])
    return errors


def predict_constant(windows: Windows) -> Dict[str, np.ndarray]:
    """Predict every instant with the velocity and rates of the start."""
    from scipy.spatial.transform import Rotation

    after = np.array(INSTANTS)[None, :, None]
    begin = {name: values[:, :1] for name, values in windows.states.items()}
    rates = np.repeat(begin["rates"], len(INSTANTS), axis=1)
    predicted = {"rates": rates}
    if "position" in begin:
        predicted["velocity"] = np.repeat(begin["velocity"], len(INSTANTS), axis=1)
        predicted["position"] = begin["position"] + after * predicted["velocity"]
        q = np.repeat(begin["orientation"], len(INSTANTS), axis=1)
        turned = Rotation.from_quat(q.reshape(-1, 4)) * Rotation.from_rotvec(
            (after * rates).reshape(-1, 3)
        )
        predicted["orientation"] = turned.as_quat().reshape(q.shape)
    return predicted


def compute_errors(windows: Windows, predicted: Dict[str, np.ndarray]) -> Dict[str, np.ndarray]:
    """Return the prediction errors by channel, shape (n, instants, 3)."""
    return compare_states({n: v[:, 1:] for n, v in windows.states.items()}, predicted)


def compute_rms(errors: Dict[str, np.ndarray]) -> Dict[str, np.ndarray]:
    """Return the RMS norm of the errors at each of `INSTANTS`, in the units of `CHANNELS`."""
    rms = {
        name: np.sqrt(np.mean(np.sum(error**2, axis=2), axis=0)) for name, error in errors.items()
    }
    if "attitude" in rms:
        rms["attitude"] = np.degrees(rms["attitude"])
    return {name: rms[name] for name in CHANNELS if name in rms}


def _turn_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_quat(a.reshape(-1, 4)).inv() * Rotation.from_quat(b.reshape(-1, 4))
    vectors: np.ndarray = turn.as_rotvec().reshape(*a.shape[:-1], 3)
    return vectors
