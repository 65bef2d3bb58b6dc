"""MuJoCo with Lee's controller of examples/lee at 500 Hz, and all forces, in Python."""

import sys
from pathlib import Path
from types import SimpleNamespace

import mujoco
import numpy as np
from mujoco_model import DT, V, document
from spiral import DURATION, derivative, judge, position, velocity

sys.path.append(str(Path(__file__).parents[2] / "examples" / "lee"))
from lee import Lee

FRAME, EVERY = 1, 2  # body of the frame; steps between calls
SPINS = np.array(V["spins"])
PLACES = np.array(V["rotors"])


def controller():
    effects = V["thrust"] * np.array([np.ones(4), PLACES[:, 1], -PLACES[:, 0], np.zeros(4)])
    effects[3] = -V["torque"] * SPINS
    vehicle = SimpleNamespace(
        mass=V["mass"],
        gravity=np.array([0.0, 0.0, -V["gravity"]]),
        inertia=np.array(V["inertia"]),
        spins=SPINS,
        allocation=effects,
        min_speeds=np.zeros(4),
        max_speeds=np.full(4, 900.0),
    )
    lee = Lee()
    lee.reset(SimpleNamespace(vehicle=vehicle))
    return lee


def fly(integrator):
    model = mujoco.MjModel.from_xml_string(document(integrator))
    data = mujoco.MjData(model)
    lee = controller()
    data.qpos[:3], data.qvel[:3] = position(0), velocity(0)
    data.qvel[6:] = V["hover"] * SPINS
    rows = []
    for step in range(round(DURATION / DT)):
        t = step * DT
        if step % EVERY == 0:
            rows.append([t, *data.qpos[:3]])
            w, x, y, z = data.qpos[3:7]
            state = SimpleNamespace(
                position=data.qpos[:3],
                orientation=(x, y, z, w),
                linear_velocity=data.qvel[:3],
                angular_velocity=data.qvel[3:6],
            )
            reference = SimpleNamespace(
                position=np.array(position(t)),
                velocity=np.array(velocity(t)),
                acceleration=np.array(derivative(t, 2)),
                jerk=np.array(derivative(t, 3)),
                yaw=0.0,
                yaw_rate=0.0,
            )
            data.ctrl[:] = lee(t, state, reference)
        squares = data.qvel[6:] ** 2
        up_W = data.xmat[FRAME].reshape(3, 3)[:, 2]
        data.xfrc_applied[FRAME + 1 :, :3] = V["thrust"] * squares[:, None] * up_W
        data.xfrc_applied[FRAME, 3:] = -V["torque"] * (SPINS @ squares) * up_W
        mujoco.mj_step(model, data)
    return rows


for integrator in ("Euler", "RK4"):
    judge(f"{integrator}, Lee's controller in Python", DT, 1, lambda name=integrator: fly(name))
