"""Spurious damping of rotations in an engine, which is a bug in Gazebo 11.

Gazebo applies the explicit gyroscopic torque to each propeller half a step late, after a rotation
by W dt/2. For a rate w across the axis, this misdirects a fraction of the torque (Izz - Ixx) W w so
that it opposes w:

    decay = sum (Izz - Ixx) W^2 dt / (2 J)

The sum is over the propellers, W is their speed, and J is the inertia of the whole vehicle. The
damping occurs without air and is not physical.
"""

from __future__ import annotations

from typing import Dict, NamedTuple, Sequence, Tuple

import numpy as np

from ..._core import QuadcoreError
from ...simulation.simulation import Simulation
from .experiment import Case, Experiment

_RATE = 0.01  # rad/s
_SETTLED = (0.1, 1.0)  # s; when the hinges of ODE settle, the rate drops once


class Damping(NamedTuple):
    """Decay of a small pitch rate in free fall."""

    sim_slow: float
    formula: float
    """Decay rate from the formula for the explicit gyroscopic torque, 1/s."""
    measured: Dict[str, float]
    """Measured decay rate of each engine, 1/s; engines with a failed flight are omitted."""


def measure_damping(
    experiment: Experiment,
    engines: Sequence[str],
    sim_slow: float,
    window: Tuple[float, float] = _SETTLED,
) -> Damping:
    """Measure the decay of a pitch rate in free fall without air, at the first commanded speeds.

    Parameters
    ----------
    window
        Interval in which the decay of the pitch rate is measured, s.
    """
    case = Case("eigen", sim_slow, "none")
    measured = {}
    for engine in engines:
        try:
            measured[engine] = _measure_decay(
                _fall(experiment, case._replace(plant=engine)), *window
            )
        except QuadcoreError:  # the rows of its flights contain the reason
            continue
    return Damping(sim_slow, _compute_decay(_fall(experiment, case)), measured)


def _fall(experiment: Experiment, case: Case) -> Simulation:
    coefficients = ("rotorThrustCoeff", "rotorTorqueCoeff")
    no_air = {f"{experiment.air}.{coefficient}": 0 for coefficient in coefficients}
    simulation = experiment.flight(case, no_air).simulation()
    state = simulation.state.copy()
    state.angular_velocity[1] = _RATE
    simulation.set_state(state)
    simulation.command(experiment.commands[0, 1:])
    return simulation


def _measure_decay(simulation: Simulation, begin: float, end: float) -> float:
    log = simulation.run(end)
    first = int(np.searchsorted(log.time, begin - 1e-9))
    tilting = np.linalg.norm(log.angular_velocity[[first, -1], :2], axis=1)
    return float(np.log(tilting[0] / tilting[1]) / (log.time[-1] - log.time[first]))


def _compute_decay(simulation: Simulation) -> float:
    flatness = []
    for link, joint in zip(simulation.model.links[1:], simulation.model.joints):
        axial = joint.axis @ link.inertia @ joint.axis
        flatness.append(axial - (np.trace(link.inertia) - axial) / 2)
    squares = simulation.state.rotor_velocity**2
    return float(flatness @ squares * simulation.dt / (2 * simulation.inertia[1, 1]))
