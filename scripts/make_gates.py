#!/usr/bin/env python3
"""Write the paths through gates of the benchmark, config/benchmark/VERSION/gates_*.csv.

The times at the gates minimise the total time of the minimum-snap trajectory, within the limits of
tilt and speed. The slower paths are the same with stretched times. A published version keeps its
files: run this script only to make a new version.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

import quadcore as qc

GATES = np.array(
    [[0, 0, 10], [9, 5, 11], [18, 0, 13], [21, -9, 11], [12, -14, 10], [2, -9, 12], [0, 0, 10]]
)
"""m; the first and the last are those of start and end, at rest."""

TILT, SPEED = 60.0, 15.0  # degrees, m/s
STRETCHES = {"fast": 1.0, "medium": 1.5, "slow": 2.0}


def make_rows(spans: np.ndarray) -> np.ndarray:
    """Return rows t, x, y, z for the durations between gates."""
    return np.column_stack([np.concatenate([[0], np.cumsum(spans)]), GATES])


def measure_motion(rows: np.ndarray) -> tuple[float, float]:
    """Return maximum tilt (degrees) and speed (m/s) of a vehicle without drag."""
    wanted = qc.references.waypoints(rows).at(np.linspace(0, rows[-1, 0], 1000))
    force = wanted.acceleration + np.array([0, 0, 9.81])
    tilt = np.arctan2(np.linalg.norm(force[:, :2], axis=1), force[:, 2])
    return float(np.degrees(tilt.max())), float(np.linalg.norm(wanted.velocity, axis=1).max())


def scale_to_limits(spans: np.ndarray) -> np.ndarray:
    """Stretch durations until tilt and speed are within the limits."""
    low, high = 0.1, 10.0
    for _ in range(40):
        scale = (low * high) ** 0.5
        tilt, speed = measure_motion(make_rows(scale * spans))
        low, high = (low, scale) if tilt <= TILT and speed <= SPEED else (scale, high)
    return high * spans


def main() -> None:
    """Write the files into the folder that is named."""
    folder = Path(sys.argv[1])
    lengths = np.linalg.norm(np.diff(GATES, axis=0), axis=1)
    found = minimize(
        lambda logs: float(scale_to_limits(np.exp(logs)).sum()),
        np.log(lengths),
        method="Nelder-Mead",
        options={"maxfev": 800, "xatol": 1e-3, "fatol": 1e-3},
    )
    fastest = scale_to_limits(np.exp(found.x))
    for name, stretch in STRETCHES.items():
        rows = make_rows(stretch * fastest)
        lines = [",".join(f"{value:.4f}" for value in row) for row in rows]
        (folder / f"gates_{name}.csv").write_text("\n".join(["t,x,y,z", *lines]) + "\n")
        print(name, rows[-1, 0], *measure_motion(rows))


if __name__ == "__main__":
    main()
