"""PAWN index: how strongly the distribution of a result depends on one parameter.

The rows are divided into slices by the value of the parameter. The index is the mean
Kolmogorov-Smirnov distance between the distribution in a slice and that of all rows, weighted by
the number of rows. It ranges from 0 (no effect) to 1. It requires no particular design and also
detects effects that are not monotonic (Pianosi and Wagener, Environmental Modelling & Software 108,
2018).
"""

from __future__ import annotations

import math
from typing import Iterable, NamedTuple

import numpy as np

_SLICES = 10  # maximum number of slices
_LEAST = 6  # minimum number of rows per slice
_LEVELS = 100  # maximum number of levels of the distribution functions
_RESAMPLES = 100
_QUANTILE = 0.95
_DEVIATIONS = 1.96  # half-width of a 95 % interval in standard deviations


class Pawn(NamedTuple):
    """Index with its uncertainty; NaN if there are too few rows."""

    value: float = math.nan
    interval: float = math.nan
    """Half-width of the 95 % interval from a bootstrap."""
    noise: float = math.nan
    """95 % quantile of the index of a parameter without effect."""


def compute_pawn(parameter: np.ndarray, values: np.ndarray) -> Pawn:
    """Compute the index of a parameter for the values of a result; both have shape (rows,)."""
    known = np.isfinite(values)
    count = int(known.sum())
    if count < 2 * _LEAST or np.ptp(values[known]) == 0:
        return Pawn()
    slices = _divide(parameter[known], min(_SLICES, count // _LEAST))
    levels = _divide(values[known], _LEVELS)
    if slices.max() == 0:
        return Pawn()
    shape = int(levels.max()) + 1, int(slices.max()) + 1
    cells = levels * shape[1] + slices

    def count_rows(sets: Iterable[np.ndarray]) -> np.ndarray:
        tables = [np.bincount(each, minlength=shape[0] * shape[1]) for each in sets]
        return np.array(tables).reshape(-1, *shape)

    draw = np.random.default_rng(0)  # the same rows give the same interval
    again = (cells[draw.integers(count, size=count)] for _ in range(_RESAMPLES))
    without = (levels * shape[1] + draw.permutation(slices) for _ in range(_RESAMPLES))
    return Pawn(
        float(_compute_distances(count_rows([cells]))[0]),
        _DEVIATIONS * float(_compute_distances(count_rows(again)).std(ddof=1)),
        float(np.quantile(_compute_distances(count_rows(without)), _QUANTILE)),
    )


def _divide(values: np.ndarray, most: int) -> np.ndarray:
    """Return the class of each value: one per distinct value, or classes of equal size if many."""
    distinct, own = np.unique(values, return_inverse=True)
    if len(distinct) <= most:
        return np.asarray(own).reshape(-1)
    ends = np.quantile(values, np.linspace(0, 1, most + 1)[1:-1])
    _, found = np.unique(np.searchsorted(ends, values), return_inverse=True)
    return np.asarray(found).reshape(-1)


def _compute_distances(tables: np.ndarray) -> np.ndarray:
    """Return the index for tables of row counts, shape (..., levels, slices)."""
    cumulated = tables.cumsum(axis=-2)
    sizes = cumulated[..., -1, :]
    whole = cumulated.sum(axis=-1, keepdims=True) / sizes.sum(axis=-1)[..., None, None]
    parts = cumulated / np.maximum(sizes, 1)[..., None, :]
    distances = np.abs(parts - whole).max(axis=-2)
    found: np.ndarray = (distances * sizes).sum(axis=-1) / sizes.sum(axis=-1)
    return found
