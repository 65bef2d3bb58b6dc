"""Run the geometric controller on an estimate from inertial and other sensors."""

from __future__ import annotations

from typing import Any, Dict, Optional

import numpy as np
from error_state_filter import ErrorStateFilter

import quadcore as qc

# Modelled deviations of the sensors; the variances of white noise are in their messages.
_AT_START = (0.1, 0.1, 0.02, 5e-3, 0.05)  # m, m/s, rad, rad/s, m/s^2
_WALKS = (1e-5, 1e-4)  # rad/s/sqrt(s), m/s^2/sqrt(s)


class Geometric:
    """Use the odometry only for the initial state, and the estimate afterwards."""

    rate = 250.0  # at least the rate of the inertial unit, so that no message is missed

    def reset(self, simulation: Any) -> None:
        """Prepare for a flight of this vehicle."""
        for topic, plugin in (("imu", "imu"), ("fix", "gps")):
            if topic not in simulation.topics:
                raise qc.InputError(
                    f"the estimate requires topic '{topic}'. Add lib{plugin}_plugin.so, or use "
                    "--scenario sensors.yaml."
                )
        self._controller = qc.controllers.parse("geometric", simulation.model.name)
        self._controller.rate = self.rate
        self._controller.reset(simulation)
        self._world = simulation.world
        self._topics = [name for name in _CORRECTIONS if name in simulation.topics]
        self._seen: Dict[str, float] = {}
        self._time = 0.0
        self.estimate: Optional[ErrorStateFilter] = None

    def __call__(self, t: float, state: qc.Odometry, reference: Any) -> np.ndarray:
        """Return the rotor speeds, rad/s."""
        if self.estimate is None:
            self.estimate = ErrorStateFilter(
                state.position, state.linear_velocity, state.orientation, _AT_START,
                _WALKS, self._world.gravity, self._world.magnetic_field,
            )  # fmt: skip
            self.estimate.angular_velocity = state.angular_velocity
            self._time = t
            self._seen = {name: state.topic(name)["count"] for name in self._topics}
        for name in self._topics:
            message = state.topic(name)
            new = message["count"] - self._seen[name]
            if new > 1:
                raise qc.InputError(
                    f"{new:g} messages on '{name}' since the last call; "
                    "increase the controller's rate to at least theirs"
                )
            if new:
                _CORRECTIONS[name](self, message)
                self._seen[name] = message["count"]
        return self._controller(t, self.estimate, reference)

    def _take_imu(self, message: Dict[str, float]) -> None:
        self.estimate.predict(
            _vector(message, "wx", "wy", "wz"), _vector(message, "ax", "ay", "az"),
            (message["angular_velocity_variance"], message["specific_force_variance"]),
            message["stamp"] - self._time,
        )  # fmt: skip
        self._time = message["stamp"]

    def _take_fix(self, message: Dict[str, float]) -> None:
        level, height = message["horizontal_variance"], message["vertical_variance"]
        self.estimate.correct_place(_vector(message, "x", "y", "z"), (level, level, height))
        velocity = _vector(message, "vx", "vy", "vz")
        self.estimate.correct_velocity(velocity, message["velocity_variance"])

    def _take_pressure(self, message: Dict[str, float]) -> None:
        self.estimate.correct_pressure(message["pressure"], message["variance"])

    def _take_field(self, message: Dict[str, float]) -> None:
        self.estimate.correct_field(_vector(message, "x", "y", "z"), message["variance"])


# By topic, in the order of use at one time: the inertial unit comes first.
_CORRECTIONS = {
    "imu": Geometric._take_imu,
    "fix": Geometric._take_fix,
    "pressure": Geometric._take_pressure,
    "magnetic_field": Geometric._take_field,
}


def _vector(message: Dict[str, float], *fields: str) -> np.ndarray:
    return np.array([message[field] for field in fields])
