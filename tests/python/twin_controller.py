"""The geometric controller written again, in numpy, for the shipped quadrotor at its own numbers.

Nothing is taken from the core: masses and coefficients stand in the URDF, and rates and
accelerations of the attitude are derivatives by complex steps.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

M = 1.04
UPRIGHT = np.array([0, 0, 1.0])
UP = 9.8 * UPRIGHT
HEIGHT = 0.016826923076923
PLACES = np.array([[0.2, 0, HEIGHT], [0, -0.2, HEIGHT], [-0.2, 0, HEIGHT], [0, 0.2, HEIGHT]])
C = 0.04 * np.array([0, 0, HEIGHT]) / M
K, B = 1.1487e-5, 2.69e-7
DRAG, PARASITIC = 0.0175, 0.003
SPINS = np.array([1, -1, 1, -1])
MOMENT, LAG, LEAD = 2.8125e-5, 2.8125e-5 / 5e-4, 0.01
KP, KI, KD = (np.array(g) for g in ([9, 9, 16.0], [6, 6, 12.0], [5.4, 5.4, 8]))
KR, KW = np.array([300, 300, 3.0]), np.array([30, 30, 3.0])
LIMIT = 3.0


def inertia():
    total = np.diag([0.0068229166666667, 0.0068229166666667, 0.0135416666666667])
    total += 1.0 * (C @ C * np.eye(3) - np.outer(C, C))
    for place in PLACES:
        r = place - C
        total += np.diag([1.40625e-5, 1.40625e-5, MOMENT])
        total += 0.01 * (r @ r * np.eye(3) - np.outer(r, r))
    return total


INERTIA = inertia()
# Thrust along z and torques about the centre of mass per squared speed.
EFFECT = np.array(
    [[K, *(np.cross(p - C, [0, 0, K]) + s * B * UPRIGHT)] for p, s in zip(PLACES, SPINS)]
).T


def attitude(f, yaw):
    z = f / np.sqrt(f @ f)
    y = np.cross(z, np.cross([-np.sin(yaw), np.cos(yaw), 0 * yaw], z))
    y = y / np.sqrt(y @ y)
    return np.stack([np.cross(y, z), y, z], axis=1)


def flat(reference):
    """Attitude, angular velocity and acceleration that the reference asks for.

    And the acceleration of the centre of mass beside the frame's; its own jerk and snap are those
    of a rotation whose angular acceleration stays as it is.
    """
    given = [getattr(reference, name) for name in ("velocity", "acceleration", "jerk", "snap")]
    beside = np.zeros((4, 3))
    for _ in range(5):
        R, w, dw = turn_reference(reference, *(np.array(given) + beside))
        S, dS = skew(w), skew(dw)
        second = S @ S + dS
        third = S @ second + dS @ S + S @ dS
        fourth = S @ third + dS @ second + S @ (dS @ S + S @ dS) + 2 * dS @ dS
        beside = np.array([R @ turned @ C for turned in (S, second, third, fourth)])
    return R, w, dw, beside[1]


def skew(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def turn_reference(reference, v, a, j, s, step=1e-30):
    """The same for a centre of mass with these derivatives."""
    d = 4 * DRAG

    def rate(f, df, yaw, yaw_rate):
        # R' by the direction of the complex step: f and yaw may be complex themselves.
        h = 1e-3
        forward = attitude(f + h * df, yaw + h * yaw_rate)
        back = attitude(f - h * df, yaw - h * yaw_rate)
        far_forward = attitude(f + 2 * h * df, yaw + 2 * h * yaw_rate)
        far_back = attitude(f - 2 * h * df, yaw - 2 * h * yaw_rate)
        dR = (8 * (forward - back) - (far_forward - far_back)) / (12 * h)
        S = attitude(f, yaw).T @ dR
        return np.array([S[2, 1], S[0, 2], S[1, 0]])

    f = M * (a + UP) + d * v
    df, ddf = M * j + d * a, M * s + d * j
    w = rate(f, df, reference.yaw, reference.yaw_rate)
    ahead = rate(
        f + 1j * step * df,
        df + 1j * step * ddf,
        reference.yaw + 1j * step * reference.yaw_rate,
        reference.yaw_rate + 1j * step * reference.yaw_acceleration,
    )
    return attitude(f, reference.yaw), w.real, ahead.imag / step


class Twin:
    """Flies as quadcore.controllers.geometric() does."""

    rate = 500

    def reset(self, simulation):
        self.integral = np.zeros(3)
        self.speeds = None

    def __call__(self, t, state, reference):
        R = Rotation.from_quat(state.orientation).as_matrix()
        v, w = state.linear_velocity, state.angular_velocity
        error = reference.position - state.position
        self.integral = self.integral + error / self.rate
        R_D, w_D, dw_D, beside = flat(reference)
        a = KP * error + KD * (reference.velocity - v) + reference.acceleration + beside
        a = a + KI * self.integral
        assert np.all(np.abs(KI * self.integral) < LIMIT)

        v_F = R.T @ v
        of_mass_F = v_F + np.cross(w, C)
        climb = (R @ of_mass_F)[2]
        vertical = 4 * PARASITIC * abs(climb) * climb
        drag = -(R @ np.array([4 * DRAG * of_mass_F[0], 4 * DRAG * of_mass_F[1], vertical]))
        f = M * (a + UP) - drag
        q = Rotation.from_matrix(R.T @ attitude(f, reference.yaw)).as_quat()
        tilt = 2 * np.sign(q[3]) * q[:3]
        turn = R.T @ R_D
        dw = KR * tilt + KW * (turn @ w_D - w) + turn @ dw_D - np.cross(w, turn @ w_D)

        moment = np.zeros(3)  # of the air
        for place in PLACES:
            V = v_F + np.cross(w, place)
            moment += np.cross(place - C, -DRAG * np.array([V[0], V[1], 0]))
        rates = np.zeros(4) if self.speeds is None else SPINS * self.speeds
        h = MOMENT * np.array([0, 0, rates.sum()])
        torque = INERTIA @ dw + np.cross(w, INERTIA @ w + h) - moment
        squares = np.linalg.solve(EFFECT, [f @ R[:, 2], *torque])
        wanted = np.sqrt(squares)
        if self.speeds is None:
            self.speeds = wanted
        share, lead = (1 - np.exp(-1 / self.rate / lag) for lag in (LAG, LEAD))
        command = self.speeds + lead / share * (wanted - self.speeds)
        self.speeds = self.speeds + share * (command - self.speeds)
        return SPINS * command
