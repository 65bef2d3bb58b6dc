"""crazyflow on the CPU: first principles, all that this flight has."""

import jax
import jax.numpy as jnp
import numpy as np
from crazyflow.sim import Sim
from flight import judge, phases, vehicle

V = vehicle()
DT = 1e-3
N = 1024
RPM = 60 / (2 * np.pi)


def simulation(integrator):
    sim = Sim(
        n_worlds=N,
        dynamics="first_principles",
        control="rotor_vel",
        integrator=integrator,
        freq=round(1 / DT),
    )
    del sim.step_pipeline["clip_rotor_vel_cmd"]  # limits of another vehicle
    sim.build_step_fn()
    places, spins = np.array(V["rotors"]), np.array(V["spins"])
    own = {
        "mass": V["mass"],
        "L": 1.0,
        "prop_inertia": V["rotor_inertia"],
        "J": V["inertia"],
        "J_inv": np.linalg.inv(V["inertia"]),
        "rpm2thrust": [0, 0, V["thrust"] / RPM**2],
        "rpm2torque": [0, 0, V["torque"] / RPM**2],
        "mixing_matrix": [places[:, 1], -places[:, 0], -spins],
        "drag_matrix": np.zeros((3, 3)),
        "rotor_dyn_coef": [1 / V["lag"], 0, 1 / V["lag"], 0],
    }
    old = sim.data.params
    params = old.replace(
        **{
            name: jnp.broadcast_to(
                jnp.asarray(value, getattr(old, name).dtype), getattr(old, name).shape
            )
            for name, value in own.items()
        }
    )
    states = sim.data.states
    states = states.replace(
        pos=jnp.broadcast_to(jnp.asarray(V["start"]), states.pos.shape).astype(states.pos.dtype),
        rotor_vel=jnp.zeros_like(states.rotor_vel),
    )
    sim.data = sim.data.replace(params=params, states=states)
    return sim, sim.data


def fly(sim, start):
    sim.data = start
    for speeds, count in phases(V["hover"], DT):
        sim.rotor_vel_control(jnp.broadcast_to(jnp.asarray(speeds) * RPM, (N, 1, 4)))
        sim.step(count)
    return jax.block_until_ready(sim.data.states.pos)[0, 0].tolist()


for integrator in ("euler", "rk4"):
    made = simulation(integrator)
    judge(f"{integrator}, single precision", DT, N, lambda made=made: fly(*made))
