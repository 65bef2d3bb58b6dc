"""Estimate of the step response of a closed loop from a flight.

As in the Flight Review of PX4, the motion along one axis is modelled as the motion of the
reference, filtered by an impulse response. The cumulative sum of the impulse response is the step
response. Least squares with a small ridge over the whole flight give the impulse response without
the bias of a window.

A reference with jumps changes exactly at a row and excites all frequencies, so it is sampled at the
rate of the log. Any other reference is sampled more coarsely and changes evenly between samples.
The sum up to sample k is then the step response half a sample later.
"""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..simulation.log import Log

SPAN = 4.0
"""Duration of the response, s."""

_RATE = 20.0  # 1/s; sampling rate of smooth references
_JUMP_RATE = 100.0  # 1/s; maximum sampling rate of references with jumps
_SUDDEN = 0.5  # relative change of the motion between rows that counts as a jump
_BAND = 0.5  # Hz; the reference must excite lower frequencies
_QUIET = 1e-4  # power relative to the peak of the spectrum below which there is no excitation
_RIDGE = 1e-6  # relative to the mean square of the input


def step_response(log: Log) -> Optional[np.ndarray]:
    """Estimate the response along the axis with the maximum motion of the reference.

    Returns
    -------
    ndarray, shape (rows, 2), or None
        Time (s) and response (1 is ideal); None if the flight is too short or the reference excites
        too few frequencies.
    """
    wanted = np.column_stack([log.topics["reference"][axis] for axis in "xyz"])
    axis = int(np.ptp(wanted, axis=0).argmax())
    jumps = _has_jumps(np.diff(wanted[:, axis]))
    rate = min(_JUMP_RATE, 1 / np.diff(log.time[:2]).min(initial=np.inf)) if jumps else _RATE
    time = np.arange(log.time[0], log.time[-1] + 1e-9, 1 / rate)
    taps = round(SPAN * rate)
    if len(time) < 2 * taps:
        return None
    sides = (wanted[:, axis], log.position[:, axis])
    given, answer = (np.diff(np.interp(time, log.time, side)) for side in sides)
    if not _excites(given, rate):
        return None
    # Before the flight, the reference is assumed to rest (with jumps) or to move as at the start.
    padded = np.concatenate([np.full(taps - 1, 0.0 if jumps else given[0]), given])
    rows = np.lib.stride_tricks.as_strided(
        padded[taps - 1 :],
        (len(given), taps),
        (padded.strides[0], -padded.strides[0]),
        writeable=False,
    )
    square = rows.T @ rows
    ridge = _RIDGE * np.trace(square) / taps
    impulse = np.linalg.solve(square + ridge * np.eye(taps), rows.T @ answer)
    after = np.arange(taps) / rate if jumps else (np.arange(taps) + 0.5) / rate
    response = np.column_stack([after, np.cumsum(impulse)])
    return response if jumps else np.vstack([np.zeros(2), response])


def _has_jumps(changes: np.ndarray) -> bool:
    """Whether the change between rows varies strongly relative to the maximum change."""
    largest = np.abs(changes).max(initial=0.0)
    return bool(np.abs(np.diff(changes)).max(initial=0.0) > _SUDDEN * largest)


def _excites(given: np.ndarray, rate: float) -> bool:
    """Whether a motion excites all frequencies in the band."""
    if not np.any(given):
        return False
    power = np.abs(np.fft.rfft((given - given.mean()) * np.hanning(len(given)))) ** 2
    band = np.fft.rfftfreq(len(given), 1 / rate) <= _BAND
    return bool(np.mean(power[band] > _QUIET * power.max()) > 0.9)
