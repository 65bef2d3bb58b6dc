"""Time `quadcore evaluate`: 320 flights of 30 s in engine eigen, with intervals, pictures and page.

Four controllers, four references, 20 seeds of the thesis' noise, two processes. The second line
is the wall time if nothing else ran, from processor times. The last line is the time of a flight of
a controller in numpy at 500 Hz, the cascade of thesis (2.43)-(2.51).
"""

import os
import tempfile
import time
from pathlib import Path

import numpy as np
import yaml

import quadcore as qc
from quadcore.studies.evaluate.evaluate import fly_plan
from quadcore.studies.evaluate.output import write
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.options import EvaluateOptions

SPIRAL = yaml.safe_load((Path(__file__).parents[1] / "config" / "spiral.yaml").read_text())
LONGEST = 12.0  # s, on two idle cores
LONGEST_IN_NUMPY = 2.5  # s a flight
PROCESSES = 2


def seconds_of_evaluation():
    options = EvaluateOptions(xacro_args=SPIRAL["xacro"], seeds=20, processes=PROCESSES)
    controllers = ["pd", "pd_compensated", "geometric", "indi"]
    shapes = ["spiral", "circle", "eight", "waypoints"]
    start, used = time.perf_counter(), os.times()
    plan = Plan(controllers, shapes, ["eigen"], ["quadrotor"], {}, options)
    evaluation = fly_plan(plan)
    with tempfile.TemporaryDirectory() as folder:
        write(evaluation, plan, Path(folder), plots=True)
    wall, now = time.perf_counter() - start, os.times()
    parent, flights = (sum(now[i : i + 2]) - sum(used[i : i + 2]) for i in (0, 2))
    return len(evaluation.table), wall, parent + flights / PROCESSES


class Cascade:
    """Feedback linearisation of the position around a PD of the attitude."""

    rate = 500.0

    def reset(self, simulation):
        k, b, arm = 1.1487e-5, 2.69e-7, 0.2
        effect = [[k] * 4, [0, -k * arm, 0, k * arm], [-k * arm, 0, k * arm, 0], [b, -b, b, -b]]
        self.squares = np.linalg.inv(np.array(effect))
        self.mass, self.inertia = simulation.mass, np.diag(simulation.inertia)

    def __call__(self, t, state, reference):
        wanted = reference.acceleration + np.array([0, 0, 9.8])
        wanted = wanted + 2.4 * (reference.position - state.position)
        wanted = wanted + 2.5 * (reference.velocity - state.linear_velocity)
        x, y, z, w = state.orientation
        roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
        yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        s, c = np.sin(yaw), np.cos(yaw)
        to_pitch = np.arctan2(wanted[0] * c + wanted[1] * s, wanted[2])
        to_roll = np.arctan2((wanted[0] * s - wanted[1] * c) * np.cos(to_pitch), wanted[2])
        off = np.array([to_roll - roll, to_pitch - pitch, reference.yaw - yaw])
        turn = np.array([96, 96, 2]) * off - np.array([16, 16, 3]) * state.angular_velocity
        thrust = self.mass * np.linalg.norm(wanted)
        squares = self.squares @ np.array([thrust, *(self.inertia * turn)])
        return np.array([1, -1, 1, -1]) * np.sqrt(np.maximum(squares, 0))


def seconds_in_numpy():
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1})
    start = time.process_time()
    log = simulation.run(
        30, log_every=10, controller=Cascade(), reference="spiral", on_reference=True
    )
    assert np.abs(log.topics["error"]["x"]).max() < 0.05
    return time.process_time() - start


count, wall, undisturbed = seconds_of_evaluation()
print(f"{count} flights of 30 s, two processes  {wall:6.2f} s, at most {LONGEST:g}")
print(f"the same undisturbed                {undisturbed:6.2f} s")
print(
    f"a flight of a controller in numpy   {seconds_in_numpy():6.2f} s, at most {LONGEST_IN_NUMPY:g}"
)
