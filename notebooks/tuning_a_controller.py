# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # Tuning a controller
#
# A PD cascade starts with very low gains. The search tunes them on one reference, and the tuned
# controller is evaluated on others. This notebook needs the extra `tune`.

# %%
import matplotlib.pyplot as plt
import numpy as np

import quadcore as qc

SOFT = "pd:kp_xy=0.24,kd_xy=0.25"
XACRO = {"sim_slow": 1}

before = qc.evaluate(SOFT, ["circle", "eight"], duration=8, xacro_args=XACRO)
before

# %% [markdown]
# The search changes the two gains of the horizontal position. Each candidate tracks the spiral
# from its start and from a start next to it. The best candidates must also track the held-out
# references.

# %%
found = qc.tune(SOFT, only=["kp_xy", "kd_xy"], duration=5, budget=40, xacro_args=XACRO)
print(f"RMS error: {found.start:.3g} m at the start, {found.error:.3g} m tuned")
print("held out:", found.held_out)
assert found.error < found.start
found.gains.parameters

# %% [markdown]
# Both controllers on references that did not guide the search:

# %%
after = qc.evaluate(
    {"soft": SOFT, "tuned": found.gains.make()},
    ["circle", "eight"],
    duration=8,
    xacro_args=XACRO,
)
after

# %%
plt.style.use(qc.PLOT_STYLE)
figure, axes = plt.subplots()
for row, outcome in after.drawn.items():
    inputs = after.table[row]
    if inputs["reference"].startswith("circle"):
        error = outcome.log.topics["error"]
        distance = np.linalg.norm([error[axis] for axis in "xyz"], axis=0)
        axes.semilogy(outcome.log.time, np.maximum(distance, 1e-6), label=inputs["controller"])
axes.set_xlabel("time (s)")
axes.set_ylabel("tracking error on the circle (m)")
axes.legend()

# %% [markdown]
# How large can errors of the model be before the tuned controller fails? The margins are factors
# on thrust and torque, and an additional delay in seconds.

# %%
margins = qc.evaluate(found.gains.make(), "circle", duration=4, margins=True, xacro_args=XACRO)
{name: margins.margins[0][name] for name in ("gain_low", "gain_high", "delay_margin")}
