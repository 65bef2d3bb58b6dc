"""Fit of a model to recordings of real flights by the errors of its predictions."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..._core import FlightError
from ...model.overrides import list_link_values
from .coordinates import Coordinates
from .fitted_model import FittedModel
from .inputs import DELAY, INPUT_BOUNDS, INPUTS, MAP, guess_inputs
from .instruments import Half, compute_deviations, estimate
from .predictor import Predictor
from .prepared import PreparedFlight, smooth_rotors, split_samples
from .problem import Parameter
from .windows import Windows, compute_errors, make_windows, predict_constant

_STEP = 1e-4  # of a coordinate, for derivatives
_ROUNDS = 25
_PRODUCTS = (".ixy", ".ixz", ".iyz")
_NODES_OF_HALF, _NODES_OF_INSTRUMENTS = 2, 5
"""Minimum samples on each side of polynomials through half of the samples."""
_PRIOR, _TORQUE_PRIOR = 3.0, 1e3
"""Standard deviations of weak priors: coordinates have sizes near 1; 10 rad/s^2 for torques."""
_FAR = 30.0
"""Weighted error of a prediction that failed."""
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
    weights
        Weights of the errors (default: the inverse RMS errors of constant velocity and rates).
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
        """Return a search with other windows of the same flights."""
        predictor = Predictor(self.predictor.fitted, windows)
        return Search(predictor, self.coordinates, self._fixed, self._weights)

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

    def linearise(self, x: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Return the errors and their derivative, shape (windows, errors, coordinates)."""
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
        """Return the standard deviation of the prior of each coordinate around its start."""
        of_trim = [_PRIOR, _PRIOR, *[_TORQUE_PRIOR] * (len(self.trim_sizes) - 2)]
        prior = np.tile(of_trim, self._flights)
        shared = np.full(self.parameters, _PRIOR)
        is_body = self.coordinates.prior > 0
        shared[is_body] = 1 / self.coordinates.prior[is_body]
        return np.concatenate([shared, prior])

    def find_bounds(self, size: int) -> Any:
        """Return lower and upper bounds of the coordinates."""
        low, high = np.full(size, -np.inf), np.full(size, np.inf)
        low[: self.parameters] = self.coordinates.low
        high[: self.parameters] = self.coordinates.high
        delays = slice(self.parameters, size, len(self.trim_sizes))
        has_rotors = [flight.rotors is not None for flight in self.predictor.windows.flights]
        earliest, latest = INPUT_BOUNDS[DELAY]
        low[delays] = np.where(has_rotors, earliest, 0) / self.trim_sizes[0]
        high[delays] = latest / self.trim_sizes[0]
        return low, high


def fit_flights(
    fitted: FittedModel,
    parameters: Sequence[Parameter],
    free_inputs: Sequence[str],
    flights: Sequence[PreparedFlight],
    given: Mapping[str, float],
    limits: Mapping[str, Tuple[float, float]],
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
        Names of `INPUTS` that are free.
    flights
        Prepared flights.
    given
        Start values of `INPUTS`, or fixed values of those that are not free. Without a given delay,
        the delay is free.
    limits
        Bounds of `MAP` that differ from `INPUT_BOUNDS`.

    Raises
    ------
    FlightError
        If every prediction of the start values fails.
    """
    windows = make_windows(flights)
    predictor = Predictor(fitted, windows)
    weight = 9.81 * fitted.simulation.mass
    begin = guess_inputs(windows.flights, predictor.rotors, weight, given)
    names = [p.name for p in parameters] + list(MAP)
    start = np.array([p.start for p in parameters] + [begin[name] for name in MAP])
    sizes = np.array([p.size for p in parameters] + [begin["inputs.speed"] or 1.0, 1.0, 1.0])
    bounds = {**INPUT_BOUNDS, **limits}
    ranges = np.array([p.bounds for p in parameters] + [bounds[name] for name in MAP])
    links = list_link_values(fitted.model.document)
    products = {name: float(text) for name, text in links.items() if name[-4:] in _PRODUCTS}
    coordinates = Coordinates(names, start, sizes, ranges, products)
    search = Search(predictor, coordinates, {})
    trims = np.zeros((len(flights), len(predictor.trim)))
    trims[:, 0], trims[:, 1] = given.get(DELAY, 0.0), 1
    x = np.concatenate([coordinates.encode(start), (trims / search.trim_sizes).ravel()])
    if (np.abs(search.compute(x)) >= _FAR).all():
        raise FlightError("every prediction with the start values fails. Give other start values.")
    free = np.ones(len(x), bool)
    for k, name in enumerate(names):
        free[k] = name not in MAP or name in free_inputs
    fixed = {DELAY: given[DELAY]} if DELAY in given and DELAY not in free_inputs else {}
    if fixed:
        _fix_delay(search, free)
    _fix_speed(search, free, [has and i > 0 for i, has in enumerate(_list_scaled(windows))])
    if not fixed:
        x = _choose_delays(search, x)
    halves, begin_x = [Half(search, search)], x
    least = search.find(x, free, progress)
    best: Optional[np.ndarray] = least
    if any(flight.rotors is not None for flight in flights):  # the inputs are noisy
        halves = [_make_half(search, flights, half) for half in (0, 1)]
        best = estimate(halves, begin_x, least, free)
    if best is None:  # the flights show hardly more than noise
        deviations = {n: float("nan") if f else 0.0 for n, f in zip(names, free)}
    else:
        x = best
        deviations = compute_deviations(halves, begin_x, x, free)
    found, trims = search.split(x)
    values = {**coordinates.name(found), **fixed}
    deviations.update(dict.fromkeys(fixed, 0.0))
    units = {p.name: p.unit for p in parameters}
    units.update(INPUTS)
    first = {**dict(zip(names, start.tolist())), **fixed}
    return FlightFit(values, first, deviations, units, trims, windows)


def calibrate_trims(predictor: Predictor, values: Dict[str, float]) -> np.ndarray:
    """Find delay and constant torque of each flight from the windows of `predictor`.

    Parameters
    ----------
    values
        Values of the model and of `INPUTS`. If they contain a delay, it is fixed.

    Returns
    -------
    ndarray (flights, trims)
    """
    none = np.empty(0)
    search = Search(predictor, Coordinates([], none, none, np.empty((0, 2)), {}), values)
    trims = np.zeros((len(predictor.windows.flights), len(predictor.trim)))
    trims[:, 0], trims[:, 1] = values.get(DELAY, 0.02), 1
    x = (trims / search.trim_sizes).ravel()
    free = np.ones(len(x), bool)
    _fix_speed(search, free, _list_scaled(predictor.windows))
    if DELAY in values:
        _fix_delay(search, free)
    else:
        x = _choose_delays(search, x)
    return np.asarray(search.split(search.find(x, free) if free.any() else x)[1])


def _make_half(search: Search, flights: Sequence[PreparedFlight], number: int) -> Half:
    """Make the searches on the even (0) or odd (1) samples."""
    split = [split_samples(flight, number) for flight in flights]
    smooth = make_windows([smooth_rotors(flight) for flight in split], _NODES_OF_INSTRUMENTS)
    raw = make_windows(split, _NODES_OF_HALF)
    return Half(search.replace_windows(raw), search.replace_windows(smooth))


def _list_scaled(windows: Windows) -> List[bool]:
    """Return for each flight whether it shows a factor of the speeds: thrust against weight."""
    return [flight.rotors is None and flight.has_pose for flight in windows.flights]


def _fix_delay(search: Search, free: np.ndarray) -> None:
    """Fix the delay of all flights."""
    free[search.parameters :: len(search.trim_sizes)] = False


def _choose_delays(search: Search, x: np.ndarray) -> np.ndarray:
    """Start each flight with measured rotor speeds at the best of some delays.

    The errors of predictions have several minima over the delay of an input that varies quickly.
    Commands have delays near their start.
    """
    flight, width = search.predictor.windows.flight, len(search.trim_sizes)
    places = search.parameters + width * np.arange(len(search.predictor.windows.flights))
    costs = []
    delays = np.arange(*INPUT_BOUNDS[DELAY], 0.02) + 0.02
    for delay in delays:
        tried = x.copy()
        tried[places] = delay / search.trim_sizes[0]
        cost = np.sum(np.sqrt(1 + search.compute(tried) ** 2), axis=1)  # soft_l1
        costs.append(np.bincount(flight, cost))
    best = delays[np.argmin(costs, axis=0)]
    has_rotors = [each.rotors is not None for each in search.predictor.windows.flights]
    chosen = x.copy()
    chosen[places[has_rotors]] = best[has_rotors] / search.trim_sizes[0]
    return chosen


def _fix_speed(search: Search, free: np.ndarray, is_free: Sequence[bool]) -> None:
    """Fix the factor of the speeds of some flights."""
    width = len(search.trim_sizes)
    free[search.parameters + 1 :: width] = is_free
