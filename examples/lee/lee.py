"""Lee's geometric controller on SE(3), the group of positions and attitudes.

T. Lee, M. Leok, N. H. McClamroch, "Geometric tracking control of a quadrotor UAV on SE(3)", CDC
2010, equations (10), (11), (15) and (16), with gains per unit of mass and inertia, and without the
angular acceleration of the desired attitude.
"""

from __future__ import annotations

import numpy as np


class Lee:
    """The controller; gains in 1/s^2 (kx, kr, kr_yaw) and 1/s (kv, kw, kw_yaw)."""

    rate = 1000.0

    def __init__(self, kx=6.0, kv=4.0, kr=80.0, kw=16.0, kr_yaw=2.0, kw_yaw=3.0):
        self.kx, self.kv = kx, kv
        self.kr, self.kw, self.kr_yaw, self.kw_yaw = kr, kw, kr_yaw, kw_yaw

    def reset(self, sim):
        """Take the description of the vehicle."""
        self._vehicle = sim.vehicle
        self._to_squares = np.linalg.pinv(sim.vehicle.allocation)

    def __call__(self, t, state, reference):
        """Return the rotor speeds, rad/s."""
        vehicle = self._vehicle
        force = vehicle.mass * (
            self.kx * (reference.position - state.position)
            + self.kv * (reference.velocity - state.linear_velocity)
            + reference.acceleration
            - vehicle.gravity
        )  # N, world axes
        R = rotate(state.orientation)
        R_d = find_attitude(force, reference.yaw)
        w_d = find_rates(R_d, force / vehicle.mass, reference.jerk, reference.yaw_rate)
        E = R_d.T @ R
        error = 0.5 * np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])
        w = state.angular_velocity
        turn = -np.array([self.kr, self.kr, self.kr_yaw]) * error - np.array(
            [self.kw, self.kw, self.kw_yaw]
        ) * (w - E.T @ w_d)
        torque = vehicle.inertia @ turn + np.cross(w, vehicle.inertia @ w)
        squares = self._to_squares @ [force @ R[:, 2], *torque]
        limits = vehicle.min_speeds, vehicle.max_speeds
        return vehicle.spins * np.clip(np.sqrt(np.maximum(squares, 0)), *limits)


def rotate(q):
    """Return the rotation matrix of a unit quaternion x, y, z, w."""
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def find_attitude(force, yaw):
    """Return the attitude whose z axis points along the force, with a heading."""
    z = force / np.linalg.norm(force)
    y = np.cross(z, [np.cos(yaw), np.sin(yaw), 0])
    y /= np.linalg.norm(y)
    return np.column_stack([np.cross(y, z), y, z])


def find_rates(R_d, specific_force, jerk, yaw_rate):
    """Return the rates of the desired attitude, in its axes, for a jerk of the reference."""
    turn = R_d.T @ jerk / np.linalg.norm(specific_force)
    return np.array([-turn[1], turn[0], yaw_rate * R_d[2, 2]])
