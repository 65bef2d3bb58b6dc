"""Search for parameters by the prediction errors over windows of flights."""

from __future__ import annotations

from typing import Any, Callable, Dict, Mapping, Optional, Tuple

import numpy as np

from .coordinates import Coordinates
from .inputs import DELAY, INPUT_BOUNDS
from .predictor import Predictor
from .windows import Windows, compute_errors, predict_constant

_STEP = 1e-4  # step of a coordinate for derivatives
_ROUNDS = 25
_PRIOR, _TORQUE_PRIOR = 3.0, 1e3
"""Standard deviations of weak priors: scaled coordinates, and torques (10 rad/s^2)."""
FAR = 30.0
"""Weighted error of a prediction that failed."""
_DELAY_SIZE = 0.01  # s; scale of the delay
Progress = Callable[[int, int], None]


class Search:
    """Weighted prediction errors as a function of coordinates and trims.

    Parameters
    ----------
    predictor
        Model and windows.
    coordinates
        Coordinates of the free parameters.
    fixed
        Values of the other parameters.
    weights
        Weight of each error (default: the inverse RMS error of constant velocity and rates).
    """

    def __init__(
        self,
        predictor: Predictor,
        coordinates: Coordinates,
        fixed: Mapping[str, float],
        weights: Optional[Mapping[str, np.ndarray]] = None,
    ) -> None:
        self.predictor, self.coordinates, self._fixed = predictor, coordinates, dict(fixed)
        windows = predictor.windows
        self._flights = len(windows.flights)
        self.trim_sizes = np.ones(len(predictor.trim))
        self.trim_sizes[0] = _DELAY_SIZE
        self.trim_sizes[2:] = 1e-2 * np.max(np.diag(predictor.fitted.simulation.inertia))
        if weights is None:
            constant = compute_errors(windows, predict_constant(windows))
            weights = {n: 1 / np.sqrt(np.mean(e**2, axis=(0, 2))) for n, e in constant.items()}
        self._weights = weights

    def replace_windows(self, windows: Windows) -> Search:
        """Return a search with different windows of the same flights."""
        predictor = Predictor(self.predictor.fitted, windows)
        return Search(predictor, self.coordinates, self._fixed, self._weights)

    @property
    def parameters(self) -> int:
        """Number of parameters that all flights share."""
        return len(self.coordinates.names)

    def split(self, x: np.ndarray) -> Any:
        """Split a point into the coordinates and the trims of the flights."""
        trims = x[self.parameters :].reshape(self._flights, -1) * self.trim_sizes
        return x[: self.parameters], trims

    def _name(self, shared: np.ndarray) -> Dict[str, float]:
        return {**self._fixed, **self.coordinates.name(shared)}

    def weigh(self, predicted: Dict[str, np.ndarray]) -> np.ndarray:
        """Return the weighted errors, shape (windows, errors)."""
        windows = self.predictor.windows
        errors = compute_errors(windows, predicted)
        parts = []
        for name in windows.channels:
            weighted = errors[name] * self._weights[name][None, :, None]
            parts.append(np.clip(np.nan_to_num(weighted, nan=FAR), -FAR, FAR))
        n = len(windows.start)
        left = np.concatenate([part.reshape(n, -1) for part in parts], axis=1)
        return np.asarray(left)

    def compute(self, x: np.ndarray) -> np.ndarray:
        """Return the weighted errors at a point, shape (windows, errors)."""
        shared, trims = self.split(x)
        [predicted] = self.predictor.predict([self._name(shared)], [trims])
        return self.weigh(predicted)

    def linearise(self, x: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Return the errors, and their derivative with shape (windows, errors, coordinates)."""
        shared, trims = self.split(x)
        values, sets = [self._name(shared)], [trims]
        for k in range(self.parameters):
            values.append(self._name(shared + _STEP * np.eye(self.parameters)[k]))
            sets.append(trims)
        of_trim = np.diag(self.trim_sizes * 10 * _STEP)
        for step in of_trim:
            values.append(values[0])
            sets.append(trims + step)
        flown = [self.weigh(each) for each in self.predictor.predict(values, sets)]
        change = np.stack(flown[1:], axis=2) - flown[0][:, :, None]
        slope = np.zeros((*flown[0].shape, len(x)))
        slope[:, :, : self.parameters] = change[:, :, : self.parameters] / _STEP
        flight, width = self.predictor.windows.flight, len(self.trim_sizes)
        for number in range(self._flights):
            own = flight == number
            begin = self.parameters + number * width
            slope[own, :, begin : begin + width] = change[own, :, self.parameters :] / (10 * _STEP)
        return flown[0], slope

    def find(
        self, x: np.ndarray, free: np.ndarray, progress: Optional[Progress] = None
    ) -> np.ndarray:
        """Minimise the errors over the free coordinates."""
        from scipy.optimize import least_squares

        done = 0
        prior = np.zeros(len(x))
        prior[: self.parameters] = self.coordinates.prior
        prior_rows = np.diag(prior)[prior > 0]

        def place(y: np.ndarray) -> np.ndarray:
            whole = x.copy()
            whole[free] = y
            return whole

        def slope(y: np.ndarray) -> np.ndarray:
            nonlocal done
            done += 1
            if progress is not None:
                progress(min(done, _ROUNDS), _ROUNDS)
            found = self.linearise(place(y))[1][:, :, free]
            return np.vstack([found.reshape(-1, found.shape[2]), prior_rows[:, free]])

        def left(y: np.ndarray) -> np.ndarray:
            there = place(y)
            return np.concatenate([self.compute(there).ravel(), prior_rows @ (there - x)])

        low, high = self.find_bounds(len(x))
        result: Any = least_squares(
            left,
            np.clip(x[free], low[free], high[free]),
            slope,
            bounds=(low[free], high[free]),
            loss="soft_l1",
            x_scale="jac",
            xtol=1e-4,
            ftol=1e-4,
            max_nfev=_ROUNDS,
        )
        return place(result.x)

    def find_prior(self, size: int) -> np.ndarray:
        """Return the standard deviation of the prior of each coordinate around its start value."""
        of_trim = [_PRIOR, _PRIOR, *[_TORQUE_PRIOR] * (len(self.trim_sizes) - 2)]
        prior = np.tile(of_trim, self._flights)
        shared = np.full(self.parameters, _PRIOR)
        is_body = self.coordinates.prior > 0
        shared[is_body] = 1 / self.coordinates.prior[is_body]
        return np.concatenate([shared, prior])

    def find_bounds(self, size: int) -> Any:
        """Return the lower and the upper bounds of the coordinates."""
        low, high = np.full(size, -np.inf), np.full(size, np.inf)
        low[: self.parameters] = self.coordinates.low
        high[: self.parameters] = self.coordinates.high
        delays = slice(self.parameters, size, len(self.trim_sizes))
        has_rotors = [flight.rotors is not None for flight in self.predictor.windows.flights]
        earliest, latest = INPUT_BOUNDS[DELAY]
        low[delays] = np.where(has_rotors, earliest, 0) / self.trim_sizes[0]
        high[delays] = latest / self.trim_sizes[0]
        return low, high
