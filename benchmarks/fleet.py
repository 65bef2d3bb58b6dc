"""Time per step of a vehicle among 50 in one world, relative to a vehicle alone.

One process steps a fleet of 50 quadrotors that fly 2 m apart and one that stands alone, in turns.
"""

import sys
import warnings
from statistics import median
from time import thread_time_ns

import quadcore as qc

STEPS, VEHICLES = 500, 50
LARGEST_RATIO = 2.0


def make_vehicle(engine, i):
    return qc.Simulation("quadrotor", engine=engine, spawn=(2 * (i % 10), 2 * (i // 10), 10))


def main():
    """Measure each engine; the exit status is 1 if a ratio is too large."""
    warnings.simplefilter("ignore", qc.QuadcoreWarning)
    failed = False
    for engine in ("gazebo11", "ode", "eigen"):
        alone = make_vehicle(engine, 0)
        fleet = qc.Fleet([make_vehicle(engine, i) for i in range(VEHICLES)])
        ratios, nanoseconds = [], []
        for _ in range(21):
            times = []
            for flown in (alone, fleet):
                flown.reset()
                start = thread_time_ns()
                flown.step(STEPS)
                times.append(thread_time_ns() - start)
            nanoseconds.append(times[1] / VEHICLES / STEPS)
            ratios.append(nanoseconds[-1] * STEPS / times[0])
        ratio = median(ratios)
        failed |= ratio > LARGEST_RATIO
        print(
            f"{engine:10} {median(nanoseconds) / 1000:6.2f} us per step of a vehicle among "
            f"{VEHICLES}, {ratio:5.2f} times that of one alone, at most {LARGEST_RATIO}"
        )
    return failed


if __name__ == "__main__":
    sys.exit(main())
