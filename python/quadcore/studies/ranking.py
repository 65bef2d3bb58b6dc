"""Ranks of values."""

from __future__ import annotations

from typing import Sequence, Union

import numpy as np


def rank_values(values: Union[np.ndarray, Sequence[float]]) -> np.ndarray:
    """Return the rank of each value, from 1; equal values have their mean rank.

    The function of scipy.stats does the same, but takes most of a second to import.

    Parameters
    ----------
    values : ndarray (n,)
        Values without NaN.
    """
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    ranks: np.ndarray = (np.cumsum(counts) - (counts - 1) / 2)[place]
    return ranks
