"""Tags, seeds and poses given as odd numbers, texts and arrays, and references at odd times."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import odd

import quadcore as qc
from quadcore import _core

_VEHICLES = Path(__file__).parents[1] / "vehicles"


def target() -> Callable[[random.Random], None]:
    """Read vehicles, and list the tags that they have."""
    models = [qc.read_model(_VEHICLES / f"{name}.urdf") for name in ("sensors", "flown", "rotors")]
    tagged = [(model, _tags(model)) for model in models]
    shapes = [_shape(name) for name, *_ in _core.references()]
    flown = qc.Simulation(models[1], "eigen", spawn=(0, 0, 0.5))
    start = flown.snapshot()

    def run(chance: random.Random) -> None:
        if chance.randrange(4) == 0:
            return _make(chance, *chance.choice(tagged))
        if chance.randrange(2):
            odd.call(chance.choice(shapes).at, float(chance.choice(odd.NUMBERS)))
            return None
        flown.restore(start)
        return chance.choice(CALLS)(chance, flown)

    return run


def _shape(name: str) -> Any:
    rows = [[0, 0, 0, 1, 0], [1, 1, 0, 1, 0], [2, 1, 1, 1, 0], [3, 0, 1, 1, 0], [4, 0, 0, 1, 0]]
    for given in (None, rows):
        shape = odd.call(_core.ReferenceShape, name, {}, given)
        if shape is not None:
            return shape
    raise AssertionError(f"no reference '{name}'")


def _tags(model: qc.Model) -> List[str]:
    simulation = qc.Simulation(model, "eigen")
    tags = [
        f"{plugin.name}.{tag.name}" for plugin in simulation.plugins for tag in plugin.parameters
    ]
    return [*tags, "frame.mass", "frame.ixx", "propeller1.izz", "odd.tag", "xacro.odd"]


def _make(chance: random.Random, model: qc.Model, tags: List[str]) -> None:
    parameters = {chance.choice(tags): odd.value(chance) for _ in range(1 + chance.randrange(3))}
    others: Dict[str, Any] = {}
    if chance.randrange(4) == 0:
        name = chance.choice(("engine", "dt", "seed", "spawn", "ignore", "xacro_args"))
        others[name] = odd.value(chance)
    if chance.randrange(8) == 0:
        others.update(n=chance.choice((1, 2, 3, odd.value(chance))), threads=1)
        odd.call(qc.BatchSimulation, model, **{"parameters": parameters, **others})
        return
    simulation = odd.call(
        qc.Simulation, model, **{"engine": "eigen", "parameters": parameters, **others}
    )
    if simulation is not None:
        odd.call(simulation.step, 3)


def _command(chance: random.Random, flown: qc.Simulation) -> None:
    odd.call(flown.command, odd.array(chance, (4,)))
    odd.call(flown.step, chance.choice((1, 2, 0, -1, "1", None, 2**63)))


def _publish(chance: random.Random, flown: qc.Simulation) -> None:
    topic = chance.choice((*flown.topics, "no", odd.value(chance)))
    odd.call(flown.publish, topic, odd.array(chance, (chance.choice((1, 3, 4, 6)),)))
    odd.call(flown.topic, topic)
    odd.call(flown.step, 1)


def _set_state(chance: random.Random, flown: qc.Simulation) -> None:
    state = flown.state.copy()
    name = chance.choice(("time", "position", "orientation", "rotor_velocity", "rotor_angle"))
    shape: Tuple[int, ...] = getattr(state, name).shape if name != "time" else ()
    setattr(state, name, chance.choice((odd.value(chance), odd.array(chance, shape))))
    odd.call(flown.set_state, state)
    odd.call(flown.step, 1)


def _log(chance: random.Random, flown: qc.Simulation) -> None:
    odd.call(_core.csv_rows, odd.array(chance, (2, 5)))
    odd.call(_core.fault_of_commands, odd.array(chance, (2, 5)))


CALLS = (_command, _publish, _set_state, _log)
