"""RotorPy with its controller on SE(3) and its own vehicle, the Hummingbird."""

import numpy as np
from rotorpy.controllers.quadrotor_control import SE3Control
from rotorpy.vehicles.hummingbird_params import quad_params
from rotorpy.vehicles.multirotor import Multirotor
from spiral import DURATION, derivative, judge, position, velocity

ITS_STEP = 1e-2  # s, the default of its simulator
HOVER = np.sqrt(quad_params["mass"] * 9.81 / 4 / quad_params["k_eta"])  # rad/s


def wanted(t):
    return {
        "x": np.array(position(t)),
        "x_dot": np.array(velocity(t)),
        "x_ddot": np.array(derivative(t, 2)),
        "x_dddot": np.array(derivative(t, 3)),
        "x_ddddot": np.array(derivative(t, 4)),
        "yaw": 0.0,
        "yaw_dot": 0.0,
        "yaw_ddot": 0.0,
    }


def fly(dt):
    vehicle, controller = Multirotor(quad_params), SE3Control(quad_params)
    state = {
        "x": np.array(position(0)),
        "v": np.array(velocity(0)),
        "q": np.array([0, 0, 0, 1]),
        "w": np.zeros(3),
        "wind": np.zeros(3),
        "rotor_speeds": np.full(4, HOVER),
    }
    rows = []
    for step in range(round(DURATION / dt)):
        t = step * dt
        rows.append([t, *state["x"]])
        state = vehicle.step(state, controller.update(t, state, wanted(t)), dt)
    return rows


for dt in (ITS_STEP, 1e-3):
    judge("its controller on SE(3), its Hummingbird", dt, 1, lambda dt=dt: fly(dt))
