"""Estimate of the step response of a closed loop from a flight.

As in PX4's Flight Review, the motion along one axis is modelled as the motion of the reference,
filtered by an impulse response; its sum is the step response. Least squares over the whole flight,
with a small ridge, give the impulse response without the bias of a window.
"""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..simulation.log import Log

SPAN = 4.0
"""Length of the response, s."""

_RATE = 20.0  # 1/s; sampling rate
_BAND = 0.5  # Hz; the reference must excite frequencies below
_QUIET = 1e-4  # relative to the peak of the spectrum: no excitation
_RIDGE = 1e-6  # relative to the mean square of the input


def step_response(log: Log) -> Optional[np.ndarray]:
    """Estimate the response along the axis of maximum motion of the reference.

    Returns
    -------
    ndarray, shape (rows, 2), or None
        Time (s) and response (1 is ideal); None if the flight is too short or the reference excites
        too few frequencies.
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
    # Before the flight, the reference is assumed to move as at its start.
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
    """Whether a motion excites all frequencies of the band."""
    if not np.any(given):
        return False
    power = np.abs(np.fft.rfft((given - given.mean()) * np.hanning(len(given)))) ** 2
    band = np.fft.rfftfreq(len(given), 1 / _RATE) <= _BAND
    return bool(np.mean(power[band] > _QUIET * power.max()) > 0.9)
