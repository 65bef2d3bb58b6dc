"""Recordings as rows of a log."""

from __future__ import annotations

from typing import List, Tuple

import numpy as np

from ..._core import InputError, log_columns
from ...support.warning import warn
from ..rows import LogRows
from .recording import Recording, interpolate_orientation
from .series import Series

_TOPICS = {
    "acceleration": ("imu", ("ax", "ay", "az")),
    "battery": ("battery", ("voltage",)),
}


def make_log_rows(recording: Recording) -> LogRows:
    """Make a row for each measured position; quantities without a column become topics.

    Quantities with other times are interpolated. Missing velocities and rates are computed from
    differences of positions and orientations.

    Raises
    ------
    InputError
        If the position or the orientation is missing, or they do not overlap in time.
    """
    given = recording.quantities
    for name in ("position", "orientation"):
        if name not in given:
            raise InputError(
                f"{recording.where}: the recording has no {name}, but only "
                f"{', '.join(given)}. Use quadcore fit, which needs none."
            )
    time = given["position"].time
    begin = max(given[name].time[0] for name in _list_state(recording))
    end = min(given[name].time[-1] for name in _list_state(recording))
    kept = (time >= begin) & (time <= end) & (np.diff(time, prepend=-np.inf) > 0)
    time, position = time[kept], given["position"].values[kept]
    if len(time) < 2:
        raise InputError(f"{recording.where}: position and orientation do not overlap in time.")
    orientation = interpolate_orientation(given["orientation"], time)
    velocity = _sample_or(recording, "velocity", time, np.gradient(position, time, axis=0))
    rates = _sample_or(recording, "rates", time, differentiate_orientation(time, orientation))
    rotors = np.empty((len(time), 0))
    if "rotors" in given:
        rotors = _interpolate(given["rotors"], time)
    rows = [time[:, None] - time[0], position, orientation, velocity, rates, rotors]
    topics, columns = _list_topics(recording, time)
    return LogRows([*log_columns(rotors.shape[1]), *columns], np.hstack([*rows, *topics]), {}, [])


def differentiate_orientation(time: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return angular velocities in body axes from unit quaternions, rad/s."""
    from scipy.spatial.transform import Rotation

    turns = Rotation.from_quat(q)
    after, before = (
        np.minimum(np.arange(len(q)) + 1, len(q) - 1),
        np.maximum(np.arange(len(q)) - 1, 0),
    )
    vectors = (turns[before].inv() * turns[after]).as_rotvec()
    rates: np.ndarray = vectors / (time[after] - time[before])[:, None]
    return rates


def _list_state(recording: Recording) -> List[str]:
    return [
        name
        for name in ("position", "orientation", "velocity", "rates", "rotors")
        if name in recording.quantities
    ]


def _sample_or(
    recording: Recording, name: str, time: np.ndarray, fallback: np.ndarray
) -> np.ndarray:
    if name in recording.quantities:
        return _interpolate(recording.quantities[name], time)
    warn(f"{recording.where}: the recording has no {name}; they are computed from the pose.")
    return fallback


def _interpolate(series: Series, time: np.ndarray) -> np.ndarray:
    return np.column_stack([np.interp(time, series.time, column) for column in series.values.T])


def _list_topics(recording: Recording, time: np.ndarray) -> Tuple[List[np.ndarray], List[str]]:
    parts: List[np.ndarray] = []
    columns: List[str] = []
    named = dict(_TOPICS)
    if "commands" in recording.quantities:
        width = recording.quantities["commands"].values.shape[1]
        named["commands"] = ("motors", tuple(f"u{i + 1}" for i in range(width)))
    for quantity, (topic, fields) in named.items():
        if quantity not in recording.quantities:
            continue
        series = recording.quantities[quantity]
        row = np.searchsorted(series.time, time, "right") - 1
        values = np.column_stack([series.time, series.values])[np.maximum(row, 0)]
        values[:, 0] -= time[0]
        values[row < 0] = np.nan
        parts.append(values)
        columns += [f"{topic}.{field}" for field in ("stamp", *fields)]
    return parts, columns
