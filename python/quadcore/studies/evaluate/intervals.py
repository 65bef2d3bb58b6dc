"""Confidence intervals, tests and conditional value at risk (CVaR) over seeds.

Intervals and tests use Student's t distribution. With few seeds, a percentile bootstrap covers much
less than its nominal level (50 % instead of 95 % with two seeds).
"""

from __future__ import annotations

import math
from typing import List, Sequence, Tuple

import numpy as np

from ..tracking_metrics import EQUAL

CONFIDENCE = 0.95
WORST = 0.1
"""Fraction of the seeds with the worst values; their mean is the conditional value at risk."""


def compute_interval(values: np.ndarray) -> Tuple[float, float]:
    """Return Student's confidence interval of the mean; NaN for fewer than two values.

    To compare two controllers, pass the differences for each seed.
    """
    if len(values) < 2:
        return math.nan, math.nan
    from scipy.special import stdtrit  # scipy is slow to import

    reach = float(stdtrit(len(values) - 1, (1 + CONFIDENCE) / 2)) * _compute_standard_error(values)
    mean = float(values.mean())
    return mean - reach, mean + reach


def compute_p_value(values: np.ndarray) -> float:
    """Return the two-sided p-value of a zero mean (Student's t test); NaN below two values.

    If the values are equal for all seeds, the p-value is 0, or 1 if they are below `EQUAL`.
    """
    if len(values) < 2:
        return math.nan
    if np.ptp(values) < EQUAL:
        return float(abs(values.mean()) < EQUAL)
    from scipy.special import stdtr

    size = abs(float(values.mean())) / _compute_standard_error(values)
    return 2 * float(stdtr(len(values) - 1, -size))


def compute_effect_size(differences: np.ndarray) -> float:
    """Return Cohen's d of paired differences (mean / deviation); NaN for fewer than two values."""
    if len(differences) < 2 or np.ptp(differences) < EQUAL:
        return math.nan
    return float(differences.mean() / differences.std(ddof=1))


def adjust_p_values(p_values: Sequence[float]) -> List[float]:
    """Adjust p-values for multiple comparisons (Holm, Scand. J. Statistics 6, 1979); NaN stays."""
    found = np.array(p_values, dtype=float)
    known = np.flatnonzero(~np.isnan(found))
    order = known[np.argsort(found[known], kind="stable")]
    factors = np.arange(len(order), 0, -1)
    found[order] = np.minimum(np.maximum.accumulate(factors * found[order]), 1)
    return [float(value) for value in found]


def compute_cvar(values: np.ndarray) -> float:
    """Return the conditional value at risk: the mean of the highest 10 % (at least one value)."""
    if len(values) == 0:
        return math.nan
    count = max(1, math.ceil(WORST * len(values) - 1e-9))
    return float(np.sort(values)[-count:].mean())


def _compute_standard_error(values: np.ndarray) -> float:
    return float(values.std(ddof=1)) / math.sqrt(len(values))
