"""Lags of the topics of a recording relative to its pose."""

from __future__ import annotations

from typing import Dict, Optional

import numpy as np

from ...formats.recordings import Recording
from ...formats.recordings.recording import interpolate_orientation
from ...formats.recordings.series import Series
from .smoothing import fit_locally

_STEP = 2e-3  # s; resolution of the search
_MOST = 0.15  # s; larger lags are not searched
_REACH = 0.04  # s; half-width of the polynomials for differentiation
_BLOCK = 0.5
"""Duration of a block of samples with correlated errors, s."""
_CERTAIN = 0.999
"""Confidence level at which the axes of pose and IMU count as different."""
_SMALLEST = np.radians(0.3)
"""Minimum rotation that is corrected, rad; smaller ones may be errors of lags and smoothing."""
_GRAVITY = np.array([0, 0, 9.81])


def find_lags(recording: Recording) -> Dict[str, float]:
    """Find the lags of velocity, rates and acceleration relative to the pose, s.

    The derivative of the pose is the reference. The lag maximises the correlation; a parabola
    interpolates between samples.

    Returns
    -------
    dict of str to float
        Lag of each topic that has a reference; positive if the topic is late.
    """
    given = recording.quantities
    references: Dict[str, Series] = {}
    if "position" in given:
        references["velocity"] = _differentiate(given["position"])
    if "orientation" in given:
        references["rates"] = compute_rates(given["orientation"])
    if "position" in given and "orientation" in given:
        references["acceleration"] = _compute_force(references["velocity"], given["orientation"])
    lags: Dict[str, float] = {}
    for name, reference in references.items():
        if name in given:
            lag = _find_lag(reference, given[name])
            if lag is not None:
                lags[name] = lag
    return lags


def find_mount(recording: Recording) -> Optional[np.ndarray]:
    """Find the rotation between the body axes of the pose and those of the IMU.

    The specific force and the rates are measured by the IMU and also derived from the pose, so they
    are known in both axes. The rotation between the axes solves Wahba's problem (W. Kabsch, Acta
    Crystallographica A32, 1976), with the force scaled by gravity and the rates by their RMS.
    Hotelling's test decides whether the rotation differs from zero. Its covariance comes from a
    sandwich estimator with blocks of 0.5 s as clusters, because the errors of neighbouring samples
    are correlated.

    Returns
    -------
    ndarray (4,) or None
        Quaternion x, y, z, w. None without an IMU or a pose, or if the rotation is not significant.
    """
    from scipy.spatial.transform import Rotation

    given = recording.quantities
    if not {"position", "orientation", "rates", "acceleration"} <= set(given):
        return None
    pairs = (
        (_compute_force(_differentiate(given["position"]), given["orientation"]), "acceleration"),
        (compute_rates(given["orientation"]), "rates"),
    )
    ours, theirs, blocks = [], [], []
    for reference, name in pairs:
        topic = given[name]
        inside = (reference.time > topic.time[0]) & (reference.time < topic.time[-1])
        one = reference.values[inside]
        other = _interpolate(topic, reference.time[inside])
        apart = np.linalg.norm(one - other, axis=1)
        kept = apart < 2 * np.median(apart)
        size = 9.81 if name == "acceleration" else np.sqrt(np.mean(np.sum(other**2, axis=1)))
        ours.append(one[kept] / size)
        theirs.append(other[kept] / size)
        blocks.append(reference.time[inside][kept] // _BLOCK)
    a, b, block = np.vstack(ours), np.vstack(theirs), np.concatenate(blocks)
    turn, _ = Rotation.align_vectors(a, b)
    is_turned = _is_significant(turn.as_rotvec(), a, turn.apply(b), block)
    return np.asarray(turn.as_quat()) if is_turned else None


def _is_significant(
    turn: np.ndarray, ours: np.ndarray, turned: np.ndarray, block: np.ndarray
) -> bool:
    """Test whether the rotation between two sets of directions differs from zero.

    Parameters
    ----------
    turn : ndarray (3,)
        Rotation vector that best aligns the sets, rad.
    ours, turned : ndarray (n, 3)
        Vectors of the first set, and rotated vectors of the second set.
    block : ndarray (n,)
        Block index of each vector.
    """
    from scipy.special import fdtri  # scipy.stats is slow to import

    if np.linalg.norm(turn) < _SMALLEST:
        return False
    numbers, place = np.unique(block, return_inverse=True)
    count = len(numbers)
    if count <= 3:
        return False
    # A small additional rotation p moves `turned` by p x turned; its gradient is turned x error.
    normal = np.sum(turned**2) * np.eye(3) - turned.T @ turned
    scores = np.zeros((count, 3))
    np.add.at(scores, place, np.cross(turned, ours - turned))
    scale = count / (count - 1)
    size = turn @ normal @ np.linalg.solve(scale * scores.T @ scores, normal @ turn)
    limit = 3 * (count - 1) / (count - 3) * fdtri(3, count - 3, _CERTAIN)
    return bool(size > limit)


def turn_pose(recording: Recording, mount: np.ndarray) -> Recording:
    """Rotate the body axes of the pose to those of the IMU."""
    from scipy.spatial.transform import Rotation

    series = recording.quantities["orientation"]
    turned = Rotation.from_quat(series.values) * Rotation.from_quat(mount)
    quantities = {**recording.quantities, "orientation": Series(series.time, turned.as_quat())}
    return recording._replace(quantities=quantities)


def shift_topics(recording: Recording, lags: Dict[str, float]) -> Recording:
    """Shift topics to the time base of the pose."""
    quantities = {
        name: Series(series.time - lags.get(name, 0.0), series.values)
        for name, series in recording.quantities.items()
    }
    return recording._replace(quantities=quantities)


def compute_rates(orientation: Series) -> Series:
    """Return the angular velocity in body axes from local polynomials through the orientation.

    The rates are the vector part of 2 q* dq/dt.
    """
    time = orientation.time
    aligned = interpolate_orientation(orientation, time)
    q, slope = fit_locally(time, aligned, time, _REACH)
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    x, y, z, w = q.T
    dx, dy, dz, dw = slope.T
    rates = 2 * np.column_stack(
        [
            w * dx - x * dw + z * dy - y * dz,
            w * dy - y * dw + x * dz - z * dx,
            w * dz - z * dw + y * dx - x * dy,
        ]
    )
    return Series(time, rates)


def _differentiate(series: Series) -> Series:
    return Series(series.time, fit_locally(series.time, series.values, series.time, _REACH)[1])


def _compute_force(velocity: Series, orientation: Series) -> Series:
    """Return the specific force in body axes, m/s^2."""
    from scipy.spatial.transform import Rotation

    turned = Rotation.from_quat(interpolate_orientation(orientation, velocity.time)).inv()
    return Series(velocity.time, turned.apply(_differentiate(velocity).values + _GRAVITY))


def _find_lag(reference: Series, topic: Series) -> Optional[float]:
    begin, end = (
        max(reference.time[0], topic.time[0]) + _MOST,
        min(reference.time[-1], topic.time[-1]) - _MOST,
    )
    if end - begin < 10 * _MOST:
        return None
    grid = np.arange(begin, end, _STEP)
    one = _interpolate(reference, grid)
    most = round(_MOST / _STEP)
    wide = np.arange(begin - _MOST, end + _MOST, _STEP)
    other = _interpolate(topic, wide)
    centre = np.median(one, axis=0)
    limit = 6 * np.median(np.abs(one - centre), axis=0) + 1e-9
    # Glitches would dominate. Both signals are clipped, because clipping one shifts the maximum.
    one, other = (np.clip(each - centre, -limit, limit) for each in (one, other))
    one = one - one.mean(axis=0)
    scores = np.array([_correlate(one, other[k : k + len(one)]) for k in range(2 * most + 1)])
    best = int(scores.argmax())
    if best in (0, len(scores) - 1):
        return None
    before, peak, after = scores[best - 1 : best + 2]
    bend = before - 2 * peak + after
    between = 0.5 * (before - after) / bend if bend < 0 else 0.0
    return float((best + between - most) * _STEP)


def _interpolate(series: Series, time: np.ndarray) -> np.ndarray:
    return np.column_stack([np.interp(time, series.time, column) for column in series.values.T])


def _correlate(one: np.ndarray, other: np.ndarray) -> float:
    other = other[: len(one)] - other[: len(one)].mean(axis=0)
    size = np.linalg.norm(one[: len(other)], axis=0) * np.linalg.norm(other, axis=0)
    size = np.where(size > 0, size, 1)
    return float(np.sum(np.sum(one[: len(other)] * other, axis=0) / size))
