"""Coordinates of a search, in which every point is a possible vehicle."""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from ..._core import InputError

_MOMENTS = ("ixx", "iyy", "izz")
_PRODUCTS = ("ixy", "ixz", "iyz")
_PAIRS = ((0, 1), (0, 2), (1, 2))
_THINNEST, _LARGEST = 1e-3, 1e2
"""Bounds of the second moment of a body along an axis, relative to the mean of the start."""
_SPREAD = 1.5
"""Standard deviation of the prior of the logarithms: a factor of 4.5, against runaway search."""


class _Body(NamedTuple):
    """Link with free moments of inertia.

    Attributes
    ----------
    link : str
        Name.
    places : list of int
        Places of ixx, iyy and izz among the parameters.
    correlation : ndarray (3, 3)
        Second moments of the mass divided by their square roots on the diagonal.
    """

    link: str
    places: List[int]
    correlation: np.ndarray


class Coordinates:
    """Free parameters as numbers near 1, and logarithms for moments of inertia.

    If ixx, iyy and izz of a link are free, their coordinates are logarithms of the second moments
    of its mass, S = tr(I)/2 - I on the diagonal. The products of inertia keep the correlations of
    S. So S is positive definite, and each point is a body that can exist (C. Rucker and P. M.
    Wensing, "Smooth parameterization of rigid-body inertia", IEEE RA-L 7, 2022).

    Parameters
    ----------
    names
        Names of the parameters.
    start
        Start values.
    sizes
        Typical sizes, to scale the numbers.
    limits
        Minimum and maximum of each, shape (names, 2).
    products
        Values of ``LINK.ixy`` and so on by name.

    Raises
    ------
    InputError
        If no body has the start values of a link.
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
            _make_body(link, places, start[places], products)
            for link, places in _find_links(self.names)
        ]
        self.low, self.high = (limits / self.sizes[:, None]).T
        self.prior = np.zeros(len(names))
        """Inverse standard deviation of the prior of each coordinate around its start."""
        for body in self._bodies:
            second = _to_second_moments(start[body.places])
            self.low[body.places] = np.log(_THINNEST * second.mean())
            self.high[body.places] = np.log(_LARGEST * second.mean())
            self.prior[body.places] = 1 / _SPREAD

    def encode(self, values: np.ndarray) -> np.ndarray:
        """Return the coordinates of values."""
        x = np.asarray(values / self.sizes, float)
        for body in self._bodies:
            x[body.places] = np.log(_to_second_moments(values[body.places]))
        return x

    def decode(self, x: np.ndarray) -> np.ndarray:
        """Return the values at coordinates."""
        values = np.asarray(x * self.sizes, float)
        for body in self._bodies:
            second = np.exp(x[body.places])
            values[body.places] = second.sum() - second
        return values

    def decode_derivative(self, x: np.ndarray) -> np.ndarray:
        """Return the derivative of the values by the coordinates, shape (names, names)."""
        slope = np.diag(self.sizes)
        for body in self._bodies:
            second = np.exp(x[body.places])
            slope[np.ix_(body.places, body.places)] = (1 - np.eye(3)) * second
        return slope

    def name(self, x: np.ndarray) -> Dict[str, float]:
        """Return the values by name, with the products of inertia that follow from them."""
        named = dict(zip(self.names, self.decode(x).tolist()))
        for body in self._bodies:
            root = np.exp(x[body.places] / 2)
            for product, (i, j) in zip(_PRODUCTS, _PAIRS):
                named[f"{body.link}.{product}"] = float(-body.correlation[i, j] * root[i] * root[j])
        return named


def _make_body(
    link: str, places: List[int], moments: np.ndarray, products: Mapping[str, float]
) -> _Body:
    second = np.diag(_to_second_moments(moments))
    for product, (i, j) in zip(_PRODUCTS, _PAIRS):
        second[i, j] = second[j, i] = -products.get(f"{link}.{product}", 0.0)
    if np.linalg.eigvalsh(second)[0] <= 0:
        raise InputError(f"link {link}: no body has its moments of inertia. Correct the model.")
    root = np.sqrt(np.diag(second))
    return _Body(link, places, second / np.outer(root, root))


def _to_second_moments(moments: np.ndarray) -> np.ndarray:
    second: np.ndarray = moments.sum() / 2 - moments
    return second


def _find_links(names: Sequence[str]) -> List[Tuple[str, List[int]]]:
    """Return the links with three free moments, and the places of these."""
    links = [name.rpartition(".")[0] for name in names if name.endswith(f".{_MOMENTS[0]}")]
    return [
        (link, [list(names).index(f"{link}.{moment}") for moment in _MOMENTS])
        for link in links
        if all(f"{link}.{moment}" in names for moment in _MOMENTS)
    ]
