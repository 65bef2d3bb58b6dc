"""Local polynomials through samples of a flight."""

from __future__ import annotations

from typing import Tuple

import numpy as np

NODES = 4
"""Minimum number of samples on each side of a polynomial."""


def fit_locally(
    time: np.ndarray, values: np.ndarray, at: np.ndarray, reach: float, nodes: int = NODES
) -> Tuple[np.ndarray, np.ndarray]:
    """Fit a cubic polynomial around each time, and return its value and derivative at that time.

    Parameters
    ----------
    time : ndarray (rows,)
        Times of the samples in ascending order, s.
    values : ndarray (rows, k)
        Samples.
    at : ndarray (m,)
        Times of the result, s.
    reach : float
        Maximum distance of the samples from each time, s.
    nodes : int
        Minimum number of samples on each side.

    Returns
    -------
    value, derivative : ndarray (m, k)
    """
    step = float(np.median(np.diff(time)))
    width = max(nodes, round(reach / step))
    middle = np.clip(np.searchsorted(time, at), width, max(width, len(time) - width - 1))
    rows = np.clip(middle[:, None] + np.arange(-width, width + 1), 0, len(time) - 1)
    offset = (time[rows] - at[:, None]) / (width * step)
    weight = np.clip(1 - np.abs(offset) ** 3, 0.02, None)
    basis = offset[:, :, None] ** np.arange(4)
    weighted = basis * weight[:, :, None]
    normal = np.swapaxes(weighted, 1, 2) @ basis
    found = np.linalg.solve(normal + 1e-12 * np.eye(4), np.swapaxes(weighted, 1, 2) @ values[rows])
    return found[:, 0], found[:, 1] / (width * step)


def estimate_noise(values: np.ndarray) -> np.ndarray:
    """Estimate the standard deviation of white noise from third differences, shape (k,).

    The median makes the estimate robust; the scale factor assumes a normal distribution.
    """
    if len(values) < 5:
        return np.zeros(values.shape[1])
    third = np.diff(values, 3, axis=0)
    deviations: np.ndarray = np.median(np.abs(third), axis=0) / (0.6745 * np.sqrt(20))
    return deviations
