"""PAWN index: how much the distribution of a result depends on one parameter.

The rows are divided into slices by the parameter. The index is the mean Kolmogorov-Smirnov distance
between the distribution in a slice and that of all rows, weighted by the number of rows. It is 0
without an effect, at most 1, needs no particular design, and also shows effects that are not
monotonic (Pianosi and Wagener, Environmental Modelling & Software 108, 2018).
"""

from __future__ import annotations

import math
from typing import Iterable, NamedTuple

import numpy as np

_SLICES = 10  # at most
_LEAST = 6  # rows per slice
_LEVELS = 100  # of the distribution functions, at most
_RESAMPLES = 100
_QUANTILE = 0.95
_DEVIATIONS = 1.96  # of a 95 % interval


class Pawn(NamedTuple):
    """Index with its uncertainty; NaN without enough rows."""

    value: float = math.nan
    interval: float = math.nan
    """Half-width of the 95 % interval, by bootstrap."""
    noise: float = math.nan
    """Index that 95 % of parameters without effect do not exceed."""


def compute_pawn(parameter: np.ndarray, values: np.ndarray) -> Pawn:
    """Compute the index of a parameter for some values; both have shape (rows,)."""
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

    draw = np.random.default_rng(0)  # equal rows have equal intervals
    again = (cells[draw.integers(count, size=count)] for _ in range(_RESAMPLES))
    without = (levels * shape[1] + draw.permutation(slices) for _ in range(_RESAMPLES))
    return Pawn(
        float(_compute_distances(count_rows([cells]))[0]),
        _DEVIATIONS * float(_compute_distances(count_rows(again)).std(ddof=1)),
        float(np.quantile(_compute_distances(count_rows(without)), _QUANTILE)),
    )


def _divide(values: np.ndarray, most: int) -> np.ndarray:
    """Return a class of each value: its own if there are few values, else one of equal sizes."""
    distinct, own = np.unique(values, return_inverse=True)
    if len(distinct) <= most:
        return np.asarray(own).reshape(-1)
    ends = np.quantile(values, np.linspace(0, 1, most + 1)[1:-1])
    _, found = np.unique(np.searchsorted(ends, values), return_inverse=True)
    return np.asarray(found).reshape(-1)


def _compute_distances(tables: np.ndarray) -> np.ndarray:
    """Return the index of tables of row counts, shape (..., levels, slices)."""
    cumulated = tables.cumsum(axis=-2)
    sizes = cumulated[..., -1, :]
    whole = cumulated.sum(axis=-1, keepdims=True) / sizes.sum(axis=-1)[..., None, None]
    parts = cumulated / np.maximum(sizes, 1)[..., None, :]
    distances = np.abs(parts - whole).max(axis=-2)
    found: np.ndarray = (distances * sizes).sum(axis=-1) / sizes.sum(axis=-1)
    return found
