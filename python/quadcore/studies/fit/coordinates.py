"""Coordinates of a search in which every point is a physically possible vehicle."""

from __future__ import annotations

from typing import Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..._core import FlightError, InputError, Model
from ...model.overrides import list_link_values

_MOMENTS = ("ixx", "iyy", "izz")
_PRODUCTS = ("ixy", "ixz", "iyz")
_PAIRS = ((0, 1), (0, 2), (1, 2))
_THINNEST, _LARGEST = 1e-3, 1e2
"""Bounds of the second moments of a body, relative to their mean at the start."""
_STEP = 1e-5  # step of a coordinate for derivatives
_SPREAD = 1.5
"""Standard deviation of the prior of the logarithms (a factor of 4.5), against divergence."""


class _Body(NamedTuple):
    """Link with free moments of inertia.

    Attributes
    ----------
    link : str
        Name of the link.
    places : list of int
        Indices of ixx, iyy and izz among the parameters.
    products : list of int or None
        Indices of ixy, ixz and iyz among the parameters; None for a fixed product.
    fixed : ndarray (3,)
        Values of ixy, ixz and iyz, used if they are fixed.
    """

    link: str
    places: List[int]
    products: List[Optional[int]]
    fixed: np.ndarray

    def find_products(self, values: np.ndarray) -> np.ndarray:
        """Return ixy, ixz and iyz, kg m^2."""
        pairs = zip(self.products, self.fixed)
        return np.array([fixed if k is None else values[k] for k, fixed in pairs])


class Coordinates:
    """Coordinates of the free parameters: scaled values, and logarithms for moments of inertia.

    If ixx, iyy and izz of a link are free, their coordinates are the logarithms of the squared
    diagonal of L. Here S = L L^T = tr(I)/2 - I is the matrix of the second moments of the mass. The
    products of inertia give the rest of L. Therefore S is positive definite, and each point is a
    possible body (log-Cholesky; C. Rucker and P. M. Wensing, "Smooth parameterization of rigid-body
    inertia", IEEE RA-L 7, 2022).

    Parameters
    ----------
    names
        Names of the parameters.
    start
        Start values.
    sizes
        Typical magnitudes, which scale the values.
    limits
        Minimum and maximum of each parameter, shape (names, 2).
    products
        Products of inertia (``LINK.ixy`` and so on) by name.

    Raises
    ------
    InputError
        If the start values of a link are not physically possible.
    """

    def __init__(
        self,
        names: Sequence[str],
        start: np.ndarray,
        sizes: np.ndarray,
        limits: np.ndarray,
        products: Mapping[str, float],
    ) -> None:
        self.names, self.sizes = list(names), np.asarray(sizes, float)
        self._bodies = [
            _make_body(link, places, self.names, products)
            for link, places in _find_links(self.names)
        ]
        for body in self._bodies:
            second = _to_second_moments(start[body.places], body.find_products(start))
            if np.linalg.eigvalsh(second)[0] <= 0:
                raise InputError(
                    f"link {body.link}: no body has its moments of inertia. Correct the model."
                )
        self.low, self.high = (limits / self.sizes[:, None]).T
        self.prior = np.zeros(len(names))
        """Inverse standard deviation of the prior of each coordinate around its start value."""
        for body in self._bodies:
            mean = start[body.places].sum() / 6
            self.low[body.places] = np.log(_THINNEST * mean)
            self.high[body.places] = np.log(_LARGEST * mean)
            self.prior[body.places] = 1 / _SPREAD

    def encode(self, values: np.ndarray) -> np.ndarray:
        """Return the coordinates of parameter values."""
        x = np.asarray(values / self.sizes, float)
        for body in self._bodies:
            second = _to_second_moments(values[body.places], body.find_products(values))
            x[body.places] = 2 * np.log(np.diag(np.linalg.cholesky(second)))
        return x

    def decode(self, x: np.ndarray) -> np.ndarray:
        """Return the parameter values at a point."""
        values = np.asarray(x * self.sizes, float)
        for body in self._bodies:
            second = _compose(x[body.places], body.find_products(values))
            values[body.places] = second.sum() - second
        return values

    def decode_derivative(self, x: np.ndarray) -> np.ndarray:
        """Return the derivative of the values with respect to the coordinates, (names, names)."""
        steps = _STEP * np.eye(len(x))
        changes = [self.decode(x + step) - self.decode(x - step) for step in steps]
        return np.stack(changes, axis=1) / (2 * _STEP)

    def name(self, x: np.ndarray) -> Dict[str, float]:
        """Return the parameter values by name."""
        return dict(zip(self.names, self.decode(x).tolist()))


def check_bodies(model: Model, free: Iterable[str]) -> None:
    """Check that links with free moments of inertia are physically possible.

    Raises
    ------
    FlightError
        If the inertia of such a link is not physically possible.
    """
    written = list_link_values(model.document)
    parts = [name.rpartition(".") for name in free if name in written]
    for link in sorted({link for link, _, value in parts if value in (*_MOMENTS, *_PRODUCTS)}):
        moments, products = (
            np.array([float(written.get(f"{link}.{name}", "0")) for name in names])
            for names in (_MOMENTS, _PRODUCTS)
        )
        if np.linalg.eigvalsh(_to_second_moments(moments, products))[0] < 0:
            raise FlightError(
                f"link {link}: no body has the fitted moments of inertia. Free ixx, iyy and izz "
                "together, or correct the fixed ones."
            )


def _make_body(
    link: str, places: List[int], names: Sequence[str], products: Mapping[str, float]
) -> _Body:
    full = [f"{link}.{product}" for product in _PRODUCTS]
    of_products = [names.index(name) if name in names else None for name in full]
    fixed = np.array([products.get(name, 0.0) for name in full])
    return _Body(link, places, of_products, fixed)


def _to_second_moments(moments: np.ndarray, products: np.ndarray) -> np.ndarray:
    """Return the second moments S = tr(I)/2 - I, shape (3, 3)."""
    second = np.diag(moments.sum() / 2 - moments)
    for product, (i, j) in zip(products, _PAIRS):
        second[i, j] = second[j, i] = -product
    return second


def _compose(logarithms: np.ndarray, products: np.ndarray) -> np.ndarray:
    """Return the diagonal of S from the logarithms and the products of inertia."""
    one, two, three = np.exp(logarithms)  # squared diagonal of L
    s12, s13, s23 = -products
    l21, l31 = s12**2 / one, s13**2 / one  # squared elements of L
    l32 = (s23 - s12 * s13 / one) ** 2 / two
    return np.array([one, two + l21, three + l31 + l32])


def _find_links(names: Sequence[str]) -> List[Tuple[str, List[int]]]:
    """Return the links with three free moments, and the indices of these moments."""
    links = [name.rpartition(".")[0] for name in names if name.endswith(f".{_MOMENTS[0]}")]
    return [
        (link, [list(names).index(f"{link}.{moment}") for moment in _MOMENTS])
        for link in links
        if all(f"{link}.{moment}" in names for moment in _MOMENTS)
    ]
