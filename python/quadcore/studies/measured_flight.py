"""Simulation and metrics of one flight."""

from __future__ import annotations

import time
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence

import numpy as np

from .._core import FlightError
from ..model.visuals import read_vehicle
from ..report.decimation import decimate
from ..report.drawn_vehicle import DrawnVehicle
from ..simulation.clearance import Clearance
from ..simulation.controller_pilot import convert_controller_errors
from ..simulation.flight import fly, list_columns
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import Log
from ..simulation.rows import Rows
from ..simulation.simulation import Simulation
from ..support.warning import suppress_warnings
from .controller_timing import summarise_durations
from .criteria import DEFAULT, Criteria
from .grouped_flights import FlightRecord, fly_group, make_record
from .spectra import Spectra, compute_spectra
from .step_response import step_response
from .table import NOT_FLOWN
from .time_limit import time_limit
from .tracking_errors import sample_flat_states
from .tracking_metrics import UNITS, describe_failure, measure

NAN = dict.fromkeys(UNITS, float("nan"))


class Outcome(NamedTuple):
    """Outcome of a flight."""

    failure: str = NOT_FLOWN
    """Reason for the failure; "" for success."""
    measures: Dict[str, float] = NAN
    """Values of the metrics; NaN after a failure."""
    seconds: float = float("nan")
    """Wall-clock duration, s."""
    updates: int = 0
    """Number of controller updates."""
    call: float = float("nan")
    """Median duration of an update, s."""
    slow_call: float = float("nan")
    """99 % quantile of the duration of an update, s."""
    rate: float = float("nan")
    """Update rate of the controller, 1/s."""
    delay: float = float("nan")
    """Actuation delay, s."""
    warnings: Sequence[str] = ()
    """Warnings, as in `Simulation.warnings`."""
    log: Optional[Log] = None
    """Decimated log; None unless kept."""
    response: Optional[np.ndarray] = None
    """Result of `step_response`; None unless kept."""
    spectra: Optional[Spectra] = None
    """Power spectral densities; None unless the log contains the commands."""
    limit: float = float("inf")
    """Maximum speed of the rotor joints, rad/s."""
    vehicle: Optional[DrawnVehicle] = None
    """Shapes of the vehicle; None unless kept."""
    motion: Optional[np.ndarray] = None
    """Velocity (m/s) and angular velocity (rad/s), decimated, shape (rows, 6); None unless kept."""
    is_vectorized: bool = False
    """Whether the controller commands several vehicles at once."""
    refused: bool = False
    """Whether the input was invalid and the flight did not run."""

    @property
    def flew(self) -> bool:
        """Whether the flight succeeded."""
        return not self.failure

    @property
    def was_flown(self) -> bool:
        """Whether the flight ran, successful or not."""
        return self.failure != NOT_FLOWN


def fly_and_measure(
    described: Callable[[], FlightPlan],
    most: float,
    keep: bool = False,
    timed: bool = True,
    watch: bool = False,
) -> Outcome:
    """Simulate a flight, and compute its metrics; see `fly_alone` and `measure_record`."""
    return measure_record(fly_alone(described, most, keep, timed), keep=keep, watch=watch)


def fly_alone(
    described: Callable[[], FlightPlan],
    most: float,
    keep: bool = False,
    timed: bool = True,
    criteria: Criteria = DEFAULT,
    logs_commands: bool = False,
) -> FlightRecord:
    """Simulate a flight.

    Parameters
    ----------
    described
        Function that returns the plan; the time limit includes this call.
    most
        Wall-clock limit, s.
    keep
        Whether to log the topics of the animation.
    timed
        Whether to time each update of the controller, which slows the flight.
    criteria
        Criteria that determine which data are recorded.
    logs_commands
        Whether to log the commands, which spectra require.

    Raises
    ------
    QuadcoreError
        If the flight cannot start, or exceeds the time limit.
    """
    started = time.perf_counter()
    failure = ""
    with time_limit(most), suppress_warnings():
        flight = described()
        simulation = flight.simulation()
        pilot: Any = flight.pilot(simulation, timed)
        if criteria.needs_estimates:
            pilot.note_estimates()
        topics = _animated_topics(simulation) if keep else []
        commands = simulation.command_topic if logs_commands else ""
        if commands and commands not in topics:
            topics.append(commands)
        rows = Rows(simulation, list_columns(simulation, topics, pilot))
        try:
            with convert_controller_errors(simulation):
                fly(
                    simulation,
                    flight.duration,
                    None,
                    flight.log_every,
                    rows.receive,
                    pilot=pilot,
                    topics=topics,
                )
        except FlightError as error:
            failure = str(error)
        log, flat_states = rows.log(), None
        if criteria.needs_flat_states:
            flat_states = sample_flat_states(flight.simulation(), flight, log.time)
        return make_record(
            pilot,
            simulation.rotors,
            flight,
            log=log,
            flat_states=flat_states,
            command_topic=commands,
            failure=failure,
            calls=pilot.updates,
            saturated=pilot.saturated,
            variation=pilot.variation,
            seconds=pilot.seconds,
            warnings=simulation.warnings,
            elapsed=time.perf_counter() - started,
        )


def measure_record(
    flight: FlightRecord,
    criteria: Criteria = DEFAULT,
    keep: bool = False,
    watch: bool = False,
) -> Outcome:
    """Compute the metrics of a flight; another process may have simulated it.

    Parameters
    ----------
    flight
        Result of `fly_alone` or `fly_group`.
    criteria
        Failure limit, constraints and metrics.
    keep
        Whether to keep the data for plots and animations, such as the decimated log.
    watch
        Whether to keep the decimated velocities.
    """
    log = flight.log
    failure = describe_failure(log, criteria.failure_distance) or flight.failure
    measures = NAN
    if not failure:
        share = flight.saturated / max(1, flight.calls)
        clearance = Clearance(flight.model, flight.world)
        clearance.receive(log.table, np.empty(0))
        measures = {
            **measure(log, share, flight.rotors, flight.variation),
            **clearance.measures(),
            **criteria.measure(flight),
        }
    call, slow_call = summarise_durations(flight.seconds)
    outcome = Outcome(
        failure,
        measures,
        seconds=flight.elapsed,
        updates=flight.calls,
        call=call,
        slow_call=slow_call,
        rate=flight.rate,
        delay=flight.delay,
        warnings=list(flight.warnings),
        is_vectorized=flight.is_vectorized,
    )
    if watch:
        few = decimate(log)
        motion = np.hstack([few.linear_velocity, few.angular_velocity])
        outcome = outcome._replace(motion=motion)
    if not keep:
        return outcome
    response = None if flight.failure else step_response(log)
    spectra = compute_spectra(log, flight.command_topic) if flight.command_topic else None
    with suppress_warnings():
        vehicle = read_vehicle(flight.model)
    return outcome._replace(
        log=decimate(log),
        response=response,
        spectra=spectra,
        limit=flight.limit,
        vehicle=vehicle,
    )


def fly_together(
    described: Sequence[Callable[[], FlightPlan]], most: float, criteria: Criteria = DEFAULT
) -> Optional[List[Outcome]]:
    """Simulate flights on one batch, bit-identical to separate flights, and measure them.

    Parameters
    ----------
    described
        Functions that return the plans.
    most
        Wall-clock limit of each flight, s.
    criteria
        As for `measure_record`.

    Returns
    -------
    list of Outcome, or None
        Outcomes; None if the flights cannot share a batch. Only every 16th update of the
        controllers is timed.
    """
    flights = fly_group(described, most, criteria.needs_flat_states)
    return None if flights is None else [measure_record(flight, criteria) for flight in flights]


def _animated_topics(simulation: Simulation) -> List[str]:
    from ..report.player_flight import list_animated_topics  # jinja2 is slow to import

    return list_animated_topics(simulation)
