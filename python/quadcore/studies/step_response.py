"""The step response of a closed loop, estimated from any flight that excites it.

As PX4's Flight Review does for logged set points: the motion along one axis is taken for the
reference's motion, delayed and spread by an impulse response, whose sum is the step response. The
impulse response is that of least squares over the whole flight (with a little ridge), so that no
window falsifies it.
"""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..simulation.log import Log

SPAN = 4.0
"""Of the response, s."""

_RATE = 20.0  # 1/s, of what is fitted
_BAND = 0.5  # Hz; up to where the reference has to move
_QUIET = 1e-4  # of the spectrum's peak: what is below it tells nothing
_RIDGE = 1e-6  # of the mean square of what is fitted to


def step_response(log: Log) -> Optional[np.ndarray]:
    """Estimate the response along the axis that the reference moves most along.

    Returns
    -------
    ndarray, shape (rows, 2), or None
        Time (s) and response, which is to be 1; None for a flight that is too short or whose
        reference moves too regularly to tell.
    """
    time = np.arange(log.time[0], log.time[-1] + 1e-9, 1 / _RATE)
    taps = round(SPAN * _RATE)
    if len(time) < 2 * taps:
        return None
    wanted = np.column_stack([log.topics["reference"][axis] for axis in "xyz"])
    axis = int(np.ptp(wanted, axis=0).argmax())
    sides = (wanted[:, axis], log.position[:, axis])
    given, answer = (np.diff(np.interp(time, log.time, side)) for side in sides)
    if not _excites(given):
        return None
    # Before the flight the reference is taken to have moved as at its beginning.
    padded = np.concatenate([np.full(taps - 1, given[0]), given])
    rows = np.lib.stride_tricks.as_strided(
        padded[taps - 1 :],
        (len(given), taps),
        (padded.strides[0], -padded.strides[0]),
        writeable=False,
    )
    square = rows.T @ rows
    ridge = _RIDGE * np.trace(square) / taps
    impulse = np.linalg.solve(square + ridge * np.eye(taps), rows.T @ answer)
    return np.column_stack([np.arange(taps + 1) / _RATE, np.append(0, np.cumsum(impulse))])


def _excites(given: np.ndarray) -> bool:
    """Whether a motion has something of every frequency that is to be told."""
    if not np.any(given):
        return False
    power = np.abs(np.fft.rfft((given - given.mean()) * np.hanning(len(given)))) ** 2
    band = np.fft.rfftfreq(len(given), 1 / _RATE) <= _BAND
    return bool(np.mean(power[band] > _QUIET * power.max()) > 0.9)
