"""quadcore with its controller on SE(3) at 500 Hz, on one thread."""

import numpy as np
from flight import vehicle
from spiral import DURATION, judge

import quadcore as qc

V = vehicle()
DT, EVERY = 1e-3, 10  # s; steps between rows
VEHICLES = 1024
OPTIONS = {"controller": "geometric", "reference": "spiral", "log_every": EVERY}


def rows_of(log):
    return np.column_stack([log.time, log.position]).tolist()


def fly(sim):
    sim.reset()
    return rows_of(sim.run(DURATION, on_reference=True, **OPTIONS))


def fly_batch(batch, start):
    batch.reset()
    batch.set_state(start)
    return rows_of(batch.run(DURATION, log=[0], **OPTIONS)[0])


for engine in ("gazebo11", "eigen"):
    sim = qc.Simulation("quadrotor", engine=engine, dt=DT, **V["simulation"])
    judge(f"{engine}, geometric", DT, 1, lambda sim=sim: fly(sim), repeats=5)
for engine in ("gazebo11", "eigen"):
    sim = qc.Simulation("quadrotor", engine=engine, dt=DT, **V["simulation"])
    on = qc.references.start(sim, qc.references.spiral())
    parts = (on.position, on.orientation, on.linear_velocity, on.angular_velocity)
    row = np.concatenate([*parts, on.rotor_velocity, on.rotor_angle])
    batch = qc.BatchSimulation("quadrotor", VEHICLES, engine, dt=DT, threads=1, **V["simulation"])
    start = np.tile(row, (VEHICLES, 1))
    judge(f"{engine}, geometric, batch", DT, VEHICLES, lambda b=batch, s=start: fly_batch(b, s))
