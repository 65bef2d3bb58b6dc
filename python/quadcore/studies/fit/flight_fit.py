"""Fit of a model to recordings of real flights, by the errors of its predictions."""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

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
from .window_search import FAR, Progress, Search
from .windows import Windows, make_windows

_PRODUCTS = (".ixy", ".ixz", ".iyz")
_NODES_OF_HALF, _NODES_OF_INSTRUMENTS = 2, 5
"""Minimum number of samples on each side of the polynomials through half of the samples."""


class FlightFit(NamedTuple):
    """Result of a fit to real flights.

    Attributes
    ----------
    values, start, deviations : dict of str to float
        Fitted value, start value and standard deviation of each parameter. The deviation is NaN if
        the flights do not identify the parameter.
    units : dict of str to str
        Unit of each parameter.
    trims : ndarray (flights, trims)
        Delay (s), speed factor and constant torque (N m) of each flight.
    windows : Windows
        Windows of the fitted flights.
    """

    values: Dict[str, float]
    start: Dict[str, float]
    deviations: Dict[str, float]
    units: Dict[str, str]
    trims: np.ndarray
    windows: Windows


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
        Model to fit.
    parameters
        Free parameters of the model.
    free_inputs
        Names in `INPUTS` that are free.
    flights
        Prepared flights.
    given
        Values of `INPUTS`: start values of the free ones, fixed values of the others. Without a
        given delay, the delay is free.
    limits
        Bounds of parameters in `MAP` that replace `INPUT_BOUNDS`.

    Raises
    ------
    FlightError
        If every prediction with the start values fails.
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
    if (np.abs(search.compute(x)) >= FAR).all():
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
    if best is None:  # the flights contain little more than noise
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
    """Find the trims (delay, speed factor, constant torque) of each flight from its windows.

    Parameters
    ----------
    values
        Values of the model parameters and of `INPUTS`. A delay in them is fixed.

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
    """Make the searches with the even (0) or odd (1) samples."""
    split = [split_samples(flight, number) for flight in flights]
    smooth = make_windows([smooth_rotors(flight) for flight in split], _NODES_OF_INSTRUMENTS)
    raw = make_windows(split, _NODES_OF_HALF)
    return Half(search.replace_windows(raw), search.replace_windows(smooth))


def _list_scaled(windows: Windows) -> List[bool]:
    """Return whether each flight shows the factor on the speeds: commands and pose are needed."""
    return [flight.rotors is None and flight.has_pose for flight in windows.flights]


def _fix_delay(search: Search, free: np.ndarray) -> None:
    """Fix the delays of all flights."""
    free[search.parameters :: len(search.trim_sizes)] = False


def _choose_delays(search: Search, x: np.ndarray) -> np.ndarray:
    """Start the delay of each flight with measured rotor speeds at the best of several values.

    For an input that varies quickly, the prediction error has several minima over the delay. The
    delay of commands is close to its start value.
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
    """Fix the speed factor of the flights for which `is_free` is false."""
    width = len(search.trim_sizes)
    free[search.parameters + 1 :: width] = is_free
