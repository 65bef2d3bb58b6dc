"""A script without mistakes, which type checkers accept."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt

import quadcore as qc
from quadcore.controllers import geometric


class HoverController:
    """A controller with a state and a rate."""

    rate = 250.0

    def __init__(self, gain: float) -> None:
        self.gain = gain
        self.hover_speed: npt.ArrayLike = []

    def reset(self, sim: qc.Simulation) -> None:
        self.hover_speed = sim.hover_speed

    def __call__(
        self, t: float, odometry: qc.Odometry, goal: qc.Reference | None
    ) -> npt.NDArray[np.float64]:
        height = 10.0 if goal is None else goal.position[2]
        error = float(height - odometry.position[2])
        return np.asarray(self.hover_speed, dtype=float) * (1 + self.gain * error)


def keep_level(t: float, state: qc.Odometry, reference: qc.Reference) -> qc.AttitudeThrust:
    return qc.AttitudeThrust((0, 0, 0, 1), thrust=9.81)


def climb(t: float) -> qc.Reference:
    return qc.Reference(position=(0, 0, 10 + t), velocity=(0, 0, 1), yaw=math.pi / 2)


def fly(engine: qc.EngineName, controller: qc.ControllerName) -> qc.Log:
    sim = qc.Simulation("quadrotor", engine=engine, spawn=(0, 0, 10), xacro_args={"sim_slow": 1})
    sim.command([400.0, -400.0, 400.0, -400.0])
    sim.command(np.full(sim.rotor_count, 400.0))
    sim.step(100)
    state = sim.state.copy()
    state.position = np.array([0.0, 0.0, 5.0])
    sim.set_state(state)
    sim.restore(sim.snapshot())
    sim.run(1.0, controller=HoverController(0.1), reference=climb)
    sim.run(1.0, controller=keep_level, reference=qc.references.spiral(radius=3, along=True))
    sim.run(1.0, controller=qc.controllers.parse("pd:kp_xy=4"), reference="hover")
    return sim.run(1.0, controller=controller, reference="spiral", on_reference=True)


def compare_engines() -> list[float]:
    errors: list[float] = []
    for engine, _ in qc.engines():
        log = fly(engine, "geometric")
        errors.append(float(np.abs(log.topics["error"]["z"]).max()))
    return errors


controllers = {"soft": geometric(kp_xy=2.0, drag=False, rate=500), "stiff": geometric(kp_xy=8.0)}
evaluation = qc.evaluate(controllers, ["spiral", "step"], engine="eigen", duration=5, seeds=3)
print([row["failure"] for row in evaluation.table])
qc.evaluate(["pd", keep_level], "hover", engines=["eigen", "lagrange"], vary={"frame.mass": [1, 2]})
print(qc.compare("quadrotor", {"engine": ["ode", "eigen"]}, controller="lqr", reference="circle"))
print(qc.sweep("indi", "eight", {"frame.mass": "0.9:1.1:5"}, samples=10, engine="eigen").columns)
print(qc.tune("geometric", references=["spiral"], held_out=["circle"], budget=100).gains.law)
print(qc.fit("quadrotor", Path("flight.csv"), ["frame.mass"], engine="ode").values["frame.mass"])
batch = qc.BatchSimulation("quadrotor", 4, engine="eigen", parameters={"frame.mass": np.ones(4)})
batch.step(np.full((4, 4), 400.0), 10)
print(batch.state.position.mean(axis=0))
plan = qc.FlightPlan.of("quadrotor", engine="lagrange", duration=2.0, controller="pd")
plan.fly().to_csv("flight.csv")
qc.export_fmu("quadrotor.fmu", engine="eigen", dt=0.001)
print(qc.InnerLoop(kr_rp=40.0, gyroscopic=True), compare_engines())
