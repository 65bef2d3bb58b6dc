"""Computation time of controllers."""

from __future__ import annotations

from typing import Tuple

import numpy as np


def summarise_durations(seconds: np.ndarray) -> Tuple[float, float]:
    """Return the median and the 99 % quantile, s; NaN without calls."""
    if not len(seconds):
        return float("nan"), float("nan")
    middle, slow = np.interp([0.5, 0.99], np.linspace(0, 1, len(seconds)), np.sort(seconds))
    return float(middle), float(slow)
