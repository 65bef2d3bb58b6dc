"""What a step costs from Python: step(1) and reading a state view, over one native step(n)."""

import sys
from statistics import median
from time import thread_time_ns

import quadcore as qc

STEPS = 2000
LARGEST_OVERHEAD = 0.5  # us


def native(sim):
    sim.step(STEPS)


def stepwise(sim):
    for _ in range(STEPS):
        sim.step(1)
        sim.state.position  # noqa: B018 (reading it is the point)


def microseconds_per_step(fly):
    sim.reset()
    sim.command([480, -480, 480, -480])
    start = thread_time_ns()
    fly(sim)
    return (thread_time_ns() - start) / STEPS / 1000


rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 201
sim = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
pairs = [(microseconds_per_step(native), microseconds_per_step(stepwise)) for _ in range(rounds)]
overhead = median(python - alone for alone, python in pairs)
ratio = median(python / alone for alone, python in pairs)
print(f"Python's step(1) / native step(n)   {ratio:7.3f}")
print(f"Python's overhead, us per step      {overhead:7.3f}   at most {LARGEST_OVERHEAD}")
