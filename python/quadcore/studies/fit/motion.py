"""Measured and simulated motion of the horizons of a fit, as logs to watch."""

from __future__ import annotations

from typing import Dict, List, Mapping, Sequence, Tuple

import numpy as np

from ...simulation.log import Log
from .problem import Problem

MEASURED, FITTED, START = "measured", "fitted model", "initial model"


def compute_motion(problem: Problem, tried: Mapping[str, np.ndarray]) -> Dict[str, np.ndarray]:
    """Simulate all horizons of a problem with the present starts.

    Parameters
    ----------
    problem
        Horizons with corrected starts.
    tried
        Values of the parameters, by the name of the model.

    Returns
    -------
    dict of str to ndarray (rows, columns)
        Rows of `MEASURED` and of each model; empty without position and attitude. Quantities that
        are not compared are the measured ones.
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
    """Make a log of each name from the rows of several problems, in the order of time."""
    logs = []
    for name in parts[0] if parts else ():
        table = np.vstack([part[name] for part in parts if part])
        table = table[np.argsort(table[:, 0], kind="stable")]
        logs.append((name, Log(table[np.diff(table[:, 0], prepend=-np.inf) > 0], title=name)))
    return logs


def _turn(orientation: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Turn by twice the vector part of a unit quaternion, in body axes."""
    from scipy.spatial.transform import Rotation

    half = np.clip(change / 2, -1, 1)
    scalar = np.sqrt(np.clip(1 - np.sum(half**2, axis=1, keepdims=True), 0, None))
    by = np.nan_to_num(np.hstack([half, scalar]), nan=0.5)
    turned: np.ndarray = (Rotation.from_quat(orientation) * Rotation.from_quat(by)).as_quat()
    return turned
