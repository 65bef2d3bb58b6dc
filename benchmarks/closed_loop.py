"""Compare flights in closed loop with open-loop steps, and time the calls of a Python controller.

Quadrotor at sim_slow 1, spiral, controller at 500 Hz, rows at 100 Hz. The open loop logs nothing.
"""

import sys
from statistics import median
from time import thread_time_ns

import quadcore as qc

DURATION = 30.0  # s
LEAST_SHARE = 0.6  # of the speed of the open loop
LARGEST_OVERHEAD = 2.0  # us per call of a Python controller
HOVER = [471.0, -471.0, 471.0, -471.0]
REFERENCE = qc.references.spiral()


def constant(t, state, reference):
    return HOVER


def nanoseconds(sim, fly):
    sim.reset()
    sim.command(HOVER)
    start = thread_time_ns()
    fly(sim)
    return thread_time_ns() - start


def run(controller):
    def fly(sim):
        sim.run(DURATION, controller=controller, reference=REFERENCE, log_every=10)

    return fly


def step(sim):
    sim.step(round(DURATION / sim.dt))


def ratios(sim, fly, rounds):
    return [nanoseconds(sim, step) / nanoseconds(sim, fly) for _ in range(rounds)]


rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 11
for engine in ("eigen", "gazebo11"):
    sim = qc.Simulation("quadrotor", engine=engine, xacro_args={"sim_slow": 1})
    for name in ("geometric", "pd", "lqr", "indi", "pid"):
        controller = qc.controllers.parse(f"{name}:rate=500")
        share = median(ratios(sim, run(controller), rounds))
        print(f"{engine:8} {name:9} closed / open loop {share:6.2f}, at least {LEAST_SHARE}")
sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
calls = 500 * DURATION
overhead = median(
    (nanoseconds(sim, run(constant)) - nanoseconds(sim, step)) / calls / 1000 for _ in range(rounds)
)
print(f"a Python controller, us per call    {overhead:6.2f}, at most {LARGEST_OVERHEAD}")
