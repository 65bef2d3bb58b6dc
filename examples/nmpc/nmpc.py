"""Nonlinear model predictive control by Gauss-Newton, which looks ahead on the reference."""

from __future__ import annotations

from typing import Any, List, Tuple

import numpy as np
from scipy.spatial.transform import Rotation

import quadcore as qc

_UP = np.array([0.0, 0.0, 1.0])


class NMPC:
    """Track a reference with predicted thrust and body rates.

    The model is a rigid body with specific thrust f and body rates w as inputs: p' = v,
    v' = f R e3 - g e3, R' = R [w]x. Each call linearises it along the predicted motion and solves
    the resulting linear-quadratic problem by a Riccati recursion: a Gauss-Newton step on the
    squared residuals (Li, Todorov, ICINCO 2004). The first input is commanded.

    Parameters
    ----------
    horizon
        Number of predicted steps.
    step
        Length of a predicted step, s.
    steps
        Gauss-Newton steps per call.
    position, velocity, attitude
        Weights of the errors: 1/m^2, s^2/m^2, 1/rad^2.
    thrust, rates
        Weights of the inputs relative to those of the reference: s^4/m^2, s^2/rad^2.
    """

    rate = 50.0

    def __init__(
        self,
        horizon: int = 15,
        step: float = 0.05,
        steps: int = 2,
        position: float = 40.0,
        velocity: float = 4.0,
        attitude: float = 1.0,
        thrust: float = 0.02,
        rates: float = 0.1,
    ) -> None:
        self.horizon, self.step, self.steps = horizon, step, steps
        self._state_weight = np.diag([*[position] * 3, *[velocity] * 3, *[attitude] * 3])
        self._input_weight = np.diag([thrust, *[rates] * 3])

    def reset(self, simulation: Any) -> None:
        """Take mass and gravity from the vehicle."""
        self._mass, self._gravity = simulation.mass, simulation.gravity

    def __call__(self, t: float, state: qc.Odometry, reference: Any) -> qc.RatesThrust:
        """Return thrust and rates for the next period."""
        ahead = reference.at(t + self.step * np.arange(self.horizon + 1))
        wanted = self._make_attitudes(ahead.acceleration, ahead.yaw)
        nominal = self._make_inputs(ahead.acceleration, wanted)
        inputs = nominal.copy()
        start = state.position, state.linear_velocity, Rotation.from_quat(state.orientation.copy())
        for _ in range(self.steps):
            motion = self._predict(start, inputs)
            inputs += self._improve(motion, inputs, ahead, wanted, nominal)
        return qc.RatesThrust(inputs[0, 1:], self._mass * inputs[0, 0])

    def _make_attitudes(self, acceleration: np.ndarray, yaw: np.ndarray) -> Rotation:
        """Return the attitudes of a vehicle that accelerates so, at a yaw."""
        z = acceleration - self._gravity
        z /= np.linalg.norm(z, axis=1)[:, None]
        heading = np.column_stack([np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)])
        y = np.cross(z, heading)
        y /= np.linalg.norm(y, axis=1)[:, None]
        return Rotation.from_matrix(np.stack([np.cross(y, z), y, z], axis=2))

    def _make_inputs(self, acceleration: np.ndarray, wanted: Rotation) -> np.ndarray:
        """Return specific thrust and rates of the reference; shape (horizon, 4)."""
        thrust = np.linalg.norm(acceleration - self._gravity, axis=1)[:-1]
        rates = (wanted[:-1].inv() * wanted[1:]).as_rotvec() / self.step
        return np.column_stack([thrust, rates])

    def _predict(self, start: Tuple[Any, Any, Rotation], inputs: np.ndarray) -> List[Any]:
        """Return position, velocity and attitude at each step."""
        motion: List[Any] = [start]
        turns = Rotation.from_rotvec(self.step * inputs[:, 1:])
        for thrust, turn in zip(inputs[:, 0], turns):
            p, v, attitude = motion[-1]
            a = thrust * attitude.apply(_UP) + self._gravity
            motion.append(
                (p + self.step * v + self.step**2 / 2 * a, v + self.step * a, attitude * turn)
            )
        return motion

    def _improve(
        self,
        motion: List[Any],
        inputs: np.ndarray,
        ahead: Any,
        wanted: Rotation,
        nominal: np.ndarray,
    ) -> np.ndarray:
        """Return the change of the inputs that solves the linearised problem."""
        q, r = self._state_weight, self._input_weight
        attitudes = Rotation.concatenate([attitude for _, _, attitude in motion])
        errors = np.column_stack(
            [
                np.array([p for p, _, _ in motion]) - ahead.position,
                np.array([v for _, v, _ in motion]) - ahead.velocity,
                (wanted.inv() * attitudes).as_rotvec(),
            ]
        )
        matrices = attitudes.as_matrix()
        turns = Rotation.from_rotvec(-self.step * inputs[:, 1:]).as_matrix()
        value, slope = q, q @ errors[-1]
        gains = []
        for k in reversed(range(self.horizon)):
            a, b = self._linearise(matrices[k], inputs[k, 0], turns[k])
            curvature = r + b.T @ value @ b
            change = r @ (inputs[k] - nominal[k]) + b.T @ slope
            solved = np.linalg.solve(curvature, np.column_stack([b.T @ value @ a, change]))
            gain, offset = solved[:, :9], solved[:, 9]
            gains.append((gain, offset, a, b))
            closed = a - b @ gain
            slope = q @ errors[k] + closed.T @ slope - gain.T @ (r @ (inputs[k] - nominal[k]))
            value = q + a.T @ value @ closed
        changes, deviation = [], np.zeros(9)
        for gain, offset, a, b in reversed(gains):
            changes.append(-offset - gain @ deviation)
            deviation = a @ deviation + b @ changes[-1]
        return np.array(changes)

    def _linearise(
        self, matrix: np.ndarray, thrust: float, turn: np.ndarray
    ) -> Tuple[np.ndarray, np.ndarray]:
        """Return how deviations of state and input change the next state."""
        h, one = self.step, np.eye(3)
        tilt = thrust * np.column_stack([-matrix[:, 1], matrix[:, 0], np.zeros(3)])
        a, b = np.eye(9), np.zeros((9, 4))
        a[:3, 3:6], a[:3, 6:], a[3:6, 6:], a[6:, 6:] = h * one, h**2 / 2 * tilt, h * tilt, turn
        b[:3, 0], b[3:6, 0], b[6:, 1:] = h**2 / 2 * matrix[:, 2], h * matrix[:, 2], h * one
        return a, b
