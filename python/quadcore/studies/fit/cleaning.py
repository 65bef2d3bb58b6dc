"""Samples of a recording that are removed, and the reasons."""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Tuple

import numpy as np

from ...formats.recordings import Recording
from ...formats.recordings.series import Series
from .smoothing import estimate_noise, fit_locally

_MEASURED = ("position", "orientation", "velocity", "rates", "acceleration")
_FAR = 8.0
"""Deviation from its neighbours that makes a pose a glitch, in standard deviations."""
_LEAST = {"position": 0.01, "orientation": 0.03}
"""Minimum of this deviation: m, and twice the sine of half an angle."""
_REACH = 0.05  # s; half-width of the polynomials that predict a pose
_NEIGHBOURS = 11
"""Removals per round: one in this many samples, because a glitch distorts its surroundings."""
_ROUNDS = 20
_FASTEST = 5.0
"""Maximum rotor speed relative to a high quantile, which allows 25 times the thrust."""
_HIGH = 90  # percentile; fewer than the remaining samples may be invalid
_FULL_SCALES = {
    "rates": np.radians([250, 500, 1000, 2000, 4000]),
    "acceleration": 9.80665 * np.array([2, 3, 4, 6, 8, 12, 16, 24, 32]),
}
"""Full-scale ranges of common IMUs, rad/s and m/s^2."""
_OFFSET = 0.03
"""Relative distance from full scale at which a sample counts as saturated (offset and gain)."""
_GAP = 3.0
"""Length of a gap, relative to the usual time between samples."""


class Removal(NamedTuple):
    """Samples that were removed.

    Attributes
    ----------
    topic, reason : str
        Quantity, and reason for the removal.
    samples : int
        Number of removed samples.
    """

    topic: str
    reason: str
    samples: int


def clean_recording(recording: Recording) -> Tuple[Recording, List[Removal]]:
    """Remove repeated samples, invalid and saturated values, and glitches, in this order.

    Rows with missing values are already removed; this function only reports their number.

    The order matters: a repeated sample looks like a standstill, and two glitches look like motion.
    """
    removals = [
        Removal(name, "incomplete", count) for name, count in recording.incomplete.items() if count
    ]
    quantities: Dict[str, Series] = {}
    for name, series in recording.quantities.items():
        for reason, find in _CHECKS.items():
            wrong = find(name, series)
            if wrong.any():
                removals.append(Removal(name, reason, int(wrong.sum())))
                series = Series(series.time[~wrong], series.values[~wrong])
        quantities[name] = series
    return recording._replace(quantities=quantities), removals


def list_gaps(series: Series) -> np.ndarray:
    """List the start and end of each gap between samples, s; shape (gaps, 2)."""
    apart = np.diff(series.time)
    if len(apart) == 0:
        return np.empty((0, 2))
    wide = np.flatnonzero(apart > _GAP * np.median(apart))
    return np.column_stack([series.time[wide], series.time[wide + 1]])


def _find_repeated(name: str, series: Series) -> np.ndarray:
    repeated = np.zeros(len(series.time), bool)
    if name in _MEASURED:
        repeated[1:] = (np.diff(series.values, axis=0) == 0).all(axis=1)
    repeated[1:] |= np.diff(series.time) <= 0
    return repeated


def _find_impossible(name: str, series: Series) -> np.ndarray:
    """Find commands outside their range, and impossible speeds and voltages."""
    wrong = np.zeros(len(series.time), bool)
    if name == "commands":
        wrong[:] = ((series.values < -1e-6) | (series.values > 1 + 1e-6)).any(axis=1)
    elif name == "rotors" and len(wrong):
        speeds = np.abs(series.values)
        wrong[:] = (speeds > _FASTEST * np.percentile(speeds, _HIGH)).any(axis=1)
    elif name == "battery":
        wrong[:] = series.values[:, 0] <= 0
    return wrong


def _find_saturated(name: str, series: Series) -> np.ndarray:
    """Find samples of an IMU that stay at the maximum of an axis close to full scale."""
    saturated = np.zeros(len(series.time), bool)
    if name not in _FULL_SCALES or len(saturated) < 2:
        return saturated
    sizes = np.abs(series.values)
    scales = _FULL_SCALES[name][:, None]
    is_full = (np.abs(sizes.max(axis=0) - scales) < _OFFSET * scales).any(axis=0)
    stays = (sizes == sizes.max(axis=0))[1:] & (np.diff(series.values, axis=0) == 0) & is_full
    saturated[1:] |= stays.any(axis=1)
    saturated[:-1] |= stays.any(axis=1)
    return saturated


def _find_glitches(name: str, series: Series) -> np.ndarray:
    """Find poses that deviate from their neighbours, starting with the maximum deviation."""
    from scipy.ndimage import maximum_filter1d

    glitch = np.zeros(len(series.time), bool)
    if name not in _LEAST or len(series.time) < 12:
        return glitch
    values = series.values.copy()
    if name == "orientation":
        flips = np.where(np.sum(values[1:] * values[:-1], axis=1) < 0, -1, 1)
        values[1:] *= np.cumprod(flips)[:, None]
    limit = max(_FAR * float(estimate_noise(values).max()), _LEAST[name])
    for _ in range(_ROUNDS):
        kept = np.flatnonzero(~glitch)
        smooth, _ = fit_locally(series.time[kept], values[kept], series.time[kept], _REACH)
        apart = np.linalg.norm(values[kept] - smooth, axis=1)
        peaks = (apart > limit) & (apart >= maximum_filter1d(apart, _NEIGHBOURS))
        if not peaks.any():
            break
        glitch[kept[peaks]] = True
    return glitch


_CHECKS = {
    "repeated sample": _find_repeated,
    "out of range": _find_impossible,
    "saturated": _find_saturated,
    "glitch": _find_glitches,
}
