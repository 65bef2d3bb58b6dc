"""How sure a mean over seeds is: bootstrap intervals, paired by seed where two are compared."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Tuple

import numpy as np

RESAMPLES = 2000
CONFIDENCE = 0.95
WORST = 0.1
"""Part of the seeds whose mean is the conditional value at risk."""


def compute_interval(values: np.ndarray) -> Tuple[float, float]:
    """Percentile-bootstrap interval of the mean; NaN for fewer than two values.

    For a difference of two controllers give the differences seed by seed: that pairs them.
    """
    if len(values) < 2:
        return math.nan, math.nan
    means = values[_resample(len(values))].mean(axis=1)
    low, high = np.quantile(means, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return float(low), float(high)


@lru_cache(maxsize=4)
def _resample(count: int) -> np.ndarray:
    # Of a seed of its own, so that the same values have the same interval wherever they stand.
    picks: np.ndarray = np.random.default_rng(0).integers(count, size=(RESAMPLES, count))
    return picks


def compute_cvar(values: np.ndarray) -> float:
    """Conditional value at risk: the mean of the worst tenth, of at least one value."""
    if len(values) == 0:
        return math.nan
    count = max(1, math.ceil(WORST * len(values) - 1e-9))
    return float(np.sort(values)[-count:].mean())
