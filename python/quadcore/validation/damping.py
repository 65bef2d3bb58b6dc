"""How fast an engine stops a vehicle from turning that nothing holds: the fault of Gazebo 11.

Gazebo's explicit gyroscopic torque meets each spinning propeller half a step late, by W dt/2 of its
turn. That much of the torque, (Izz - Ixx) W w for a rate w across the axis, points against w:

    decay = sum (Izz - Ixx) W^2 dt / (2 J)

with the sum over the propellers, W their speeds and J the inertia of the whole vehicle. It needs no
air; it is no physics.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..simulation import Simulation
from .experiment import Case, Experiment

_RATE = 0.01  # rad/s


class Damping(NamedTuple):
    """Decay of a small pitch rate in free fall."""

    engine: str
    sim_slow: float
    measured: float
    """1/s"""
    expected: float
    """1/s, of an explicit gyroscopic torque."""


def measure(experiment: Experiment, engine: str, sim_slow: float) -> Damping:
    """Let a vehicle fall and pitch for a second, without air, its rotors spinning as commanded."""
    coefficients = ("rotorThrustCoeff", "rotorTorqueCoeff")
    no_air = {f"{experiment.air}.{coefficient}": 0 for coefficient in coefficients}
    simulation = experiment.simulation(Case(engine, sim_slow, "none"), no_air)
    state = simulation.state.copy()
    state.angular_velocity[1] = _RATE
    simulation.set_state(state)
    simulation.command(experiment.commands[0, 1:])
    log = simulation.run(1.0)
    tilting = np.linalg.norm(log.angular_velocity[:, :2], axis=1)
    measured = -np.polyfit(log.time, np.log(tilting), 1)[0]
    return Damping(engine, sim_slow, float(measured), _expected(simulation))


def _expected(simulation: Simulation) -> float:
    flatness = []
    for link, joint in zip(simulation.model.links[1:], simulation.model.joints):
        axial = joint.axis @ link.inertia @ joint.axis
        flatness.append(axial - (np.trace(link.inertia) - axial) / 2)
    squares = simulation.state.rotor_velocity**2
    return float(flatness @ squares * simulation.dt / (2 * simulation.inertia[1, 1]))
