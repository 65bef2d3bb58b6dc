"""The distance from the mathematical model, split by cause.

A chain leads from the thesis' plant to its model. Each link changes one thing, so that the
difference across it is what that thing costs; the differences add up to the whole, as vectors and
at every instant.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, cast

import numpy as np

from ...simulation.log import Log
from .experiment import MODEL, Case, Flight


class Link(NamedTuple):
    """One step along the chain."""

    change: str
    begin: Case
    end: Case
    share: float
    """m; of the whole distance, along its direction, at the time of the chain."""
    max: float
    """Largest distance between the two flights, m."""
    rms: float


class Chain(NamedTuple):
    """The links from an engine at some sim_slow to the model."""

    drag: str
    sim_slow: float
    time: float
    """When the flights at its ends are farthest apart, s."""
    distance: float
    """How far apart they are then, m: the sum of the links' shares."""
    links: List[Link]
    failure: str
    """Why there are no links."""


ORDER = ("gazebo11", "ode", "eigen")
ENGINES = {
    "ode": "the right gyroscopic torque; numbers of the URDF as written",
    "eigen": "reduced coordinates and Runge-Kutta for ODE's first-order step",
}


def list_stages(drag: str, sim_slow: float, plant: str) -> Dict[Case, str]:
    """Flights of a chain, from the plant to the model, each with what changed before it.

    The plant's faults are repaired at its own slow-down, and only then is the slow-down undone: at
    full speed Gazebo's fault is many times larger than what the slowed plant shows of it.
    """
    chain = {Case(plant, sim_slow, drag): ""}
    for engine in ORDER[1 + ORDER.index(plant) :]:
        chain[Case(engine, sim_slow, drag)] = ENGINES[engine]
    chain.setdefault(Case("eigen", 1.0, drag), "no slow-down")
    chain[Case("eigen", 1.0, drag, "chapter2")] = "drag model chapter2: parasitic drag as in (2.31)"
    chain[Case("eigen", 1.0, drag, "given speeds")] = "what the thesis leaves out of its equations"
    chain[Case(MODEL, 1.0, drag)] = "Euler-Lagrange equations, integrated by DOP853"
    return chain


def make_chain(drag: str, sim_slow: float, plant: str, flights: Mapping[Case, Flight]) -> Chain:
    """Split the distance between a plant and the model, once all flights are there."""
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
