"""Objects of bound classes that no constructor has run for, and old protocols of pickle."""

from __future__ import annotations

import copy
import pickle
import random
from typing import Any, Callable, List

import odd

import quadcore as qc
from quadcore import _core

CLASSES = [
    kind
    for kind in [*vars(_core).values(), qc.Simulation, qc.BatchSimulation]
    if isinstance(kind, type) and not issubclass(kind, Exception)
]
NAMES = {kind: sorted({*dir(kind)} - {"__class__", "__init__"}) for kind in CLASSES}
_REFUSALS = (
    *(qc.QuadcoreError, pickle.PicklingError),
    *(TypeError, AttributeError, ValueError, OverflowError),  # Python's own
)


def target() -> Callable[[random.Random], None]:
    """Make one object of each class that can be made."""
    simulation = qc.Simulation("quadrotor", "eigen")
    built: List[Any] = [simulation, simulation.model, simulation.world, simulation.snapshot()]
    built += [simulation.model.links[0], simulation.model.joints[0], simulation.model.document]
    built += [*simulation.plugins[:1], *simulation.plugins[0].parameters[:1]]
    built += [simulation.topics["odom"], qc.BatchSimulation(n=2), _core.Reference()]
    built += [_core.Run(simulation), _core.Flight(simulation, None, 1)]
    built += [_core.ReferenceShape("hover", {}), simulation.model.ignored_elements]

    def run(chance: random.Random) -> None:
        if chance.randrange(2):
            _use(chance, chance.choice(CLASSES))
        else:
            _reduce(chance, chance.choice(built))

    return run


def _use(chance: random.Random, kind: type) -> None:
    """Read or call something of an object that holds nothing."""
    empty = kind.__new__(kind)
    try:
        held = getattr(empty, chance.choice(NAMES[kind]))
        if callable(held):
            held(*[odd.value(chance) for _ in range(chance.randrange(4))])
        repr(empty)
    except _REFUSALS:
        return


def _reduce(chance: random.Random, built: Any) -> None:
    way = chance.randrange(5)
    try:
        if way == 0:
            pickle.dumps(built, chance.randrange(6))
        elif way == 1:
            copy.copy(built)
        elif way == 2:
            copy.deepcopy(built)
        elif way == 3:
            built.__reduce__()
        else:
            built.__reduce_ex__(chance.randrange(-1, 8))
    except _REFUSALS:
        return
