"""Batches whose methods are called with arrays of odd shapes, types and layouts."""

from __future__ import annotations

import random
from typing import Any, Callable

import numpy as np
import odd

import quadcore as qc

_N = 3


class _Renumbered(qc.BatchSimulation):
    """A subclass that has a number of vehicles of its own."""

    n = 1  # type: ignore[assignment]


class _Flown:
    """A batch at its start, and where three steps lead from there."""

    def __init__(self, kind: Callable[..., qc.BatchSimulation], engine: str) -> None:
        self.batch = kind(n=_N, engine=engine, threads=1)
        self.start = self.batch.snapshot()
        self.batch.step(None, 3)
        self.rows = np.empty((_N, self.batch.state_width))
        self.batch.read_state(self.rows)
        self.width = self.batch.command_width

    def check_undamaged(self) -> None:
        self.batch.restore(self.start)
        self.batch.step(None, 3)
        rows = np.empty_like(self.rows)
        self.batch.read_state(rows)
        assert rows.tobytes() == self.rows.tobytes(), "it flies otherwise"


def target() -> Callable[[random.Random], None]:
    """Make batches of several kinds."""
    kinds = [(qc.BatchSimulation, "eigen"), (qc.BatchSimulation, "gazebo11")]
    kinds += [(qc.BatchSimulation, "ode"), (_Renumbered, "eigen")]
    all_flown = [_Flown(*kind) for kind in kinds]
    foreign = [flown.start for flown in all_flown]

    def run(chance: random.Random) -> None:
        flown = chance.choice(all_flown)
        odd.call(flown.batch.restore, flown.start)
        for _ in range(1 + chance.randrange(3)):
            chance.choice(CALLS)(chance, flown)
        if chance.randrange(8) == 0:
            odd.call(flown.batch.restore, chance.choice([*foreign, odd.value(chance)]))
            flown.check_undamaged()

    return run


def _step(chance: random.Random, flown: _Flown) -> None:
    commands: Any = None
    if chance.randrange(8):
        commands = odd.array(chance, (_N, flown.width))
    steps = chance.choice((0, 1, 2, -1, 1.5, None, "1", 2**63, 2**64))
    odd.call(flown.batch.step, commands, steps)


def _read_state(chance: random.Random, flown: _Flown) -> None:
    out = odd.array(chance, flown.rows.shape)
    odd.call(flown.batch.read_state, out)


def _set_state(chance: random.Random, flown: _Flown) -> None:
    rows: Any = flown.rows.copy()
    if chance.randrange(2):
        rows.flat[chance.randrange(rows.size)] = odd.number(chance)
    else:
        rows = odd.array(chance, rows.shape)
    odd.call(flown.batch.set_state, rows)


def _reset(chance: random.Random, flown: _Flown) -> None:
    mask = chance.choice((None, [True, False, True], odd.array(chance, (_N,)), np.ones(_N, bool)))
    seed = chance.choice((None, 3, odd.array(chance, (_N,)), odd.value(chance), [1, 2, 3]))
    odd.call(flown.batch.reset, mask, seed)


def _reset_core(chance: random.Random, flown: _Flown) -> None:
    """Call the core past the checks of the Python class."""
    flags = chance.choice(([True] * chance.randrange(6), odd.array(chance, (_N,))))
    seeds = np.arange(chance.randrange(6), dtype=np.uint64)
    odd.call(super(qc.BatchSimulation, flown.batch).reset, flags, seeds)


def _read(chance: random.Random, flown: _Flown) -> None:
    batch = flown.batch
    odd.call(batch.warnings, chance.choice((0, 2, 3, -1, odd.value(chance))))
    assert len(batch.time) == len(batch.failures) == len(batch.failed) == _N
    assert repr(batch)


def _run(chance: random.Random, flown: _Flown) -> None:
    log = chance.choice(([0], [2, 1], [3], [-1], [odd.value(chance)], odd.number(chance)))
    duration = chance.choice((0, 0.002, -1, float("nan"), float("inf"), *odd.OTHERS, *odd.TEXTS))
    odd.call(flown.batch.run, duration, None, log)


def _assign(chance: random.Random, flown: _Flown) -> None:
    try:
        flown.batch.n = odd.value(chance)  # type: ignore[misc]
    except AttributeError:
        return
    del flown.batch.__dict__["n"]


CALLS = (_step, _step, _read_state, _set_state, _reset, _reset_core, _read, _run, _assign)
