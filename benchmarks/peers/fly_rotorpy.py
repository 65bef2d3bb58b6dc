"""RotorPy: rigid body, rotors with a lag; turning rotors do nothing to the frame."""

import numpy as np
from flight import judge, phases, vehicle
from rotorpy.vehicles.multirotor import Multirotor

V = vehicle()
DT = 1e-3
PARAMETERS = {
    "mass": V["mass"],
    **{
        f"I{a}{b}": V["inertia"]["xyz".index(a)]["xyz".index(b)]
        for a, b in ("xx", "yy", "zz", "xy", "xz", "yz")
    },
    "num_rotors": 4,
    "rotor_pos": {f"r{i}": np.array(place) for i, place in enumerate(V["rotors"])},
    "rotor_directions": -np.array(V["spins"]),  # of the torque on the frame
    "rotor_speed_min": 0,
    "rotor_speed_max": 1e4,
    "k_eta": V["thrust"],
    "k_m": V["torque"],
    "tau_m": V["lag"],
}


def fly(**integrator):
    quadrotor = Multirotor(PARAMETERS, aero=False, integrator_kwargs=integrator)
    state = {
        "x": np.array(V["start"]),
        "v": np.zeros(3),
        "q": np.array([0, 0, 0, 1]),
        "w": np.zeros(3),
        "wind": np.zeros(3),
        "rotor_speeds": np.zeros(4),
    }
    for speeds, count in phases(V["hover"], DT):
        control = {"cmd_motor_speeds": np.array(speeds)}
        for _ in range(count):
            state = quadrotor.step(state, control, DT)
    return state["x"]


judge("scipy RK45 (its default)", DT, 1, lambda: fly(method="RK45"), repeats=1)
