"""quadcore: all of the flight, in double precision, on one thread."""

import numpy as np
from flight import judge, phases, vehicle

import quadcore as qc

V = vehicle()
CALL = 10  # steps of a batch


def fly(sim, call, dt):
    sim.reset()
    for speeds, count in phases(V["hover"], dt):
        commands = np.array(speeds) * V["spins"]
        for done in range(0, count, call):
            sim.step(commands, min(call, count - done))
    return sim.end()


class Alone:
    def __init__(self, engine, dt):
        self.sim = qc.Simulation(
            "quadrotor", engine=engine, dt=dt, spawn=V["spawn"], **V["simulation"]
        )

    def reset(self):
        self.sim.reset()

    def step(self, commands, count):
        self.sim.command(commands)
        self.sim.step(count)

    def end(self):
        state = self.sim.state
        return place(state.position, state.orientation)


class Batch:
    def __init__(self, engine, dt, n):
        self.batch = qc.BatchSimulation(
            "quadrotor", n, engine, dt=dt, spawn=V["spawn"], threads=1, **V["simulation"]
        )
        self.rows = self.batch.read_state()

    def reset(self):
        self.batch.reset()

    def step(self, commands, count):
        self.batch.step(np.resize(commands, (self.batch.n, 4)), count)
        self.batch.read_state(self.rows)

    def end(self):
        return place(self.rows[0, :3], self.rows[0, 3:7])


def place(position, orientation):
    """Where the centre of mass is, whose place in the frame lies on its z axis."""
    x, y, z, w = orientation
    up_W = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    return np.array(position) + V["height"] * np.array(up_W)


for engine, dt in (("gazebo11", 1e-3), ("eigen", 1e-3), ("eigen", 5e-3)):
    alone = Alone(engine, dt)
    judge(engine, dt, 1, lambda sim=alone, dt=dt: fly(sim, 10**9, dt))
for engine, dt in (("gazebo11", 1e-3), ("eigen", 1e-3), ("eigen", 5e-3)):
    batch = Batch(engine, dt, 1024)
    judge(f"{engine}, batch", dt, 1024, lambda sim=batch, dt=dt: fly(sim, CALL, dt))
