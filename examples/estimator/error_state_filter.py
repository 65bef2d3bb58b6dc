"""An error-state Kalman filter of a vehicle's motion (Solà, arXiv:1711.02508, chapters 5 and 6).

The inertial unit, the receiver, the barometer and the magnetometer are at the origin of the frame
and aligned with its axes. World axes are x east, y north, z up.
"""

from __future__ import annotations

from typing import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

# Parts of the error state: position, velocity (world axes), rotation (frame axes), biases of the
# gyroscopes and of the accelerometers.
_P, _V, _TURN, _GYRO, _ACCELEROMETER = (slice(i, i + 3) for i in range(0, 15, 3))

_ISA = (288.15, -0.0065, 101325.0)  # K, K/m, Pa
_ISA_EXPONENT = 9.80665 / (287.05287 * 0.0065)


def _cross(v: np.ndarray) -> np.ndarray:
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


class ErrorStateFilter:
    """Integrate rates and accelerations, and correct the result with other measurements.

    Parameters
    ----------
    position, velocity : array_like (3,)
        Initial values, world axes, m, m/s.
    orientation : array_like (4,)
        Initial orientation of the frame in the world, x, y, z, w.
    deviations : sequence of 5 floats
        Initial standard deviations of each component of position (m), velocity (m/s), orientation
        (rad), gyroscope bias (rad/s) and accelerometer bias (m/s^2).
    walks : sequence of 2 floats
        Random walk of the two biases, rad/s/sqrt(s), m/s^2/sqrt(s).
    gravity, field : array_like (3,)
        Gravity (m/s^2) and magnetic field (T), world axes.

    Attributes
    ----------
    position, linear_velocity, orientation, angular_velocity : ndarray
        The estimate, in the axes of `qc.Odometry`.
    """

    def __init__(
        self,
        position: Sequence[float],
        velocity: Sequence[float],
        orientation: Sequence[float],
        deviations: Sequence[float],
        walks: Sequence[float],
        gravity: Sequence[float],
        field: Sequence[float],
    ) -> None:
        self.position = np.array(position)
        self.linear_velocity = np.array(velocity)
        self.angular_velocity = np.zeros(3)
        self._R = Rotation.from_quat(orientation)
        self._gyro, self._accelerometer = np.zeros(3), np.zeros(3)
        self._covariance = np.diag(np.repeat(np.square(deviations), 3))
        self._walks = np.repeat(np.square(walks), 3)
        self._gravity, self._field = np.array(gravity), np.array(field)

    @property
    def orientation(self) -> np.ndarray:
        """Orientation of the frame in the world, x, y, z, w."""
        return self._R.as_quat()

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of the errors of position, velocity and orientation, (9, 9)."""
        return self._covariance[:9, :9]

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviations of the error state, (15,)."""
        return np.sqrt(np.diag(self._covariance))

    def predict(
        self, rates: np.ndarray, forces: np.ndarray, variances: Sequence[float], dt: float
    ) -> None:
        """Advance by `dt` with the mean rates and specific forces, and their variances."""
        self.angular_velocity = rates - self._gyro
        force = forces - self._accelerometer
        turn = Rotation.from_rotvec(self.angular_velocity * dt)
        half_way = self._R * Rotation.from_rotvec(self.angular_velocity * dt / 2)
        self._R = self._R * turn
        R = half_way.as_matrix()  # mean orientation over dt, to second order
        acceleration = R @ force + self._gravity
        self.position = self.position + dt * (self.linear_velocity + dt / 2 * acceleration)
        self.linear_velocity = self.linear_velocity + dt * acceleration

        F = np.eye(15)
        F[_P, _V] = dt * np.eye(3)
        F[_V, _TURN] = -dt * R @ _cross(force)
        F[_V, _ACCELEROMETER] = -dt * R
        F[_TURN, _TURN] = turn.as_matrix().T
        F[_TURN, _GYRO] = -dt * np.eye(3)
        noise = np.zeros(15)
        noise[_V] = variances[1] * dt * dt
        noise[_TURN] = variances[0] * dt * dt
        noise[9:] = self._walks * dt
        self._covariance = F @ self._covariance @ F.T + np.diag(noise)

    def correct_place(self, place: np.ndarray, variances: Sequence[float]) -> None:
        """Correct with a position (m) and its variances (m^2)."""
        H = np.zeros((3, 15))
        H[:, _P] = np.eye(3)
        self._correct(place - self.position, H, variances)

    def correct_velocity(self, velocity: np.ndarray, variance: float) -> None:
        """Correct with a velocity in world axes (m/s) and its variance."""
        H = np.zeros((3, 15))
        H[:, _V] = np.eye(3)
        self._correct(velocity - self.linear_velocity, H, [variance] * 3)

    def correct_pressure(self, pressure: float, variance: float) -> None:
        """Correct with a pressure of the standard atmosphere (Pa) and its variance."""
        temperature, gradient, ground = _ISA
        warmth = 1 + gradient * self.position[2] / temperature
        expected = ground * warmth**_ISA_EXPONENT
        H = np.zeros((1, 15))
        H[0, 2] = expected * _ISA_EXPONENT * gradient / (temperature * warmth)
        self._correct(np.array([pressure - expected]), H, [variance])

    def correct_field(self, field: np.ndarray, variance: float) -> None:
        """Correct with a magnetic field in frame axes (T) and its variance."""
        expected = self._R.inv().apply(self._field)
        H = np.zeros((3, 15))
        H[:, _TURN] = _cross(expected)
        self._correct(field - expected, H, [variance] * 3)

    def _correct(self, innovation: np.ndarray, H: np.ndarray, variances: Sequence[float]) -> None:
        noise = np.diag(variances)
        gain = np.linalg.solve(H @ self._covariance @ H.T + noise, H @ self._covariance).T
        error = gain @ innovation
        rest = np.eye(15) - gain @ H
        self._covariance = rest @ self._covariance @ rest.T + gain @ noise @ gain.T
        self.position = self.position + error[_P]
        self.linear_velocity = self.linear_velocity + error[_V]
        self._R = self._R * Rotation.from_rotvec(error[_TURN])
        self._gyro = self._gyro + error[_GYRO]
        self._accelerometer = self._accelerometer + error[_ACCELEROMETER]
