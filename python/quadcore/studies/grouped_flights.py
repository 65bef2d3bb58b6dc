"""Flights of built-in or vectorized controllers that run together on one batch."""

from __future__ import annotations

import time
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .. import _core
from .._core import Model, QuadcoreError, Rotor, World
from ..control.built_in import BuiltInController
from ..control.controller import SENSED
from ..control.own_columns import list_names
from ..control.references import Shape
from ..control.vectorized import is_vectorized
from ..simulation.controller_pilot import ControllerPilot
from ..simulation.flight import close_at_end, count_steps
from ..simulation.flight_plan import FlightPlan
from ..simulation.guided_logs import GuidedLogs
from ..simulation.log import Log
from ..simulation.reference_pilot import PluginPilot
from ..simulation.state import State
from ..simulation.trajectory import find_speed_limit
from ..support.warning import suppress_warnings
from .time_limit import time_limit
from .tracking_errors import sample_flat_states
from .tracking_metrics import RotorData

ENGINES = ("eigen", "gazebo11")
"""Engines with batches that step several vehicles per instruction."""

MOST = 64
"""Maximum number of flights in a group, because their logs are in memory together."""

MOST_VECTORIZED = 256
"""Maximum for vectorized controllers; the cost of a call hardly depends on the number."""


class FlightRecord(NamedTuple):
    """Result of a flight with a controller; any process can compute the metrics from it."""

    log: Log
    failure: str
    """Reason for the failure; "" for success."""
    calls: int
    """Number of controller calls."""
    saturated: float
    """Number of calls with a command that the rotors could not follow; NaN if unknown."""
    variation: Optional[Tuple[np.ndarray, np.ndarray]]
    """As in `ControllerPilot.variation`."""
    seconds: np.ndarray
    """Durations of the timed calls, s."""
    warnings: Sequence[str]
    """Warnings, as in `Simulation.warnings`."""
    rate: float
    """Update rate of the controller, 1/s."""
    delay: float
    """Actuation delay, s."""
    is_vectorized: bool
    """Whether the controller commands several vehicles at once."""
    rotors: Sequence[RotorData]
    limit: float
    """Maximum speed of the rotor joints, rad/s."""
    model: Model
    world: World
    elapsed: float = 0.0
    """Wall-clock duration, s."""
    command_topic: str = ""
    """Topic of the commands; "" if the log does not contain it."""
    flat_states: Optional[np.ndarray] = None
    """Result of `sample_flat_states` at the times of the log."""
    estimate_errors: Optional[np.ndarray] = None
    """As in `ControllerPilot.estimate_errors`."""


def make_record(
    pilot: Union[ControllerPilot, PluginPilot],
    rotors: Sequence[Rotor],
    plan: FlightPlan,
    **results: Any,
) -> FlightRecord:
    """Make the record of a flight from its pilot, its rotors and its plan.

    Parameters
    ----------
    pilot, rotors, plan
        Pilot, rotors and plan of the flight or of an equal flight.
    **results
        Other fields of the record.
    """
    return FlightRecord(
        **results,
        rate=pilot.rate,
        delay=pilot.delay,
        is_vectorized=pilot.is_vectorized,
        estimate_errors=pilot.estimate_errors,
        rotors=[RotorData.of(rotor) for rotor in rotors],
        limit=find_speed_limit(rotors),
        model=plan.model,
        world=plan.world,
    )


def fly_group(
    described: Sequence[Callable[[], FlightPlan]], limit: float, needs_flat_states: bool = False
) -> Optional[List[FlightRecord]]:
    """Simulate flights on one batch, bit-identical to separate flights.

    Parameters
    ----------
    described
        Functions that return the plans of the flights.
    limit
        Wall-clock limit of each flight, s.
    needs_flat_states
        Whether the records contain `flat_states`.

    Returns
    -------
    list of FlightRecord, or None
        Results. None if the flights cannot share a batch, or one of them raises an error; separate
        flights then report the error.
    """
    started = time.perf_counter()
    try:
        with time_limit(len(described) * limit), suppress_warnings():
            plans = [describe() for describe in described]
            if not _are_alike(plans):
                return None
            if _are_built_in(plans):
                found = _fly(plans, needs_flat_states)
            elif _differ_in_seed(plans):
                found = _fly_vectorized(plans, needs_flat_states)
            else:
                return None
    except (MemoryError, KeyboardInterrupt):
        raise
    except BaseException:  # SystemExit too, as for single flights
        return None
    each = (time.perf_counter() - started) / len(found)
    return [record._replace(elapsed=each) for record in found]


def share_out(rows: Sequence[int], processes: int) -> List[Sequence[int]]:
    """Split rows into groups small enough to balance the load of the processes."""
    least = 4 * processes
    return split(rows, max(1, min(MOST, len(rows) // least)))


def split(rows: Sequence[int], size: int) -> List[Sequence[int]]:
    """Split rows into groups of this size; the last group may be smaller."""
    return [rows[i : i + size] for i in range(0, len(rows), size)]


def _are_alike(plans: Sequence[FlightPlan]) -> bool:
    """Whether plans differ only in vehicle, seed, controller and reference."""
    first = plans[0]
    return first.engine in ENGINES and all(
        plan.commands is None
        and plan.rotor_velocity is None
        and not plan.wrenches
        and not plan.topics
        and plan.world is first.world
        and all(getattr(plan, name) == getattr(first, name) for name in _SHARED)
        for plan in plans
    )


_SHARED = ("engine", "dt", "duration", "log_every", "on_reference")


def _are_built_in(plans: Sequence[FlightPlan]) -> bool:
    """Whether all controllers and references are built in."""
    return all(
        isinstance(plan.controller, BuiltInController) and isinstance(plan.reference, Shape)
        for plan in plans
    )


def _differ_in_seed(plans: Sequence[FlightPlan]) -> bool:
    """Whether plans differ only in the seed and the instance of a vectorized controller."""
    first = plans[0]
    return all(
        is_vectorized(plan.controller)
        and not list_names(plan.controller)  # user parameters apply to one vehicle
        and plan.model is first.model
        and plan.parameters == first.parameters
        and plan.spawn == first.spawn
        and plan.reference is first.reference
        for plan in plans
    )


class _Kind:
    """Flights that differ only in their seed."""

    def __init__(self, plan: FlightPlan) -> None:
        self.placed: List[State] = []
        simulation = plan.simulation(self.placed)
        if simulation.time != 0:
            raise QuadcoreError("flights in a saved world are simulated alone")
        pilot = plan.pilot(simulation)
        assert isinstance(pilot, ControllerPilot)
        if pilot.is_built_in:
            pilot.reset(simulation)
        self.guide = pilot.built_in if pilot.is_built_in else None
        self.plan, self.pilot = plan, pilot
        self.logs = GuidedLogs(simulation, pilot)
        self.dt = simulation.dt
        self.simulation = simulation  # keeps the simulation alive, because the controller uses it
        self.rotors = simulation.rotors
        self._flat_states: Optional[np.ndarray] = None

    def sample_flat_states(self, times: np.ndarray) -> Optional[np.ndarray]:
        """Return the flat states at these times; all flights have rows at the same times."""
        known = self._flat_states
        if known is None or len(known) < len(times):
            known = self._flat_states = sample_flat_states(self.simulation, self.plan, times)
        return None if known is None else known[: len(times)]


def _make_row(state: State) -> np.ndarray:
    """Convert a state to a row of `BatchSimulation.read_state`."""
    return np.concatenate(
        [
            state.position,
            state.orientation,
            state.linear_velocity,
            state.angular_velocity,
            state.rotor_velocity,
            state.rotor_angle,
        ]
    )


def _identify(plan: FlightPlan) -> Any:
    """Return a key that is equal for flights that differ only in their seed."""
    controller = plan.controller
    return (
        type(plan),
        id(plan.model),
        tuple(sorted(plan.parameters.items())),
        plan.spawn,
        id(plan.reference),
        (controller.name, controller.rate, controller.delay, tuple(controller.spins)),
        (id(controller.belief), tuple(sorted(controller.parameters.items()))),
    )


def _make_batch(plans: Sequence[FlightPlan], kinds: Sequence[_Kind]) -> _core.Batch:
    """Make a batch with each plan in its initial state."""
    first = plans[0]
    batch = _core.Batch(
        [kind.plan.model for kind in kinds],
        first.world,
        first.engine,
        first.dt,
        [dict(kind.plan.parameters) for kind in kinds],
        np.array([plan.spawn for plan in plans]),
        np.array([plan.seed for plan in plans], np.uint64),
        1,
    )
    if len({len(kind.placed) for kind in kinds}) > 1:
        raise QuadcoreError("flights with different numbers of placements are simulated alone")
    for states in zip(*(kind.placed for kind in kinds)):
        batch._take_state(np.array([_make_row(state) for state in states]))
    return batch


def _fly(plans: Sequence[FlightPlan], needs_flat_states: bool) -> List[FlightRecord]:
    first = plans[0]
    found: Dict[Any, _Kind] = {}
    kinds: List[_Kind] = []
    for plan in plans:
        key = _identify(plan)
        if key not in found:
            found[key] = _Kind(plan)
        kinds.append(found[key])
    batch = _make_batch(plans, kinds)
    controllers, references = zip(*(kind.guide for kind in kinds if kind.guide is not None))
    tables, rows, calls, saturated, rates, commands, seconds = batch._follow(
        controllers,
        references,
        np.array([kind.pilot.rate for kind in kinds]),
        np.array([kind.pilot.delay for kind in kinds]),
        SENSED,
        count_steps(first.duration, batch.dt),
        first.log_every,
        range(len(kinds)),
    )
    failures = batch.failures
    logs = [kind.logs.make(tables[i, : rows[i]]) for i, kind in enumerate(kinds)]
    return [
        make_record(
            kind.pilot,
            kind.rotors,
            plans[i],
            log=logs[i],
            flat_states=kind.sample_flat_states(logs[i].time) if needs_flat_states else None,
            failure=failures[i],
            calls=int(calls[i]),
            saturated=int(saturated[i]),
            variation=(rates[i], commands[i]),
            seconds=seconds[i],
            warnings=batch.warnings(i),
        )
        for i, kind in enumerate(kinds)
    ]


def _fly_vectorized(plans: Sequence[FlightPlan], needs_flat_states: bool) -> List[FlightRecord]:
    first, n = plans[0], len(plans)
    kind = _Kind(first)
    with close_at_end(kind.pilot):
        kind.pilot.reset(kind.simulation)
        command_all = kind.pilot.command_all(n)
        batch = _make_batch(plans, [kind] * n)
        tables, rows, rates, commands = batch._follow_together(
            command_all,
            kind.pilot.rate,
            kind.pilot.delay,
            SENSED,
            count_steps(first.duration, batch.dt),
            first.log_every,
        )
    failures = batch.failures
    logs = [kind.logs.make(tables[i, : rows[i]]) for i in range(n)]
    return [
        make_record(
            kind.pilot,
            kind.rotors,
            plans[i],
            log=logs[i],
            flat_states=kind.sample_flat_states(logs[i].time) if needs_flat_states else None,
            failure=failures[i],
            calls=command_all.calls,
            saturated=int(command_all.saturated[i]),
            variation=(rates[i], commands[i]),
            seconds=np.empty(0),
            warnings=batch.warnings(i),
        )
        for i in range(n)
    ]
