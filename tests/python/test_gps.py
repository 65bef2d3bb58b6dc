"""libgps_plugin.so: where on Earth, and with which errors."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation
from sensed import AT, make_mounted
from vehicles import start


def test_a_receiver_tells_where_on_earth_its_antenna_is(hangar):
    tags = {"link": "mast", "latitude": 44.5, "longitude": 179.99999, "altitude": 54}
    simulation = hangar(make_mounted("gps", tags), spawn=(0, 0, 0, 0.3, 0.2, 0.1), engine="eigen")
    start(
        simulation,
        position=(120, -340, 25),
        linear_velocity=(1, 2, 3),
        angular_velocity=(0.1, -0.2, 0.3),
    )
    fix = simulation.topic("fix")
    R_WF = Rotation.from_quat(simulation.state.orientation.copy())
    place = np.array([120, -340, 25]) + R_WF.apply(AT)
    velocity = np.array([1, 2, 3]) + R_WF.apply(np.cross([0.1, -0.2, 0.3], AT))
    assert np.allclose([fix[axis] for axis in "xyz"], place, rtol=0, atol=1e-13)
    assert np.allclose([fix["v" + axis] for axis in "xyz"], velocity, rtol=0, atol=1e-14)
    # Back by way of the ellipsoid's cartesian coordinates.
    a, e2 = 6378137.0, 6.69437999014e-3

    def cartesian(latitude, longitude, altitude):
        phi, lam = np.radians([latitude, longitude])
        N = a / math.sqrt(1 - e2 * math.sin(phi) ** 2)
        level = (N + altitude) * math.cos(phi)
        return np.array(
            [
                level * math.cos(lam),
                level * math.sin(lam),
                (N * (1 - e2) + altitude) * math.sin(phi),
            ]
        )

    phi, lam = np.radians([44.5, 179.99999])
    east = np.array([-math.sin(lam), math.cos(lam), 0])
    up = np.array([math.cos(phi) * math.cos(lam), math.cos(phi) * math.sin(lam), math.sin(phi)])
    there = cartesian(fix["latitude"], fix["longitude"], fix["altitude"])
    away = there - cartesian(44.5, 179.99999, 54)
    back = [away @ east, away @ np.cross(up, east), away @ up]
    assert -180 <= fix["longitude"] <= 180
    assert np.allclose(back, place, rtol=0, atol=0.05)  # the Earth is round


def test_errors_of_a_receiver_have_their_deviations(hangar):
    def errors(seconds, **tags):
        simulation = hangar(make_mounted("gps", {"rate": 10, **tags}), engine="eigen", dt=0.1)
        fix = simulation.run(seconds, topics=["fix"]).topics["fix"]
        return np.column_stack([fix[f] for f in ("x", "y", "z", "vx", "vy", "vz")])

    noise = errors(4000, horizontalNoise=2, verticalNoise=3, velocityNoise=0.1)
    assert np.allclose(noise.std(axis=0), [2, 2, 3, 0.1, 0.1, 0.1], rtol=3 / math.sqrt(80000))
    drift = errors(20000, horizontalDrift=2, verticalDrift=3, driftTime=5)[:, :3]
    assert np.allclose(drift.std(axis=0), [2, 2, 3], rtol=3 * math.sqrt(5 / 20000))
    for lag in (1, 50):
        correlation = np.mean(drift[lag:] * drift[:-lag], axis=0) / drift.var(axis=0)
        assert np.allclose(correlation, math.exp(-lag / 50), rtol=0, atol=0.08)
