"""Compare flights of seeds in one batch with the same flights one by one, by processor time.

Quadrotor at sim_slow 1 with position noise, spiral of 10 s, controller at 500 Hz, rows at 100 Hz.
"""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import process_time

import quadcore as qc
from quadcore.simulation.flight_plan import FlightPlan
from quadcore.studies.grouped_flights import MOST, MOST_VECTORIZED
from quadcore.studies.measured_flight import fly_and_measure, fly_together

sys.path.append(str(Path(__file__).parents[1] / "examples" / "matrix_policy"))
from matrix_policy import Policy

DURATION, STEPS = 10.0, 10_000
LIMIT = 600.0  # s


def make_plans(controller, reference, engine, n):
    plan = FlightPlan.of(
        "quadrotor",
        engine=engine,
        xacro_args={"sim_slow": 1},
        parameters={"odometry.positionNoise": 0.0002},
        duration=DURATION,
        log_every=10,
        controller=controller,
        reference=reference,
        on_reference=True,
    )
    return [partial(lambda plan: plan, replace(plan, seed=seed)) for seed in range(n)]


def compare(name, plans, alone):
    """Print the rate of a batch, and its ratio to single flights."""
    begin = process_time()
    assert fly_together(plans, LIMIT) is not None
    batch = (process_time() - begin) / len(plans)
    begin = process_time()
    for plan in plans[:alone]:
        fly_and_measure(plan, LIMIT, timed=False)
    ratio = (process_time() - begin) / alone / batch
    rate = STEPS / batch / 1e6
    print(f"{name:22} {rate:6.2f} M vehicle-steps/s, {ratio:6.1f} times single flights")


SPIRAL, HOVER = qc.references.spiral(), qc.references.hover()
for engine in ("eigen", "gazebo11"):
    for name in ("geometric", "pd", "lqr", "indi", "pid"):
        controller = qc.controllers.parse(name)
        compare(f"{engine} {name}", make_plans(controller, SPIRAL, engine, MOST), 8)
compare("eigen, in NumPy", make_plans(Policy(), HOVER, "eigen", MOST_VECTORIZED), 4)
