"""Time `quadcore evaluate`: 320 flights of 30 s in engine eigen, with intervals, pictures and page.

Four laws, four references, 20 seeds of the thesis' noise, two processes. Beside wall seconds stands
what they would be if nothing else ran, from processor times. Then what a flight of a law in numpy
at 500 Hz takes, that of the tests.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

import quadcore as qc
from quadcore.evaluation.evaluate import conduct
from quadcore.evaluation.output import write
from quadcore.evaluation.plan import Plan

ROOT = Path(__file__).resolve().parents[1]
LONGEST = 45.0  # s, on two cores
LONGEST_IN_NUMPY = 2.5  # s a flight
PROCESSES = 2


def seconds_of_evaluation():
    noise = {"odometry.positionNoise": 0.2106e-3, "odometry.orientationNoise": 0.2e-3}
    options = {"xacro_args": {"sim_slow": 1}, "parameters": noise}
    laws = ["pd", "pd_compensated", "geometric", "indi"]
    shapes = ["spiral", "circle", "eight", "waypoints"]
    start, used = time.perf_counter(), os.times()
    plan = Plan(laws, shapes, ["eigen"], ["quadrotor"], 20, {}, 30.0, *[None] * 4, options)
    evaluation = conduct(plan, 300.0, PROCESSES)
    with tempfile.TemporaryDirectory() as folder:
        write(evaluation, plan, Path(folder), plots=True)
    wall, now = time.perf_counter() - start, os.times()
    parent, flights = (sum(now[i : i + 2]) - sum(used[i : i + 2]) for i in (0, 2))
    return len(evaluation.table), wall, parent + flights / PROCESSES


def seconds_in_numpy():
    sys.path.insert(0, str(ROOT / "tests" / "python"))
    from twin_law import Twin

    spiral = qc.references.spiral()
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1})
    simulation.set_state(qc.references.start(simulation, spiral))
    start = time.process_time()
    simulation.run(30, controller=Twin(), reference=spiral, log_every=10, wrenches=False)
    return time.process_time() - start


count, wall, undisturbed = seconds_of_evaluation()
print(
    f"{count} flights of 30 s: {wall:6.2f} s, undisturbed {undisturbed:6.2f} s, at most {LONGEST}"
)
seconds = seconds_in_numpy()
print(f"a law in numpy, 30 s at 500 Hz: {seconds:6.2f} s of processor, at most {LONGEST_IN_NUMPY}")
