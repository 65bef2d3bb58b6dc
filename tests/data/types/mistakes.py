"""Eleven mistakes, each on a line that ends with its number; type checkers find all of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

import quadcore as qc

sim = qc.Simulation("quadrotor", engine="gazebo")  # 1
batch = qc.BatchSimulation("quadrotor", 4, seeds=1)  # 2
sim.run(5.0, controller="geometrical", reference="hover")  # 3
sim.run(5.0, controller="geometric", reference="helix")  # 4
stiff = qc.controllers.geometric(kp_yx=8.0)  # 5
wide = qc.references.spiral(radus=3.0)  # 6


def hold(t: float, state: qc.Odometry) -> npt.NDArray[np.float64]:
    return np.full(4, 400.0)


class Observer:
    def __call__(self, t: float, state: qc.Odometry, reference: Any) -> npt.NDArray[np.float64]:
        return state.pose  # 7


def climb(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 10.0 + t


sim.run(5.0, controller=hold)  # 8
sim.run(5.0, controller=Observer, reference="hover")  # 9
sim.run(5.0, controller=Observer(), reference=climb)  # 10
qc.evaluate(["pd", "pid"], ["spiral", "steps"], engine="eigen", duration=5)  # 11
