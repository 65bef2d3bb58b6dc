"""Ranks of values."""

from __future__ import annotations

from typing import Sequence, Union

import numpy as np


def rank_values(values: Union[np.ndarray, Sequence[float]]) -> np.ndarray:
    """Return the rank of each value, starting at 1; equal values share their mean rank.

    `scipy.stats.rankdata` does the same, but its import takes most of a second.

    Parameters
    ----------
    values : ndarray (n,)
        Values without NaN.
    """
    _, place, counts = np.unique(values, return_inverse=True, return_counts=True)
    ranks: np.ndarray = (np.cumsum(counts) - (counts - 1) / 2)[place]
    return ranks
