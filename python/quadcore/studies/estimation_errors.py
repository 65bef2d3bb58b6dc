"""Errors of the states that controllers estimate."""

from __future__ import annotations

from typing import Dict, Optional

import numpy as np

METRICS = {
    "estimate": {
        "rms_estimated_position": ("m", "RMS error of the estimated position"),
        "rms_estimated_velocity": ("m/s", "RMS error of the estimated velocity"),
        "rms_estimated_attitude": ("rad", "RMS angle between estimated and true attitude"),
        "nees": (
            "",
            "mean normalised estimation error squared per component (NEES), 1 if the covariance "
            "of the estimate is right",
        ),
    },
}
"""For each metric, the unit and meaning of its values."""


def measure(rows: Optional[np.ndarray]) -> Dict[str, float]:
    """Compute the values of the metric from `EstimateErrors.rows`; NaN without an estimate."""
    names = METRICS["estimate"]
    values = np.full(len(names), np.nan)
    if rows is not None:
        squares = [(rows[:, i : i + 3] ** 2).sum(axis=1) for i in (0, 3, 6)]
        known = [square[~np.isnan(square)] for square in (*squares, rows[:, 9])]
        means = [float(each.mean()) if len(each) else np.nan for each in known]
        values[:3], values[3] = np.sqrt(means[:3]), means[3]
    return dict(zip(names, values.tolist()))
