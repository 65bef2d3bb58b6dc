#!/usr/bin/env python3
"""Check the tracking errors of docs/tracking_errors.md against limits.

Prints a row per case: the maximum error of all its flights [mm], and the limit. Exit status 1 if an
error exceeds its limit. Takes some minutes.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Tuple, Union

import numpy as np
from noise import NOISY, THESIS

import quadcore as qc
from quadcore.control import controllers, references
from quadcore.control.built_in import BuiltInController
from quadcore.studies.executor import run_cases
from quadcore.support.warning import suppress_warnings

WAYPOINTS = Path(__file__).resolve().parents[1] / "config" / "waypoints.yaml"
DIVERGED = 5.0  # m


@dataclass
class Case:
    """Flights of one kind, one for each seed."""

    name: str
    engine: str
    sim_slow: int
    make: Callable[[], BuiltInController]
    reference: Callable[[], references.Shape]
    limit: float  # mm; negative: the flight is expected to fail
    duration: float = 30.0
    last: float = 10.0  # s of the flight that count
    noise: Mapping[str, float] = field(default_factory=dict)
    seeds: int = 1


def cases() -> List[Case]:
    """List all cases."""
    plants = [("eigen", 1), ("ode", 1), ("gazebo11", 1), ("gazebo11", 10)]
    spiral, geometric = references.spiral, controllers.geometric
    found = []
    for plant, bar in zip(plants, (0.05, 0.4, 0.8, 0.4)):
        found.append(Case("spiral, geometric", *plant, geometric, spiral, bar))
    for plant, bar in zip(plants, (0.15, 0.5, 0.9, 0.5)):
        name = "spiral, geometric, the thesis' noise"
        found.append(Case(name, *plant, geometric, spiral, bar, noise=THESIS, seeds=20))
    for plant in plants:
        name = "spiral, geometric, noise also of velocities"
        found.append(Case(name, *plant, geometric, spiral, 1, noise=NOISY, seeds=20))
    for plant, bar in zip(plants, (0.5, 0.5, 2)):
        found.append(
            Case("spiral, pd_compensated", *plant, controllers.pd_compensated, spiral, bar)
        )
    shapes = {
        "circle": references.circle,
        "eight": references.eight,
        "waypoints": lambda: references.waypoints(WAYPOINTS),
    }
    for plant, bars in (plants[0], (1, 5, 4)), (plants[2], (20, 35, 12)):
        for (name, shape), bar in zip(shapes.items(), bars):
            times = (12, 12) if name == "waypoints" else (30, 10)
            found.append(Case(f"{name}, geometric", *plant, geometric, shape, bar, *times))
    damped = "circle, geometric, with Gazebo's damping in its model"
    found.append(
        Case(damped, *plants[2], lambda: geometric(rate_damping=0.81), references.circle, 4)
    )
    for plant in (*plants, ("ode", 10), ("eigen", 10)):
        found.append(
            Case(
                "spiral, pid_thesis", *plant, lambda: controllers.pid_thesis(rate=1000), spiral, -1
            )
        )
    return found


def fly(flight: Tuple[Case, int]) -> float:
    """Simulate one flight; returns the maximum error [mm]."""
    case, seed = flight
    reference = case.reference()
    parameters = {**case.noise, "xacro.sim_slow": case.sim_slow}
    simulation = qc.Simulation(engine=case.engine, seed=seed, parameters=parameters)
    simulation.set_state(references.start(simulation, reference))
    with suppress_warnings():
        try:
            log = simulation.run(
                case.duration,
                log_every=5,
                controller=case.make(),
                reference=reference,
            )
        except qc.FlightError as error:
            log = error.log  # type: ignore[attr-defined]
    wanted = np.array([reference(t).position for t in log.time])
    errors = np.linalg.norm(log.position - wanted, axis=1)
    if errors.max() > DIVERGED or log.time[-1] < case.duration - 0.1:
        return float("inf")
    return 1e3 * float(errors[log.time >= case.duration - case.last].max())


def is_met(case: Case, error: float) -> bool:
    """Whether the maximum error [mm] of a case's flights is within its limit."""
    return np.isinf(error) if case.limit < 0 else error <= case.limit


def main() -> int:
    """Simulate all cases and print their rows; returns 1 if a limit is exceeded."""
    flights = [(case, seed) for case in cases() for seed in range(case.seeds)]
    errors: Dict[str, List[float]] = {}
    missed = []

    def take(index: int, error: Union[float, qc.QuadcoreError]) -> None:
        if isinstance(error, qc.QuadcoreError):
            raise error
        case = flights[index][0]
        row = f"{case.name:48} {case.engine:8} {case.sim_slow:4}"
        flown = errors.setdefault(row, [])
        flown.append(error)
        if len(flown) < case.seeds:
            return
        limit = "fails" if case.limit < 0 else f"<= {case.limit:g}"
        met = is_met(case, max(flown))
        missed.extend([] if met else [row])
        print(f"{row} {max(flown):9.4f}  {limit:8}{'' if met else ' missed'}", flush=True)

    print(f"{'':48} {'engine':8} slow  max error and limit [mm]")
    run_cases(lambda i: fly(flights[i]), range(len(flights)), take)
    return int(bool(missed))


if __name__ == "__main__":
    sys.exit(main())
