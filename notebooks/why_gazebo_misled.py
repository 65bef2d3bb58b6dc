# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # Why Gazebo misled
#
# A quadrotor that rotates in free fall, with running rotors and without air, keeps its angular
# momentum. In Gazebo 11 it does not. Gazebo's physics engine uses the gyroscopic torque of each
# rotor at the start of a step, and this acts as damping. This notebook measures the damping.

# %%
import matplotlib.pyplot as plt
import numpy as np

import quadcore as qc

NO_AIR = {
    f"drone_plugin.{name}": 0
    for name in (
        "rotorThrustCoeff",
        "rotorTorqueCoeff",
        "inducedDragCoeff",
        "translationalDragCoeff",
        "profileDragCoeff",
        "parasiticDragCoeff",
    )
}
SPEED = qc.Simulation("quadrotor").hover_speed  # rad/s, commanded


def simulate_fall(engine, dt=0.001, sim_slow=1):
    """Simulate two seconds of free fall with a pitch rate of 0.1 rad/s."""
    sim = qc.Simulation(
        "quadrotor", engine, dt=dt, parameters=NO_AIR, xacro_args={"sim_slow": sim_slow}
    )
    state = sim.state.copy()
    state.angular_velocity[:] = 0, 0.1, 0
    state.rotor_velocity[:] = SPEED / sim_slow
    sim.set_state(state)
    sim.command(SPEED)
    return sim.run(2.0, log_every=10)


# %%
logs = {engine: simulate_fall(engine) for engine, _ in qc.engines()}
plt.style.use(qc.PLOT_STYLE)
figure, axes = plt.subplots()
for engine, log in logs.items():
    axes.plot(log.time, log["wy"], label=engine)
axes.set_xlabel("time (s)")
axes.set_ylabel("pitch rate (rad/s)")
axes.legend()

# %% [markdown]
# The pitch rate decays only in `gazebo11`, with about 0.8 1/s. A controller that is tuned there
# depends on this damping.
#
# For an explicit step, the decay rate is
# $\lambda = \sum_i (I_{zz} - I_{xx}) W_i^2 \Delta t / 2 J$. The sum is over the rotors, $W_i$ is
# the speed of a rotor, and $J$ is the vehicle's moment of inertia about the pitch axis.

# %%
sim = qc.Simulation("quadrotor")
rotor = sim.model.links[1].inertia


def measure_decay(log):
    """Return the decay rate of the pitch rate, 1/s."""
    return -np.polyfit(log.time, np.log(np.abs(log["wy"])), 1)[0]


def predict_decay(dt, sim_slow):
    """Return the decay rate by the formula, 1/s."""
    speeds = SPEED / sim_slow
    return (rotor[2, 2] - rotor[0, 0]) * np.sum(speeds**2) * dt / (2 * sim.inertia[1, 1])


rows = [(1e-3, 1), (5e-4, 1), (2.5e-4, 1), (1e-3, 10)]
logs_of_gazebo11 = [simulate_fall("gazebo11", *row) for row in rows]
decays = np.array(
    [(measure_decay(log), predict_decay(*row)) for log, row in zip(logs_of_gazebo11, rows)]
)
for (dt, slow), (found, formula) in zip(rows, decays):
    print(f"step {1e3 * dt:g} ms, sim_slow {slow:2}: {found:.4f} 1/s, formula {formula:.4f} 1/s")
assert np.allclose(decays[:, 0], decays[:, 1], rtol=0.05)

# %% [markdown]
# The damping is proportional to the step and to the square of the rotor speed. In the published
# model, the slowdown of the rotors (`sim_slow` 10) reduces it a hundredfold. Smaller steps reduce
# it too. The engines `ode` and `eigen` do not have it:

# %%
others = {engine: measure_decay(logs[engine]) for engine in ("ode", "eigen")}
assert max(map(abs, others.values())) < 1e-3
others

# %% [markdown]
# The effect on a flight with the same commands in each engine:

# %%
found = qc.compare(
    "quadrotor",
    {"engine": ["eigen", "ode", "gazebo11"]},
    commands=np.array([[0, 480, -480, 480, -480], [1, 479, -480, 481, -480], [1.3, *SPEED]]),
    duration=3,
    xacro_args={"sim_slow": 1},
)
found
