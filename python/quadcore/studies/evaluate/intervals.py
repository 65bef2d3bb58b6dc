"""Bootstrap intervals and conditional value at risk of means over seeds."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Tuple

import numpy as np

RESAMPLES = 2000
CONFIDENCE = 0.95
WORST = 0.1
"""Share of the worst seeds; their mean is the conditional value at risk."""


def compute_interval(values: np.ndarray) -> Tuple[float, float]:
    """Return the percentile-bootstrap interval of the mean; NaN for fewer than two values.

    To compare two controllers, pass the differences for each seed.
    """
    if len(values) < 2:
        return math.nan, math.nan
    means = values[_resample(len(values))].mean(axis=1)
    low, high = np.quantile(means, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return float(low), float(high)


@lru_cache(maxsize=4)
def _resample(count: int) -> np.ndarray:
    # A fixed seed: equal values have equal intervals.
    picks: np.ndarray = np.random.default_rng(0).integers(count, size=(RESAMPLES, count))
    return picks


def compute_cvar(values: np.ndarray) -> float:
    """Return the conditional value at risk: the mean of the worst tenth, at least of one value."""
    if len(values) == 0:
        return math.nan
    count = max(1, math.ceil(WORST * len(values) - 1e-9))
    return float(np.sort(values)[-count:].mean())
