"""Time 200 flights of 10 s, a grid of drag and motor gain in engine eigen, by processes.

Metrics and thinned curves are included. Beside wall seconds stands what they would be if nothing
else ran, from processor times: on a busy machine only these say how the work divides. Then how the
memory of the parent grows with the number of variants.
"""

import os
import resource
import sys
import time
from pathlib import Path

import numpy as np

from quadcore.report.decimation import decimate
from quadcore.studies.axes import parse_axis
from quadcore.studies.compare.compare import fly_plan
from quadcore.studies.compare.plan import Plan
from quadcore.studies.control_setup import ControlSetup
from quadcore.studies.options import CompareOptions

COMMANDS = Path(__file__).resolve().parents[1] / "tests/data/gazebo11/commands_S5.csv"
LONGEST = 20.0  # s, on two cores
LEAST_SPEEDUP = 1.8


def plan(duration, *axes, processes=None):
    vary = {name: parse_axis(name, values).values for name, values in axes}
    options = CompareOptions(duration=duration, xacro_args={"sim_slow": 1}, processes=processes)
    return Plan(["quadrotor"], vary, "eigen", ControlSetup(), options, COMMANDS)


def seconds(processes):
    """Wall time, and what it would be if the cores had nothing else to do."""
    grid = plan(
        10.0,
        ("drone_plugin.inducedDragCoeff", "0:0.02:20"),
        ("motorpid_plugin.kp", "log:1e-4:1e-2:10"),
        processes=processes,
    )
    start, used = time.perf_counter(), os.times()
    fly_plan(grid, lambda row, log: decimate(log) if row % 5 == 0 else None)
    wall, now = time.perf_counter() - start, os.times()
    parent, flights = (sum(now[i : i + 2]) - sum(used[i : i + 2]) for i in (0, 2))
    # The first flight, and what the parent does, are done by one process.
    alone = parent + flights / len(grid)
    undisturbed = alone + flights * (1 - 1 / len(grid)) / processes
    print(f"by {processes}: {wall:6.2f} s, undisturbed {undisturbed:6.2f} s")
    return wall, undisturbed


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
times = [(seconds(1), seconds(2)) for _ in range(rounds)]
one, two = (np.min(column, axis=0) for column in zip(*times))
print(f"200 flights of 10 s, two processes  {two[0]:6.2f} s, at most {LONGEST:g}")
for i, kind in enumerate(("wall", "undisturbed")):
    print(f"two processes over one, {kind:11} {one[i] / two[i]:6.2f}, at least {LEAST_SPEEDUP}")
for count in (1000, 10_000):
    fly_plan(plan(0.01, ("motorpid_plugin.kp", f"1e-4:1e-3:{count}")))
    print(f"{count:6} variants: peak of the parent {peak():.0f} MiB")
