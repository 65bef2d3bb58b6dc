#!/usr/bin/env python3
"""Sweeps: a row : the flight by itself; two processes : one; together : one by one; memory."""

from __future__ import annotations

import os
import resource
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np

import quadcore as qc
from quadcore.studies.design import Design
from quadcore.studies.options import SweepOptions
from quadcore.studies.sweep.batches import fly_together
from quadcore.studies.sweep.plan import Plan
from quadcore.studies.sweep.row_spec import fly_row
from quadcore.studies.sweep.sweep import fly_plan

ROWS, ROUNDS = 200, 5
AXES = {"frame.mass": "uniform:0.9:1.1", "drone_plugin.rotorThrustCoeff": "uniform:1.1e-5:1.2e-5"}


def plan(
    rows: int, controller: object, reference: object, commands: object = None, **given: object
) -> Plan:
    options = SweepOptions(xacro_args={"sim_slow": 1}, **given)
    design, sides = Design(AXES, samples=rows), (["eigen"], ["quadrotor"])
    return Plan(design, controller, reference, *sides, options, commands)


def taken(action: object, clock: object = time.perf_counter) -> float:
    begun = clock()
    action()
    return clock() - begun


def row_against_flight() -> None:
    swept = plan(ROUNDS * 4, "geometric", "circle")
    simulation = swept.spec(0).plan.simulation()
    start, circle, controller = (
        simulation.snapshot(),
        qc.references.circle(),
        qc.controllers.geometric(),
    )

    def fly() -> None:
        simulation.restore(start)
        simulation.run(10, controller=controller, reference=circle, log_every=10)

    ratios = [
        taken(lambda row=row: fly_row(swept.spec(row)), time.process_time)
        / taken(fly, time.process_time)
        for row in range(ROUNDS * 4)
    ]
    print(f"a row : sim.run() of its flight   {statistics.median(ratios):.2f}   (limit 1.3)")


def seconds(swept: Plan, processes: int) -> np.ndarray:
    """Return the wall-clock time of a sweep and the processor times of parent and workers, s."""
    used = os.times()
    with tempfile.TemporaryDirectory() as folder:
        wall = taken(lambda: fly_plan(swept, Path(folder), processes=processes))
    parent, workers = (sum(os.times()[i : i + 2]) - sum(used[i : i + 2]) for i in (0, 2))
    return np.array([wall, parent, workers])


def two_against_one() -> None:
    """By the wall clock, and as if nothing else ran: there the parent waits for no one."""
    swept = plan(ROWS, "geometric", "circle")

    def wall_and_undisturbed(processes: int) -> np.ndarray:
        wall, parent, workers = seconds(swept, processes)
        return np.array([wall, parent + workers / processes])

    wall, undisturbed = np.median(
        [wall_and_undisturbed(1) / wall_and_undisturbed(2) for _ in range(ROUNDS)], axis=0
    )
    print(
        f"two processes : one, {ROWS} rows   {wall:.2f}, undisturbed {undisturbed:.2f}   "
        "(limit 1.9)"
    )


def together_against_alone() -> None:
    rng = np.random.default_rng(0)
    speeds = np.array([480, -480, 480, -480]) + rng.normal(0, 3, (200, 4))
    commands = np.column_stack([0.05 * np.arange(200), speeds])
    swept = plan(32, None, None, commands)
    specs = [swept.spec(row) for row in range(32)]
    ratios = [
        taken(lambda: [fly_row(spec) for spec in specs]) / taken(lambda: fly_together(specs))
        for _ in range(ROUNDS)
    ]
    print(f"32 rows open loop, alone : together   {statistics.median(ratios):.2f}")


def memory() -> None:
    def most() -> int:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    with tempfile.TemporaryDirectory() as folder:
        fly_plan(plan(50, "geometric", "circle", duration=0.2), Path(folder))
    before = most()
    with tempfile.TemporaryDirectory() as folder:
        fly_plan(plan(2000, "geometric", "circle", duration=0.2), Path(folder))
    print(f"memory of the parent, 2000 rows less 50   {(most() - before) / 1024:.1f} MB")


if __name__ == "__main__":
    row_against_flight()
    two_against_one()
    together_against_alone()
    memory()
