#!/usr/bin/env python3
"""Measure the accuracy of the engines: ``scripts/document`` runs it.

It writes the tables between marks of docs/engines.md and docs/gazebo.md.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any, Iterator

import numpy as np
from measured import figures, put

import quadcore as qc
from quadcore.thesis.validation import Experiment
from quadcore.thesis.validation.damping import measure_damping

DATA = Path(__file__).resolve().parents[1] / "tests" / "data"
CASES = DATA / "gazebo11" / "cases"
HOVER = 471.0  # rad/s
SPIN = np.array([1, -1, 1, -1])
ENGINES = [engine for engine, _ in qc.engines()]
LATER = ("gazebo11", "ode")  # engines with a larger decay while their hinges settle
# Recorded in real Gazebo 11.1.0.
GAZEBO_DECAY = {1: 0.812, 8: 0.0128, 10: 0.0082, 18: 0.0025}
GAZEBO_SWEEPS = {20: 4e-10, 15: 5e-7, 10: 2e-4, 7: 7e-3, 5: 0.06, 3: 0.42}


def distance(a: Any, b: Any) -> float:
    """Return the maximum distance between two flights logged at the same times (m)."""
    return float(np.linalg.norm(a.position - b.position, axis=1).max())


def doublet(engine: str, dt: float, world: Path, case: Any) -> float:
    """Return the distance from the exact end of the doublet (m)."""
    simulation = qc.Simulation(
        "quadrotor",
        engine,
        world,
        dt,
        parameters={"drone_plugin.dragModel": "chapter2"},
        xacro_args={"sim_slow": 1},
        spawn=(0, 0, 10),
    )
    state = simulation.state.copy()
    state.rotor_velocity[:] = case["initial"]["rotor_velocity"]
    simulation.set_state(state)
    commands = [[row["t"], *row["w"]] for row in case["commands"]]
    end = case["states"][-1]
    log = simulation.run(end["t"], commands, log_every=round(1 / dt))
    return float(np.linalg.norm(log.position[-1] - end["position"]))


def exactness(folder: Path) -> Iterator[Any]:
    """Compare with DOP853 at several steps."""
    case = json.loads((DATA / "exact" / "E1_doublet_all.json").read_text())
    world = folder / "earth.world"
    gravity = case["parameters"]["g"]
    world.write_text(
        f"<sdf version='1.6'><world name='w'><gravity>0 0 -{gravity}</gravity></world></sdf>"
    )
    for dt in (2e-3, 1e-3, 5e-4, 2.5e-4):
        apart = [figures(doublet(engine, dt, world, case)) for engine in ("ode", "eigen")]
        yield f"{dt * 1e3:g} ms", *apart


def tumbling(rate: float, dt: float) -> Any:
    """Simulate two seconds at hover speeds from a rate about no principal axis of the vehicle."""
    simulation = qc.Simulation(
        "quadrotor",
        "eigen",
        dt=dt,
        parameters={"drone_plugin.dragModel": "chapter2"},
        xacro_args={"sim_slow": 1},
        spawn=(0, 0, 10),
    )
    state = simulation.state.copy()
    state.rotor_velocity[:] = HOVER * SPIN
    state.angular_velocity[:] = rate * np.array([0.6, 0.48, 0.64])
    simulation.set_state(state)
    simulation.command(HOVER * SPIN)
    return simulation.run(2.0, log_every=round(1e-2 / dt))


def fourth_order() -> Iterator[Any]:
    """Compare `eigen` with itself at a sixteenth of a ms, for increasing rates."""
    for rate in (5, 10, 20, 40):
        exact = tumbling(rate, 6.25e-5)
        apart = [distance(tumbling(rate, dt), exact) for dt in (2e-3, 1e-3, 5e-4)]
        yield rate, *(figures(one) for one in apart)


def decay(value: float) -> str:
    """Format a decay, or that it is negligible."""
    return figures(value, 3) if abs(value) > 1e-9 else "below 1e-9"


def decays() -> Iterator[Any]:
    """Tabulate the decay of a pitch rate in the first second, and for some in the next one."""
    experiment = Experiment.of(commands=[[0, *HOVER * SPIN]])
    for slow, recorded in GAZEBO_DECAY.items():
        first = measure_damping(experiment, ENGINES, slow, (0, 1))
        then = measure_damping(experiment, LATER, slow, (1, 2))
        found = [decay(first.measured[engine]) for engine in ENGINES]
        later = [decay(then.measured[engine]) for engine in LATER]
        yield slow, figures(first.formula, 3), recorded, *found, *later


def sweeps(folder: Path) -> Iterator[Any]:
    """Tabulate the effect of fewer sweeps in a flight at full speed."""
    case = CASES / "A7_multisine_slow1"
    text = (case / "case.world").read_text()

    def fly(count: int) -> Any:
        world = folder / "sweeps.world"
        world.write_text(text.replace("<iters>50</iters>", f"<iters>{count}</iters>"))
        simulation = qc.Simulation(case / "model.urdf", world=world, spawn=(0, 0, 10))
        return simulation.run(10.0, case / "commands.csv", log_every=10)

    usual = fly(50)
    for count, recorded in GAZEBO_SWEEPS.items():
        yield count, figures(recorded), figures(distance(fly(count), usual))


def main() -> None:
    """Measure and write the tables."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        put("engines.md", "exact", ("step", "`ode`", "`eigen`"), exactness(folder))
        heading = ("rate (rad/s)", "2 ms", "1 ms", "0.5 ms")
        put("engines.md", "order", heading, fourth_order())
        heading = ("sweeps", "real Gazebo", "`gazebo11`")
        put("gazebo.md", "sweeps", heading, sweeps(folder))
    formula = f"formula, {HOVER:g} rad/s / sim_slow"
    heading = ("sim_slow", formula, "real Gazebo", *(f"`{engine}`" for engine in ENGINES))
    later = [f"next second: `{engine}`" for engine in LATER]
    put("gazebo.md", "decay", (*heading, *later), decays())


if __name__ == "__main__":
    main()
