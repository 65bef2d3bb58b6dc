# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # Identifying a vehicle
#
# A log of a flight, and a model that is not quite right: which numbers of the model does the
# flight tell, and how well? Here the "real" vehicle is a simulation too, so that the answer is
# known. It is heavier than the model believes, has stronger rotors, and its sensors are noisy.

# %%
import numpy as np

import quadcore as qc

TRUE = {"frame.mass": 1.15, "drone_plugin.rotorThrustCoeff": 1.25e-5, "frame.izz": 0.0128}
NOISE = {
    "odometry.positionNoise": 0.002,
    "odometry.orientationNoise": 0.002,
    "odometry.linearVelocityNoise": 0.01,
    "odometry.angularVelocityNoise": 0.01,
}
SHARED = {"engine": "eigen", "xacro_args": {"sim_slow": 1}}

real = qc.Simulation("quadrotor", parameters={**TRUE, **NOISE}, seed=3, **SHARED)
log = real.run(
    12.0,
    controller="geometric",
    reference=qc.references.eight(),
    on_reference=True,
    log_every=2,  # as often as the controller commands
    topics=["odom", "vel_cmd"],
)
log

# %% [markdown]
# The search begins at the model's own numbers. Of the log it takes what the odometry said, noise
# included, and the commands.

# %%
found = qc.fit(
    "quadrotor", log, list(TRUE), sensed="odom", xacro_args=SHARED["xacro_args"], parameters=NOISE
)
for name, value in found.values.items():
    print(
        f"{name:30} model {found.start[name]:<11.6g} found {value:<11.6g} "
        f"+- {found.identified.deviations[name]:<8.2g} true {TRUE[name]:g} {found.units[name]}"
    )
print(*found.told(), sep="\n")

# %% [markdown]
# Only the ratio of thrust to mass lifts the vehicle. They are told apart because the thrust also
# turns it, and its moments about x and y are taken as known. Where the flight tells a number, it
# lies within a few of its deviations:

# %%
off = {
    name: abs(value - TRUE[name]) / found.identified.deviations[name]
    for name, value in found.values.items()
    if np.isfinite(found.identified.deviations[name])
}
assert off and max(off.values()) < 5
off

# %% [markdown]
# The proof is another flight: the fitted model flies as the real vehicle does, on commands that
# the fit has not seen.

# %%
hover = real.hover_speed
twist = np.array([1.02, 0.98, 1.02, 0.98])
commands = np.array([[0, *(1.02 * hover)], [1, *(twist * hover)], [2, *hover]])
flown = {
    name: qc.Simulation(model, parameters=own, **shared).run(3.0, commands=commands)
    for name, model, own, shared in (
        ("real", "quadrotor", TRUE, SHARED),
        ("model", "quadrotor", {}, SHARED),
        ("fitted", found.model, {}, {"engine": "eigen"}),
    )
}
apart = {
    name: float(np.linalg.norm(flown[name].position[-1] - flown["real"].position[-1]))
    for name in ("model", "fitted")
}
assert apart["fitted"] < 0.05 * apart["model"]
apart
