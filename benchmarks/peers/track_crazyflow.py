"""crazyflow on the CPU with its Mellinger controller and its own vehicle, in single precision."""

import jax
import jax.numpy as jnp
import numpy as np
from crazyflow.sim import Sim
from spiral import DURATION, derivative, judge, position, velocity

FREQUENCY, CALLS = 500, 100  # 1/s: steps and commands, its defaults


def spread(row, like):
    """Return a row for each vehicle."""
    return jnp.broadcast_to(jnp.asarray(row), like.shape).astype(like.dtype)


def fly(sim, start):
    sim.data = start
    rows = []
    for call in range(round(DURATION * CALLS)):
        t = call / CALLS
        rows.append([t, sim.data.states.pos[0, 0]])
        wanted = [*position(t), *velocity(t), *derivative(t, 2), 0, 0, 0, 1, 0, 0, 0]
        sim.state_control(jnp.broadcast_to(jnp.asarray(wanted, jnp.float32), (sim.n_worlds, 1, 16)))
        sim.step(FREQUENCY // CALLS)
    jax.block_until_ready(sim.data.states.pos)
    return [[t, *np.asarray(place).tolist()] for t, place in rows]


for vehicles in (1, 1024):
    sim = Sim(n_worlds=vehicles, dynamics="first_principles", control="state", freq=FREQUENCY)
    states = sim.data.states
    states = states.replace(
        pos=spread(position(0), states.pos), vel=spread(velocity(0), states.vel)
    )
    start = sim.data.replace(states=states)
    fly(sim, start)  # compiles
    judge(
        "its controller, its Crazyflie", 1 / FREQUENCY, vehicles, lambda s=sim, d=start: fly(s, d)
    )
