"""Fit of a model to recordings of real flights by the errors of its predictions."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence

import numpy as np

from ..._core import FlightError
from ...model.overrides import list_link_values
from .coordinates import Coordinates
from .fitted_model import FittedModel
from .inputs import INPUT_BOUNDS, INPUTS, guess_speed, smooth_rotors
from .predictor import Predictor
from .prepared import PreparedFlight
from .problem import Parameter
from .windows import Windows, compute_errors, make_windows, predict_constant

_STEP = 1e-4  # of a coordinate, for derivatives
_ROUNDS = 25
_PRODUCTS = (".ixy", ".ixz", ".iyz")
_FAR = 30.0
"""Weighted error of a prediction that failed."""
_DELAYS = (0.0, 0.12)  # s
_DELAY_SIZE = 0.01  # s
Progress = Callable[[int, int], None]


class FlightFit(NamedTuple):
    """Result of a fit to real flights.

    Attributes
    ----------
    values, start, deviations : dict of str to float
        Fitted value, start value and standard deviation of each parameter; the deviation is NaN if
        the flights do not identify the parameter.
    units : dict of str to str
        Units.
    trims : ndarray (flights, trims)
        Delay (s) and constant torque (N m) of each flight.
    windows : Windows
        Windows of the fitted flights.
    """

    values: Dict[str, float]
    start: Dict[str, float]
    deviations: Dict[str, float]
    units: Dict[str, str]
    trims: np.ndarray
    windows: Windows


class Search:
    """Weighted errors of predictions over coordinates and trims.

    Parameters
    ----------
    predictor
        Model and windows.
    coordinates
        Free parameters.
    fixed
        Values of other parameters.
    """

    def __init__(
        self, predictor: Predictor, coordinates: Coordinates, fixed: Mapping[str, float]
    ) -> None:
        self.predictor, self.coordinates, self._fixed = predictor, coordinates, dict(fixed)
        windows = predictor.windows
        self._flights = len(windows.flights)
        self.trim_sizes = np.ones(len(predictor.trim))
        self.trim_sizes[0] = _DELAY_SIZE
        self.trim_sizes[2:] = 1e-2 * np.max(np.diag(predictor.fitted.simulation.inertia))
        constant = compute_errors(windows, predict_constant(windows))
        self._weights = {n: 1 / np.sqrt(np.mean(e**2, axis=(0, 2))) for n, e in constant.items()}

    @property
    def parameters(self) -> int:
        """Number of shared parameters."""
        return len(self.coordinates.names)

    def split(self, x: np.ndarray) -> Any:
        """Return the coordinates and the trims of a point."""
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
            parts.append(np.clip(np.nan_to_num(weighted, nan=_FAR), -_FAR, _FAR))
        n = len(windows.start)
        left = np.concatenate([part.reshape(n, -1) for part in parts], axis=1)
        return np.asarray(left)

    def compute(self, x: np.ndarray) -> np.ndarray:
        """Return the weighted errors at a point, shape (windows, errors)."""
        shared, trims = self.split(x)
        [predicted] = self.predictor.predict([self._name(shared)], [trims])
        return self.weigh(predicted)

    def differentiate(self, x: np.ndarray) -> np.ndarray:
        """Return the derivative, shape (windows, errors, coordinates)."""
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
        return slope

    def find(
        self, x: np.ndarray, free: np.ndarray, progress: Optional[Progress] = None
    ) -> np.ndarray:
        """Minimise the errors over some of the coordinates."""
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
            found = self.differentiate(place(y))[:, :, free]
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

    def find_bounds(self, size: int) -> Any:
        """Return lower and upper bounds of the coordinates."""
        low, high = np.full(size, -np.inf), np.full(size, np.inf)
        low[: self.parameters] = self.coordinates.low
        high[: self.parameters] = self.coordinates.high
        delays = slice(self.parameters, size, len(self.trim_sizes))
        low[delays], high[delays] = (np.array(_DELAYS) / self.trim_sizes[0]).tolist()
        return low, high


def fit_flights(
    fitted: FittedModel,
    parameters: Sequence[Parameter],
    free_inputs: Sequence[str],
    flights: Sequence[PreparedFlight],
    progress: Optional[Progress] = None,
) -> FlightFit:
    """Fit parameters to flights.

    Parameters
    ----------
    fitted
        Model.
    parameters
        Free parameters of the model.
    free_inputs
        Free parameters of `INPUTS`.
    flights
        Prepared flights.

    Raises
    ------
    FlightError
        If every prediction of the start values fails.
    """
    windows = make_windows([smooth_rotors(flight) for flight in flights])
    predictor = Predictor(fitted, windows)
    weight = 9.81 * fitted.simulation.mass
    begin = guess_speed(windows.flights, predictor.rotors, weight)
    names = [p.name for p in parameters] + list(INPUTS)
    start = np.array([p.start for p in parameters] + list(begin.values()))
    sizes = np.array([p.size for p in parameters] + [begin["inputs.speed"] or 1.0, 1.0, 1.0])
    limits = np.array([p.bounds for p in parameters] + [INPUT_BOUNDS[name] for name in INPUTS])
    links = list_link_values(fitted.model.document)
    products = {name: float(text) for name, text in links.items() if name[-4:] in _PRODUCTS}
    coordinates = Coordinates(names, start, sizes, limits, products)
    search = Search(predictor, coordinates, {})
    trims = np.zeros((len(flights), len(predictor.trim)))
    trims[:, 1] = 1
    x = np.concatenate([coordinates.encode(start), (trims / search.trim_sizes).ravel()])
    if (np.abs(search.compute(x)) >= _FAR).all():
        raise FlightError("every prediction with the start values fails. Give other start values.")
    free = np.ones(len(x), bool)
    for k, name in enumerate(names):
        free[k] = name not in INPUTS or name in free_inputs
    _fix_speed(search, free, [has and i > 0 for i, has in enumerate(_list_scaled(windows))])
    x = search.find(x, free, progress)
    deviations = _compute_deviations(search, x, free)
    found, trims = search.split(x)
    values = coordinates.name(found)
    units = {p.name: p.unit for p in parameters}
    units.update(INPUTS)
    return FlightFit(values, dict(zip(names, start.tolist())), deviations, units, trims, windows)


def _compute_deviations(search: Search, x: np.ndarray, free: np.ndarray) -> Dict[str, float]:
    """Compute standard deviations by the sandwich estimator, with the windows as clusters.

    The errors of one window depend on each other. The estimator does not assume independence
    within a window (H. White, "Maximum likelihood estimation of misspecified models", Econometrica
    50, 1982).
    """
    left, slope = search.compute(x), search.differentiate(x)[:, :, free]
    weight = 1 / (1 + left**2) ** 0.25  # of soft_l1
    left, slope = left * weight, slope * weight[:, :, None]
    normal = np.einsum("nek,nel->kl", slope, slope)
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
    values, vectors = np.linalg.eigh(normal / np.outer(scale, scale))
    known = values > _UNKNOWN * values.max()
    inverse = (vectors[:, known] / values[known]) @ vectors[:, known].T / np.outer(scale, scale)
    score = np.einsum("nek,ne->nk", slope, left)
    covariance = inverse @ (score.T @ score) @ inverse
    unknown = (np.abs(vectors[:, ~known]) > _INVOLVED).any(axis=1)
    low, high = search.find_bounds(len(x))
    unknown |= ((x - low < _CLOSE) | (high - x < _CLOSE))[free]
    shared = int(free[: search.parameters].sum())
    through = search.coordinates.decode_derivative(x[: search.parameters])
    places = np.flatnonzero(free[: search.parameters])
    through = through[np.ix_(places, places)]
    of_values = through @ covariance[:shared, :shared] @ through.T
    deviations = dict.fromkeys(search.coordinates.names, 0.0)
    for k, place in enumerate(places):
        name = search.coordinates.names[place]
        deviations[name] = float("nan") if unknown[k] else float(np.sqrt(of_values[k, k]))
    return deviations


_INVOLVED = 0.3
"""Part of a parameter in such a direction from which it is not identifiable itself."""
_CLOSE = 1e-4
"""Distance of a coordinate from its bound below which the bound determines it."""
_UNKNOWN = 1e-7
"""Eigenvalue, relative to the maximum, below which a direction is not identifiable."""


def calibrate_trims(predictor: Predictor, values: Dict[str, float]) -> np.ndarray:
    """Find delay and constant torque of each flight from the first windows of `predictor`.

    Returns
    -------
    ndarray (flights, trims)
    """
    none = np.empty(0)
    search = Search(predictor, Coordinates([], none, none, np.empty((0, 2)), {}), values)
    trims = np.zeros((len(predictor.windows.flights), len(predictor.trim)))
    trims[:, 0], trims[:, 1] = 0.02, 1
    x = (trims / search.trim_sizes).ravel()
    free = np.ones(len(x), bool)
    _fix_speed(search, free, _list_scaled(predictor.windows))
    return np.asarray(search.split(search.find(x, free))[1])


def _list_scaled(windows: Windows) -> List[bool]:
    """Return for each flight whether it shows a factor of the speeds: thrust against weight."""
    return [flight.rotors is None and flight.has_pose for flight in windows.flights]


def _fix_speed(search: Search, free: np.ndarray, is_free: Sequence[bool]) -> None:
    """Fix the factor of the speeds of some flights."""
    width = len(search.trim_sizes)
    free[search.parameters + 1 :: width] = is_free
