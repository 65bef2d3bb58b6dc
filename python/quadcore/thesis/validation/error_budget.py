"""Difference from the mathematical model, split by cause.

A chain leads from the plant of the thesis to its model. Each link changes one thing, and the
difference across the link is the share of this change. The vector differences add up to the total
difference at every time.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, cast

import numpy as np

from ...simulation.log import Log
from .experiment import MODEL, Case, Flight


class Link(NamedTuple):
    """Step of a chain from one model to the next."""

    change: str
    begin: Case
    end: Case
    share: float
    """Share of the total difference along its direction, at the time of the chain, m."""
    max: float
    """Maximum difference between the two flights, m."""
    rms: float


class Chain(NamedTuple):
    """Links from an engine with some sim_slow to the model."""

    drag: str
    sim_slow: float
    time: float
    """Time of the maximum difference between the ends of the chain, s."""
    distance: float
    """Difference at this time, m; it is the sum of the shares."""
    links: List[Link]
    failure: str
    """Reason why links are missing; "" for success."""


ORDER = ("gazebo11", "ode", "eigen")
ENGINES = {
    "ode": "the right gyroscopic torque; numbers of the URDF as written",
    "eigen": "reduced coordinates and Runge-Kutta for ODE's first-order step",
}


def list_stages(drag: str, sim_slow: float, plant: str) -> Dict[Case, str]:
    """List the flights of a chain from plant to model, each with the change before it.

    The chain first removes the bugs of the plant at its slowdown, and then the slowdown itself. At
    full speed, the bug of Gazebo would have a much larger effect than in the slowed plant.
    """
    chain = {Case(plant, sim_slow, drag): ""}
    for engine in ORDER[1 + ORDER.index(plant) :]:
        chain[Case(engine, sim_slow, drag)] = ENGINES[engine]
    chain.setdefault(Case("eigen", 1.0, drag), "no slow-down")
    chain[Case("eigen", 1.0, drag, "chapter2")] = "drag model chapter2: parasitic drag as in (2.31)"
    chain[Case("eigen", 1.0, drag, "given speeds")] = "effects that the thesis omits"
    chain[Case(MODEL, 1.0, drag)] = "Euler-Lagrange equations, integrated by DOP853"
    return chain


def make_chain(drag: str, sim_slow: float, plant: str, flights: Mapping[Case, Flight]) -> Chain:
    """Split the difference between a plant and the model; all flights must be complete."""
    chain = list_stages(drag, sim_slow, plant)
    for case in chain:
        if flights[case].log is None:
            return Chain(drag, sim_slow, 0.0, 0.0, [], flights[case].failure)
    logs = [cast(Log, flights[case].log) for case in chain]
    paths = np.array([log.position for log in logs])
    whole = paths[0] - paths[-1]
    row = int(np.linalg.norm(whole, axis=1).argmax())
    distance = float(np.linalg.norm(whole[row]))
    along = paths[:, row] @ (whole[row] / (distance or 1.0))
    apart = np.linalg.norm(np.diff(paths, axis=0), axis=2)
    links = [
        Link(chain[end], begin, end, share, largest, rms)
        for begin, end, share, largest, rms in zip(
            list(chain),
            list(chain)[1:],
            (-np.diff(along)).tolist(),
            apart.max(axis=1).tolist(),
            np.sqrt((apart**2).mean(axis=1)).tolist(),
        )
    ]
    return Chain(drag, sim_slow, float(logs[0].time[row]), distance, links, "")
