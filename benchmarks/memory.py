"""Measure the memory of batches and of a log; `sweeps.py` measures the parent of a sweep.

Each part runs in a process of its own, and counts what that process adds to its peak.
"""

import subprocess
import sys
from resource import RUSAGE_SELF, getrusage

import quadcore as qc

VEHICLE = {
    "xacro_args": {"sim_slow": 1},
    "parameters": {"odometry.positionNoise": 0.0002},
}


def peak():
    """Return the peak of this process so far, bytes."""
    return 1024 * getrusage(RUSAGE_SELF).ru_maxrss


def fly_batch(n, engine):
    batch = qc.BatchSimulation("quadrotor", n, engine, threads=1, **VEHICLE)
    batch.run(0.02, controller="geometric", reference="spiral")


def measure_batch(engine):
    n = 100_000
    fly_batch(64, engine)
    before = peak()
    fly_batch(n, engine)
    size = (peak() - before) / n / 1000
    print(f"{engine}, a vehicle of {n:,} with controllers   {size:.1f} kB   (limit 4)")


def measure_log():
    simulation = qc.Simulation("quadrotor", engine="eigen", **VEHICLE)
    options = {"controller": "geometric", "reference": "spiral"}
    simulation.run(0.1, **options)
    simulation.reset()
    before = peak()
    log = simulation.run(30.0, **options)
    size = (peak() - before) / log.table.nbytes
    print(f"a flight of 30 s logged at 1 kHz : its numbers   {size:.2f}   (limit 2)")


if __name__ == "__main__":
    measures = {
        "eigen": lambda: measure_batch("eigen"),
        "gazebo11": lambda: measure_batch("gazebo11"),
        "log": measure_log,
    }
    if len(sys.argv) > 1:
        measures[sys.argv[1]]()
    else:
        for name in measures:
            subprocess.run([sys.executable, __file__, name], check=True)
