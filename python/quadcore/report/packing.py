"""Choice and packing of the numbers of a flight for the player."""

from __future__ import annotations

import base64
import math
import zlib
from typing import Any, Dict, List, Optional, Sequence

import numpy as np

_FEWEST, _MOST = 600, 8000  # rows of a flight
_POSITION, _ANGLE = 4e-4, 4e-4  # m, rad; largest error of the interpolation between rows
_BUCKETS = 500  # of a plot; each has the minimum and the maximum of its time


class Numbers:
    """Collector of numbers of single precision, which a page contains once, compressed."""

    def __init__(self) -> None:
        self._parts: List[np.ndarray] = []
        self._count = 0

    def add(self, values: Any, quantum: float = 0.0) -> Dict[str, int]:
        """Add numbers, rounded to multiples of `quantum`, and return where they lie."""
        numbers = np.asarray(values, dtype=float).ravel()
        if quantum:
            numbers = np.round(numbers / quantum) * quantum
        with np.errstate(over="ignore"):  # a vehicle may be very far away
            single = numbers.astype("<f4")
        self._parts.append(single)
        self._count += len(single)
        return {"at": self._count - len(single), "count": len(single)}

    def pack(self) -> str:
        """Return all numbers in base 64: their first bytes, then their second and so on."""
        whole = np.concatenate([np.zeros(0, "<f4"), *self._parts])
        planes = whole.view(np.uint8).reshape(-1, 4).T
        return compress(planes.tobytes())


def compress(data: bytes) -> str:
    """Compress with zlib, and write in base 64."""
    return base64.b64encode(zlib.compress(data, 9)).decode()


def choose_rows(
    time: np.ndarray, position: np.ndarray, orientation: np.ndarray, marks: Sequence[int] = ()
) -> np.ndarray:
    """Choose the rows between which the pose can be interpolated.

    Positions are interpolated linearly, orientations at constant angular velocity. The errors at
    all other rows stay below 0.4 mm (or 1e-5 of the size of the flight) and 0.4 mrad, unless this
    needs more than 8000 rows.

    Parameters
    ----------
    time : ndarray (rows,)
        Times, s.
    position : ndarray (rows, 3)
        Positions, m.
    orientation : ndarray (rows, 4)
        Unit quaternions.
    marks : sequence of int
        Rows that must be among them.

    Returns
    -------
    ndarray (n,)
        Indices of the rows in ascending order, with the first and the last.
    """
    count = len(time)
    rows = np.unique(np.linspace(0, count - 1, min(count, _FEWEST)).round().astype(int))
    rows = np.union1d(rows, np.asarray(marks, dtype=int))
    finite = position[np.isfinite(position).all(axis=1)]
    extent = float(np.ptp(finite, axis=0).max()) if len(finite) else 0.0
    tolerance = max(_POSITION, 1e-5 * extent)
    while 1 < len(rows) < min(count, _MOST):
        error = _measure_error(rows, time, position, orientation, tolerance)
        worst = np.maximum.reduceat(error, rows[:-1])
        wide = np.flatnonzero((worst > 1) & (np.diff(rows) > 1))
        if not len(wide):
            break
        wide = wide[np.argsort(-worst[wide], kind="stable")][: _MOST - len(rows)]
        rows = np.union1d(rows, (rows[wide] + rows[wide + 1]) // 2)
    return rows


def _measure_error(
    rows: np.ndarray,
    time: np.ndarray,
    position: np.ndarray,
    orientation: np.ndarray,
    tolerance: float,
) -> np.ndarray:
    """Return the error of the interpolated pose at each row of the log, 1: just tolerable."""
    segment = np.clip(
        np.searchsorted(rows, np.arange(len(time)), side="right") - 1, 0, len(rows) - 2
    )
    low, high = rows[segment], rows[segment + 1]
    with np.errstate(all="ignore"):
        share = ((time - time[low]) / (time[high] - time[low]))[:, None]
        straight = position[low] + share * (position[high] - position[low])
        apart = np.linalg.norm(position - straight, axis=1) / tolerance
        start, end = orientation[low], orientation[high]
        cosine = np.sum(start * end, axis=1, keepdims=True)
        end = np.where(cosine < 0, -end, end)
        angle = np.arccos(np.clip(np.abs(cosine), 0, 1))
        sine = np.sin(angle)
        is_small = sine < 1e-6
        before = np.where(is_small, 1 - share, np.sin((1 - share) * angle) / sine)
        after = np.where(is_small, share, np.sin(share * angle) / sine)
        between = before * start + after * end
        between /= np.linalg.norm(between, axis=1, keepdims=True)
        # The sine of half the angle between them, from the vector part of their quotient.
        chord = np.minimum(
            np.linalg.norm(between - orientation, axis=1),
            np.linalg.norm(between + orientation, axis=1),
        )
        turned = 2 * chord / _ANGLE
    return np.asarray(np.nan_to_num(np.maximum(apart, turned), nan=0.0, posinf=0.0))


def align_signs(orientation: np.ndarray) -> np.ndarray:
    """Choose the sign of each quaternion such that neighbours are close."""
    with np.errstate(all="ignore"):
        flips = np.sum(orientation[1:] * orientation[:-1], axis=1) < 0
    signs = np.where(np.cumsum(flips) % 2 == 1, -1.0, 1.0)
    return np.asarray(orientation * np.concatenate([[1.0], signs])[: len(orientation), None])


def make_plot_times(begin: float, end: float) -> np.ndarray:
    """Return the times of the points of all curves, two for each bucket."""
    edges = np.linspace(begin, end, _BUCKETS + 1)
    middles = (edges[:-1] + edges[1:]) / 2
    return np.column_stack([edges[:-1], middles]).ravel()


def pick_extremes(time: np.ndarray, values: np.ndarray, begin: float, end: float) -> np.ndarray:
    """Reduce a curve to the minimum and maximum in each bucket, in their order.

    Every n-th row would turn a fast ripple into a slow beat.

    Returns
    -------
    ndarray (2 * buckets,)
        Values at the times of `make_plot_times`; NaN where the curve has none.
    """
    span = end - begin
    bucket = np.zeros(len(time), int)
    if span > 0:
        bucket = np.clip(((time - begin) / span * _BUCKETS).astype(int), 0, _BUCKETS - 1)
    finite = np.isfinite(values)
    bucket, values = bucket[finite], values[finite]
    found = np.full((_BUCKETS, 2), np.nan)
    if not len(values):
        return found.ravel()
    starts = np.flatnonzero(np.concatenate([[True], np.diff(bucket) > 0]))
    places = bucket[starts]
    low, high = np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)
    ends = np.concatenate([starts[1:], [len(values)]]) - 1
    rises = values[ends] >= values[starts]
    found[places, 0] = np.where(rises, low, high)
    found[places, 1] = np.where(rises, high, low)
    # A slow log leaves buckets empty between its rows: the curve goes on as a straight line.
    points = make_plot_times(begin, end)
    flat = found.ravel()
    known = np.flatnonzero(np.isfinite(flat))
    inside = slice(known[0], known[-1] + 1)
    flat[inside] = np.interp(points[inside], points[known], flat[known])
    return flat


def choose_quantum(values: np.ndarray) -> float:
    """Return a power of two that is less than a ten-thousandth of the range of values."""
    finite = values[np.isfinite(values)]
    span: Optional[float] = float(np.ptp(finite)) if len(finite) else None
    return 2.0 ** np.floor(np.log2(span / 16384)) if span else 0.0


def finite_or_none(number: float) -> Optional[float]:
    """Return a number, or None for an infinite one, which JSON does not have."""
    return number if math.isfinite(number) else None
