# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # Identifying a vehicle
#
# Given the log of a flight and a model with wrong parameters: which parameters can be identified
# from the flight, and how accurately? The "real" vehicle is a simulation too, so the true values
# are known. It is heavier than the model, has stronger rotors, and its sensors are noisy.

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
# The search starts at the parameters of the model. It uses the odometry, including its noise, and
# the commands of the log.

# %%
found = qc.fit(
    "quadrotor", log, list(TRUE), sensed="odom", xacro_args=SHARED["xacro_args"], parameters=NOISE
)
for name, value in found.values.items():
    print(
        f"{name:30} model {found.start[name]:<11.6g} found {value:<11.6g} "
        f"+- {found.identified.deviations[name]:<8.2g} true {TRUE[name]:g} {found.units[name]}"
    )
print(*found.describe(), sep="\n")

# %% [markdown]
# Only the ratio of thrust to mass determines the lift. Both can be identified because the thrust
# also rotates the vehicle, and the moments of inertia about x and y are known. The error of each
# identifiable parameter, in standard deviations:

# %%
errors = {
    name: abs(value - TRUE[name]) / found.identified.deviations[name]
    for name, value in found.values.items()
    if np.isfinite(found.identified.deviations[name])
}
assert errors and max(errors.values()) < 5
errors

# %% [markdown]
# The test is another flight. With commands that the fit has not used, the fitted model follows the
# real vehicle. The final distance from the real vehicle, in m:

# %%
hover = real.hover_speed
twist = np.array([1.02, 0.98, 1.02, 0.98])
commands = np.array([[0, *(1.02 * hover)], [1, *(twist * hover)], [2, *hover]])
logs = {
    name: qc.Simulation(model, parameters=parameters, **shared).run(3.0, commands=commands)
    for name, model, parameters, shared in (
        ("real", "quadrotor", TRUE, SHARED),
        ("model", "quadrotor", {}, SHARED),
        ("fitted", found.model, {}, {"engine": "eigen"}),
    )
}
distances = {
    name: float(np.linalg.norm(logs[name].position[-1] - logs["real"].position[-1]))
    for name in ("model", "fitted")
}
assert distances["fitted"] < 0.05 * distances["model"]
distances
