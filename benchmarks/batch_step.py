"""What a vehicle's step costs in a batch over what it costs alone, one thread: engines, sizes."""

import sys
from statistics import median
from time import thread_time_ns

import numpy as np

import quadcore as qc

STEPS = 10  # a call
CALLS = 20
SPEEDS = [480, -480, 480, -480]
LARGEST = {
    ("eigen", "chapter2"): 0.35,
    ("eigen", "appendix"): 0.45,
    ("gazebo11", "appendix"): 0.5,
}
LARGEST_OWN, LARGEST_MANY = 1.15, 1.2


def nanoseconds(vehicles, call):
    start = thread_time_ns()
    for _ in range(CALLS):
        call()
    return (thread_time_ns() - start) / (CALLS * STEPS * vehicles)


def batch(n, drag, own=False, engine="eigen"):
    parameters = {"drone_plugin.dragModel": drag}
    if own:
        parameters["drone_plugin.rotorThrustCoeff"] = np.linspace(8e-6, 9e-6, n)
    vehicles = qc.BatchSimulation(
        n=n, engine=engine, parameters=parameters, spawn=(0, 0, 10), threads=1
    )
    commands, rows = np.resize(np.array(SPEEDS, float), (n, 4)), vehicles.read_state()

    def call():
        vehicles.step(commands, STEPS)
        vehicles.read_state(rows)

    return lambda: nanoseconds(n, call)


def alone(drag, engine):
    sim = qc.Simulation(
        engine=engine, parameters={"drone_plugin.dragModel": drag}, spawn=(0, 0, 10)
    )
    sim.command(SPEEDS)
    return lambda: nanoseconds(100, lambda: sim.step(100 * STEPS))


def ratio(part, whole, rounds):
    return median(part() / whole() for _ in range(rounds))


rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 21
for (engine, drag), largest in LARGEST.items():
    of_batch = batch(1024, drag, engine=engine)
    both = f"{engine}, {drag}"
    print(
        f"1024 / alone, {both:21s} {ratio(of_batch, alone(drag, engine), rounds):7.3f}   "
        f"at most {largest}   ({median(of_batch() for _ in range(rounds)):.0f} ns)"
    )
own = ratio(batch(1024, "chapter2", own=True), batch(1024, "chapter2"), rounds)
print(f"parameters of its own / shared          {own:7.3f}   at most {LARGEST_OWN}")
many = ratio(batch(100_000, "chapter2"), batch(1024, "chapter2"), 3)
print(f"one of 100,000 / one of 1024            {many:7.3f}   at most {LARGEST_MANY}")
