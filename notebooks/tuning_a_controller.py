# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # Tuning a controller
#
# A PD cascade with gains that are far too soft, tuned by search on one reference and judged on
# others that it was not tuned on. Needs the extra `tune`.

# %%
import matplotlib.pyplot as plt
import numpy as np

import quadcore as qc

SOFT = "pd:kp_xy=0.24,kd_xy=0.25"
XACRO = {"sim_slow": 1}

before = qc.evaluate(SOFT, ["circle", "eight"], duration=8, xacro_args=XACRO)
before

# %% [markdown]
# The search changes the two gains of the horizontal position. Each candidate flies the spiral
# from its start and from beside it; the best so far has to fly the references that are held out,
# too.

# %%
found = qc.tune(SOFT, only=["kp_xy", "kd_xy"], duration=5, budget=40, xacro_args=XACRO)
print(f"{found.start:.3g} m became {found.error:.3g} m")
print("held out:", found.held_out)
assert found.error < found.start
found.gains.parameters

# %% [markdown]
# Both, flown on references that did not steer the search:

# %%
after = qc.evaluate(
    {"soft": SOFT, "tuned": found.gains.make()},
    ["circle", "eight"],
    duration=8,
    xacro_args=XACRO,
)
after

# %%
figure, axes = plt.subplots()
for row, outcome in after.drawn.items():
    told = after.table[row]
    if told["reference"].startswith("circle"):
        error = outcome.log.topics["error"]
        distance = np.linalg.norm([error[axis] for axis in "xyz"], axis=0)
        axes.semilogy(outcome.log.time, np.maximum(distance, 1e-6), label=told["controller"])
axes.set_xlabel("time (s)")
axes.set_ylabel("distance from the circle (m)")
axes.legend()

# %% [markdown]
# How much can be wrong before the tuned gains lose the vehicle? The margins: factors on thrust
# and torque, and delay.

# %%
forgiven = qc.evaluate(found.gains.make(), "circle", duration=4, margins=True, xacro_args=XACRO)
told = ("gain_low", "gain_high", "delay_margin")
{name: forgiven.margins[0][name] for name in told}
