"""Free parameters and residuals of a fit."""

from __future__ import annotations

from typing import Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ..._core import FlightError, InputError, parse_number
from ...model.overrides import LINK_VALUES, list_link_values
from ...support import arguments
from ...support.parameters import suggest
from .fitted_model import FittedModel
from .horizons import Horizons

_STEP = 1e-4  # relative step of a parameter for derivatives
_START_STEPS = (1e-5, 1e-5, 1e-5, 1e-4, 1e-2)
"""Steps of a start: position (m), rotation (rad), velocity (m/s), rates and rotors (rad/s)."""

_FINEST = {"position": 1e-6, "attitude": 1e-6, "velocity": 1e-6, "rates": 1e-6, "rotors": 1e-4}
"""Minimum noise of each channel (m, rad, s), because derivatives are finite differences."""

_CENTRE = 1e-2
"""Minimum typical magnitude of a coordinate of the centre of mass, m."""

_FAR = 1e6
"""Residual of a failed flight."""

Bounds = Mapping[str, Tuple[float, float]]


class Parameter:
    """A free parameter.

    Parameters
    ----------
    name
        ``PLUGIN.TAG``, a value of a link such as ``LINK.mass`` or ``LINK.ixx``, or ``xacro.ARG``.
    fitted
        Model that contains the start value.
    bounds
        Minimum and maximum value.

    Raises
    ------
    InputError
        If the parameter does not exist, or its start value is out of bounds.
    """

    def __init__(
        self,
        name: str,
        fitted: FittedModel,
        bounds: Tuple[float, float] = (-np.inf, np.inf),
    ) -> None:
        plugins, model = fitted.simulation.plugins, fitted.model
        tags = {f"{p.name}.{tag.name}": tag for p in plugins for tag in p.parameters}
        links = list_link_values(model.document)
        self.is_signed = False
        if name in fitted.arguments:
            text, self.unit = fitted.arguments[name], ""
        elif name in tags:
            text, self.unit = tags[name].value, tags[name].unit
        elif name in links:
            of_link = LINK_VALUES[name.rpartition(".")[2]]
            text, self.unit, self.is_signed = links[name], of_link.unit, of_link.is_signed
        else:
            known = [*tags, *links, *fitted.arguments]
            raise InputError(
                f"free {name}: model {model.name} has no such parameter.{suggest(name, known)} "
                "List the parameters with quadcore info."
            )
        value = parse_number(text)
        if value is None:
            raise InputError(f"free {name}: '{text}' is not a number. Only numbers can be fitted.")
        low, high = bounds
        if not low <= value <= high or low == high:
            raise InputError(
                f"bound {name}: the start value {value:g} is not within {low:g} and {high:g}"
            )
        self.name, self.start, self.bounds = name, value, (low, high)
        self.size = max(abs(value), _CENTRE) if self.unit == "m" else abs(value) or 1e-2


def check_free_names(free: Sequence[str]) -> List[str]:
    """Return the names of the free parameters; raise `InputError` if they are invalid."""
    names = [str(name) for name in arguments.to_list(free)]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"free {name}: the parameter is named twice. Remove one.")
    if not names:
        raise InputError("no parameter is free. Name the parameters to fit.")
    return names


def make_parameter(
    name: str, fitted: FittedModel, bounds: Optional[Tuple[float, float]]
) -> Parameter:
    """Make a parameter; by default, a non-negative parameter stays non-negative."""
    if bounds is not None:
        return Parameter(name, fitted, bounds)
    made = Parameter(name, fitted)
    if made.start >= 0 and not made.is_signed:
        made.bounds = (0.0, np.inf)
    return made


class Problem:
    """Residuals of horizons as a function of their free parameters.

    The initial states of the horizons are also free. Variable projection (Golub and Pereyra, SIAM
    J. Numer. Anal. 10, 1973) eliminates them: it projects out the part of the residuals that a
    change of the initial states can remove.
    """

    def __init__(self, horizons: Horizons, parameters: Sequence[Parameter]) -> None:
        self.horizons, self.parameters = horizons, list(parameters)
        self.starts = np.zeros((horizons.count, horizons.corrections))
        sizes = (3, 3, 3, 3, horizons.corrections - 12)
        self._start_steps = np.repeat(_START_STEPS, sizes)
        self.noise = np.ones(len(horizons.channels))
        """Estimated standard deviation of the noise of each channel."""
        self._of_each = horizons.list_channels()
        self._along = np.zeros((horizons.count, horizons.width, 0))
        self._by_starts = np.zeros((horizons.count, horizons.width, horizons.corrections))

    def linearise_starts(self, values: np.ndarray) -> None:
        """Linearise the effect of the initial states at these values; later residuals exclude it.

        Raises
        ------
        FlightError
            If a flight fails.
        """
        steps = np.diag(self._start_steps)
        starts = np.stack([self.starts, *(self.starts + step for step in steps)])
        flown = self.horizons.fly([self._name_values(values)] * len(starts), starts)
        if not np.isfinite(flown).all():
            raise FlightError(
                "flights from measured states fail. Give a shorter horizon or other start values."
            )
        change = (flown[1:] - flown[0]) / self._start_steps[:, None, None]
        self._by_starts = np.moveaxis(change, 0, 2)  # (count, width, corrections)
        self._update_basis()

    def _update_basis(self) -> None:
        weighted = self._by_starts / self._weights[None, :, None]
        size = np.linalg.norm(weighted, axis=1, keepdims=True)
        unit = weighted / np.where(size > 0, size, 1)
        self._along = np.stack([np.linalg.qr(each)[0] for each in unit])

    @property
    def _weights(self) -> np.ndarray:
        weights: np.ndarray = self.noise[self._of_each]
        return weights

    def compute_residuals(self, values: np.ndarray) -> np.ndarray:
        """Return the residuals without the effect of the initial states, weighted by the noise.

        Returns
        -------
        ndarray, shape (count * width,)
        """
        return self._project(np.nan_to_num(self.compare(values), nan=_FAR)).ravel()

    def compute_derivative(self, values: np.ndarray) -> np.ndarray:
        """Return the derivative of the residuals, shape (count * width, parameters)."""
        steps = np.array([_STEP * max(abs(v), p.size) for v, p in zip(values, self.parameters)])
        inward = np.array([v + h > p.bounds[1] for v, h, p in zip(values, steps, self.parameters)])
        steps = np.where(inward, -steps, steps)
        sets = [values, *(values + step for step in np.diag(steps))]
        starts = np.broadcast_to(self.starts, (len(sets), *self.starts.shape))
        flown = self.horizons.fly([self._name_values(each) for each in sets], starts)
        flown = np.nan_to_num(flown, nan=_FAR)
        changes = (flown[1:] - flown[0]) / steps[:, None, None]
        return np.stack([self._project(change).ravel() for change in changes], axis=1)

    def correct_starts(self, values: np.ndarray) -> None:
        """Change the initial states to minimise the residuals."""
        flown = self.compare(values)
        for i, (by_start, left) in enumerate(zip(self._by_starts, flown)):
            weighted = by_start / self._weights[:, None]
            size = np.linalg.norm(weighted, axis=0)
            size = np.where(size > 0, size, 1)
            step = np.linalg.lstsq(weighted / size, left / self._weights, rcond=1e-10)[0] / size
            self.starts[i] -= step

    def compare(self, values: np.ndarray) -> np.ndarray:
        """Return simulated minus measured values, shape (count, width)."""
        flown: np.ndarray = self.horizons.fly([self._name_values(values)], self.starts[None])[0]
        return flown

    def learn_noise(self, values: np.ndarray) -> None:
        """Estimate the noise of each channel from the residuals."""
        left = self.compute_residuals(values).reshape(self.horizons.count, -1) * self._weights
        free = 1 - self._along.shape[2] / self.horizons.width
        for channel in range(len(self.noise)):
            part = left[:, self._of_each == channel]
            least = _FINEST[self.horizons.channels[channel]]
            self.noise[channel] = max(np.sqrt(np.mean(part**2) / max(free, 0.1)), least)
        if self._along.shape[2]:
            self._update_basis()

    def compute_rms(self, values: np.ndarray) -> Dict[str, float]:
        """Return the RMS residual of each channel, in the unit of the channel."""
        left = self.compute_residuals(values).reshape(self.horizons.count, -1) * self._weights
        return {
            name: float(np.sqrt(np.mean(left[:, self._of_each == i] ** 2)))
            for i, name in enumerate(self.horizons.channels)
        }

    def _project(self, flown: np.ndarray) -> np.ndarray:
        weighted = (flown / self._weights)[:, :, None]
        taken = self._along @ (np.swapaxes(self._along, 1, 2) @ weighted)
        rest: np.ndarray = (weighted - taken)[:, :, 0]
        return rest

    def _name_values(self, values: np.ndarray) -> Dict[str, float]:
        return {p.name: float(v) for p, v in zip(self.parameters, values)}


def list_bounds(parameters: Sequence[Parameter]) -> Tuple[List[float], List[float]]:
    """Return the lower and the upper bounds."""
    return [p.bounds[0] for p in parameters], [p.bounds[1] for p in parameters]
