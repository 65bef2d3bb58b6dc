"""Time 200 flights of 10 s, a grid of drag and motor gain in engine eigen, by processes.

Prints wall seconds for the command line's own path, metrics and thinned curves included, and what
the same work takes the processor; on a machine that is busy otherwise only the latter counts.
Then how the memory of the parent grows with the number of variants.
"""

import os
import resource
import sys
import time
from pathlib import Path

from quadcore.comparison.compare import fly
from quadcore.comparison.grid import parse_axis
from quadcore.comparison.output import thinned
from quadcore.comparison.plan import Plan

COMMANDS = Path(__file__).resolve().parents[1] / "tests/data/gazebo11/commands_S5.csv"
LONGEST = 20.0  # s, on two cores
LEAST_SPEEDUP = 1.8


def plan(duration, *axes):
    vary = {name: parse_axis(name, values).values for name, values in axes}
    options = {"engine": "eigen", "xacro_args": {"sim_slow": 1}}
    return Plan(["quadrotor"], vary, COMMANDS, duration, 1, options)


def seconds(processes):
    grid = plan(
        10.0,
        ("drone_plugin.inducedDragCoeff", "0:0.02:20"),
        ("motorpid_plugin.kp", "log:1e-4:1e-2:10"),
    )
    start, used = time.perf_counter(), os.times()
    fly(grid, lambda row, log: thinned(log) if row % 5 == 0 else None, processes)
    wall, now = time.perf_counter() - start, os.times()
    work = sum(now[:4]) - sum(used[:4])
    print(f"{processes} process{'es' * (processes > 1)}: {wall:6.2f} s, processor {work:6.2f} s")
    return wall


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
times = [(seconds(1), seconds(2)) for _ in range(rounds)]
shortest, speedup = min(two for _, two in times), max(one / two for one, two in times)
print(f"200 flights of 10 s, two processes  {shortest:6.2f} s, at most {LONGEST:g}")
print(f"two processes over one              {speedup:6.2f}, at least {LEAST_SPEEDUP}")
for count in (1000, 10_000):
    fly(plan(0.01, ("motorpid_plugin.kp", f"1e-4:1e-3:{count}")))
    print(f"{count:6} variants: peak of the parent {peak():.0f} MiB")
