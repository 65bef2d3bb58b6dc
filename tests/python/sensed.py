"""Vehicles that float or fly with sensors, and what the sensors say."""

from __future__ import annotations

import numpy as np
from hooked import with_fixed_link, with_plugins
from vehicles import SKEW, plugin, vehicle

AT, RPY = (0.11, -0.07, 0.05), (0.4, -0.7, 1.1)
NOISY = {
    "imu": {"gyroNoise": 0.01, "gyroWalk": 0.1, "accelerometerNoise": 0.1, "accelerometerBias": 1},
    "gps": {"horizontalNoise": 0.5, "verticalDrift": 2, "velocityNoise": 0.1, "rate": 100},
    "odometry": {"positionNoise": 0.1, "linearVelocityWalk": 0.2, "angularVelocityNoise": 0.3},
    "barometer": {"noise": 3, "drift": 20, "rate": 50},
    "magnetometer": {"noise": 1e-6, "drift": 2e-6, "driftTime": 5, "rate": 100},
}
TOPIC = {
    "imu": "imu",
    "gps": "fix",
    "odometry": "odom",
    "barometer": "pressure",
    "magnetometer": "magnetic_field",
}


def make_mounted(name, tags, mass=1.3):
    urdf = vehicle((), mass=mass, inertia=SKEW, com=(0.01, -0.02, 0.03))
    urdf = with_fixed_link(urdf, "mast", 0.05, (1e-5, 2e-5, 2.5e-5), AT, RPY)
    return with_plugins(urdf, plugin(name, tags))


def rows_of(simulation, topic, steps):
    """Every message of some steps: its stamp and its numbers."""
    rows = []
    for _ in range(steps):
        before = simulation.topic(topic)["count"]
        simulation.step()
        message = simulation.topic(topic)
        if message["count"] > before:
            rows.append([message["stamp"], *(message[f] for f in simulation.topics[topic].fields)])
    return np.array(rows)
