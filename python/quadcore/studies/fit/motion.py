"""Measured and simulated motion of the horizons of a fit, as logs for an animation."""

from __future__ import annotations

from typing import Dict, List, Mapping, Sequence, Tuple

import numpy as np

from ...simulation.log import Log
from .problem import Problem

MEASURED, FITTED, START = "measured", "fitted model", "initial model"


def compute_motion(problem: Problem, tried: Mapping[str, np.ndarray]) -> Dict[str, np.ndarray]:
    """Simulate all horizons of a problem from their current initial states.

    Parameters
    ----------
    problem
        Horizons with corrected initial states.
    tried
        Parameter values by name of the model.

    Returns
    -------
    dict of str to ndarray (rows, columns)
        Rows of `MEASURED` and of each model; empty without position and attitude. Channels that are
        not compared contain the measured values.
    """
    horizons = problem.horizons
    if not {"position", "attitude"} <= set(horizons.channels):
        return {}
    rows, record = horizons.rows.ravel(), horizons.record
    parts = {
        "position": record.position[rows],
        "attitude": record.orientation[rows],
        "velocity": record.velocity[rows],
        "rates": record.rates[rows],
        "rotors": record.rotors[rows],
    }
    time = record.time[rows, None]
    found = {MEASURED: np.hstack([time, *parts.values()])}
    for name, values in tried.items():
        left = problem.compare(values).reshape(len(rows), -1)
        moved, column = dict(parts), 0
        for channel, size in zip(horizons.channels, horizons.sizes):
            change = left[:, column : column + size]
            turns = channel == "attitude"
            moved[channel] = _turn(parts[channel], change) if turns else parts[channel] + change
            column += size
        found[name] = np.hstack([time, *moved.values()])
    return found


def join_motion(parts: Sequence[Mapping[str, np.ndarray]]) -> List[Tuple[str, Log]]:
    """Join the rows of several problems into one log per name, sorted by time."""
    logs = []
    for name in parts[0] if parts else ():
        table = np.vstack([part[name] for part in parts if part])
        table = table[np.argsort(table[:, 0], kind="stable")]
        logs.append((name, Log(table[np.diff(table[:, 0], prepend=-np.inf) > 0], title=name)))
    return logs


def _turn(orientation: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Rotate by twice the vector part of a unit quaternion, in body axes."""
    from scipy.spatial.transform import Rotation

    half = np.clip(change / 2, -1, 1)
    scalar = np.sqrt(np.clip(1 - np.sum(half**2, axis=1, keepdims=True), 0, None))
    by = np.nan_to_num(np.hstack([half, scalar]), nan=0.5)
    turned: np.ndarray = (Rotation.from_quat(orientation) * Rotation.from_quat(by)).as_quat()
    return turned
