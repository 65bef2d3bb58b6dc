"""Differences of the states of two flights."""

from __future__ import annotations

import numpy as np

from ...simulation.log import Log
from ...studies.flight_differences import DifferenceSizes, summarise_differences
from ...support.rotation import to_roll_pitch_yaw
from ..chapter2.kinematics import euler_rates_to_body

# xi, eta and their rates in m, rad, m/s and rad/s, as in the plots of chapter 6.
STATES = ("x", "y", "z", "phi", "theta", "psi", "vx", "vy", "vz", "phidot", "thetadot", "psidot")


def extract_states(log: Log) -> np.ndarray:
    """Return position, Euler angles and their rates of the frame link, in the order of STATES."""
    eta = np.unwrap(to_roll_pitch_yaw(log.orientation), axis=0)
    W = np.array([euler_rates_to_body(row) for row in eta])
    etadot = np.linalg.solve(W, log.angular_velocity[..., None])[..., 0]
    return np.hstack([log.position, eta, log.linear_velocity, etadot])


def compare_states(log: Log, reference: Log) -> DifferenceSizes:
    """Compare two logs with the same times, by state and by "distance" (m)."""
    apart = extract_states(log) - extract_states(reference)
    distance = np.linalg.norm(apart[:, :3], axis=1, keepdims=True)
    return summarise_differences(np.hstack([apart, distance]), (*STATES, "distance"))


def steepest(log: Log) -> float:
    """Return the maximum roll or pitch of a flight, rad."""
    return float(np.abs(extract_states(log)[:, 3:5]).max())
