"""Damaged pickles of snapshots, models and worlds: what they hold is changed, at any depth."""

from __future__ import annotations

import copy
import pickle
import random
from pathlib import Path
from typing import Any, Callable, List, Tuple

import numpy as np
import odd

import quadcore as qc

_VEHICLES = Path(__file__).parents[1] / "vehicles"
_PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)


class _Flown:
    """A simulation, what its snapshot holds, and where three steps lead from there."""

    def __init__(self, name: str, engine: str) -> None:
        self.simulation = qc.Simulation(_VEHICLES / f"{name}.urdf", engine, spawn=(0, 0, 0.5))
        self.simulation.step(20)
        self.whole = self.simulation.snapshot()
        self.state = self.whole.__getstate__()
        self.simulation.step(3)
        self.position = self.simulation.state.position.copy()

    def check_undamaged(self, protocol: int) -> None:
        whole = pickle.loads(pickle.dumps(self.whole, protocol))
        self.simulation.restore(whole)
        self.simulation.step(3)
        assert np.array_equal(self.simulation.state.position, self.position), "it flies otherwise"


def target() -> Callable[[random.Random], None]:
    """Make simulations that remember much, and a model and a world."""
    names = ("sensors", "flown", "rotors")
    all_flown = [_Flown(name, engine) for name in names for engine, _ in qc.engines()]
    documents = [qc.read_model(_VEHICLES / "flown.urdf"), qc.read_world("default")]
    states = [(type(read), read.__getstate__()) for read in documents]

    def run(chance: random.Random) -> None:
        if chance.randrange(64) == 0:
            kind, state = chance.choice(states)
            read = _made(kind, damaged(chance, state))
            if isinstance(read, qc.Model):
                odd.call(qc.Simulation, read, "eigen")
            return
        flown = chance.choice(all_flown)
        snapshot = _made(type(flown.whole), damaged(chance, flown.state))
        if snapshot is not None and odd.call(_restored, flown.simulation, snapshot):
            odd.call(flown.simulation.step, 3)
        if chance.randrange(32) == 0:
            flown.check_undamaged(chance.choice(_PROTOCOLS))

    return run


def _restored(simulation: qc.Simulation, snapshot: Any) -> bool:
    simulation.restore(snapshot)
    return True


def _made(kind: type, state: Any) -> Any:
    """Make an object from what was pickled, as pickle does."""
    made = kind.__new__(kind)

    def filled() -> Any:
        made.__setstate__(state)
        return made

    return odd.call(filled)


def damaged(chance: random.Random, state: Any) -> Any:
    """Change one to three things in nested containers and arrays."""
    state = copy.copy(state)
    for _ in range(1 + chance.randrange(3)):
        state = _changed(chance, state)
    return state


def _changed(chance: random.Random, held: Any) -> Any:
    """Give a copy in which one thing differs; what is not on the way to it is shared."""
    if isinstance(held, np.ndarray) and held.dtype == float and held.size and chance.randrange(8):
        other = held.copy()
        other.flat[chance.randrange(other.size)] = float(odd.number(chance))
        return other
    if isinstance(held, dict) and held:
        return _with_changed_item(chance, held)
    if isinstance(held, (list, tuple)) and held and chance.randrange(8):
        items = list(held)
        place = chance.randrange(len(items))
        items[place] = _changed(chance, items[place])
        return type(held)(_with_other_length(chance, items))
    if isinstance(held, str) and held and chance.randrange(4):
        place = chance.randrange(len(held))
        return held[:place] + chance.choice(odd.TEXTS) + held[place + chance.randrange(3) :]
    return odd.value(chance)


def _with_changed_item(chance: random.Random, held: dict) -> dict:
    other = dict(held)
    # What plugins remember breaks most.
    keys: Tuple[Any, ...] = (*held, *[key for key in ("plugins", "messages") if key in held] * 4)
    key = chance.choice(keys)
    if chance.randrange(32) == 0:
        del other[key]
    else:
        other[key] = _changed(chance, held[key])
    return other


def _with_other_length(chance: random.Random, items: List[Any]) -> List[Any]:
    if chance.randrange(16) == 0:
        items.pop(chance.randrange(len(items)))
    elif chance.randrange(16) == 0:
        items.append(odd.value(chance))
    return items
