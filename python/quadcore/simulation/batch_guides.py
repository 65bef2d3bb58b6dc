"""Controllers and references of the vehicles of a batch."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Sequence, Union

import numpy as np

from .. import _core
from .._core import InputError
from ..control.built_in import BuiltInController
from ..control.controller import SENSED, ControllerLike
from ..control.keywords import ReferenceName
from ..control.own_columns import list_names
from ..control.references import ReferenceLike
from ..support.warning import suppress_warnings
from .batch_vehicles import Vehicles
from .controller_pilot import ControllerPilot
from .flight import close_at_end
from .guided_logs import GuidedLogs
from .simulation import Simulation, make_simulation

ControllerOfAll = Union[ControllerLike, Sequence[ControllerLike]]
"""A controller for all vehicles, or one controller per vehicle."""

ReferenceOfAll = Union[ReferenceLike, ReferenceName, None, Sequence[Union[ReferenceLike, str]]]
"""A reference for all vehicles, or one reference per vehicle."""


class Guide(NamedTuple):
    """Pilot of a vehicle, the simulation that it uses, and the logs of its flights."""

    pilot: ControllerPilot
    simulation: Simulation
    logs: GuidedLogs


def make_guides(
    vehicles: Vehicles,
    engine: str,
    dt: float,
    controller: ControllerOfAll,
    reference: ReferenceOfAll,
) -> List[Guide]:
    """Make the guide of each vehicle; equal vehicles with the same controller share a guide.

    Raises
    ------
    InputError
        If a controller or reference is invalid, or their number differs from the number of
        vehicles.
    """
    n = len(vehicles.models)
    controllers = _repeat("controller", controller, n)
    references = _repeat("reference", reference, n)
    made: Dict[Any, Guide] = {}
    guides = []
    for model, tags, chosen, wanted in zip(vehicles.models, vehicles.tags, controllers, references):
        key = id(model), tuple(sorted(tags.items())), id(chosen), id(wanted)
        if key not in made:
            made[key] = _make_guide(model, tags, vehicles.world, engine, dt, chosen, wanted)
        guides.append(made[key])
    return guides


def _repeat(name: str, given: Any, n: int) -> List[Any]:
    if not isinstance(given, (list, tuple)):
        return [given] * n
    if len(given) != n:
        raise InputError(
            f"{name} lists {len(given)} values for {n} vehicles. Give one of all, or {n}."
        )
    return list(given)


def _make_guide(
    model: _core.Model,
    tags: Dict[str, str],
    world: _core.World,
    engine: str,
    dt: float,
    controller: Any,
    reference: Any,
) -> Guide:
    with suppress_warnings():  # the batch has already issued these warnings
        simulation = make_simulation(engine, model=model, world=world, parameters=tags, dt=dt)
    if isinstance(controller, BuiltInController):
        controller = controller.copy()  # a reset applies to one vehicle
    pilot = ControllerPilot(controller, simulation, reference)
    if pilot.is_vectorized and list_names(controller):
        raise InputError(
            "controller: its log has the values of one vehicle, but a batch has several. Remove "
            "its log, or use Simulation.run."
        )
    if pilot.is_built_in:
        pilot.reset(simulation)
    return Guide(pilot, simulation, GuidedLogs(simulation, pilot))


def follow(
    batch: _core.Batch, guides: Sequence[Guide], steps: int, log: Sequence[int], log_every: int
) -> List[np.ndarray]:
    """Advance a batch with the pilots of its guides; return the rows of the logged vehicles.

    Raises
    ------
    InputError
        If a controller or reference is neither built in nor vectorized for all vehicles, or a
        vehicle is not in its initial state.
    """
    pilots = [guide.pilot for guide in guides]
    if all(pilot.is_built_in for pilot in pilots):
        names, references = zip(*(pilot.built_in for pilot in pilots))
        rates, delays = (
            np.array([getattr(pilot, name) for pilot in pilots]) for name in ("rate", "delay")
        )
        logged = list(dict.fromkeys(log))
        tables, rows, *_ = batch._follow(
            names, references, rates, delays, SENSED, steps, log_every, logged
        )
        table_of = dict(zip(logged, tables))
        return [table_of[vehicle][: rows[vehicle]] for vehicle in log]
    if len(set(map(id, pilots))) > 1 or not pilots[0].is_vectorized:
        raise InputError(
            "controller: a batch takes built-in controllers with built-in references, or one "
            "controller with vectorized = True for equal vehicles. Use Simulation.run for others."
        )
    pilot = pilots[0]
    with close_at_end(pilot):
        pilot.reset(guides[0].simulation)
        tables, rows, *_ = batch._follow_together(
            pilot.command_all(batch.n), pilot.rate, pilot.delay, SENSED, steps, log_every
        )
    return [tables[vehicle][: rows[vehicle]] for vehicle in log]
