"""Control the height of a quadrotor from Python, like examples/cpp/fly.cpp in C++.

Usage: step_from_python.py [MODEL]
"""

from __future__ import annotations

import sys

import quadcore as qc

HOVER, WANTED = 471, 10  # rad/s, m


def main(model: str = "quadrotor") -> None:
    """Run for 4 s with 100 commands per second."""
    sim = qc.Simulation(model, spawn=(0, 0, 9))
    state = sim.state
    while sim.time < 4:
        w = HOVER * (1 + 0.2 * (WANTED - state.position[2]) - 0.2 * state.linear_velocity[2])
        sim.command([w, -w, w, -w])
        sim.step(10)
    print(f"t = {sim.time:.2f} s, height {state.position[2]:.9f} m")


if __name__ == "__main__":
    main(*sys.argv[1:])
