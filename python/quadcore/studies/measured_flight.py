"""Flying what is to be evaluated, each flight in a process that measures it."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence

import numpy as np

from .._core import FlightError
from ..report.decimation import decimate
from ..simulation.controller_pilot import controller_errors_as_failures
from ..simulation.flight import Rows, columns_of, fly
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import Log
from ..simulation.simulation import Simulation
from ..support.warning import suppress_warnings
from .controller_timing import TimedController, TimedPilot, summarise_durations, time_controller
from .step_response import step_response
from .table import NOT_FLOWN
from .time_limit import time_limit
from .tracking_metrics import UNITS, describe_failure, measure

NAN = dict.fromkeys(UNITS, float("nan"))


class Outcome(NamedTuple):
    """What is known of a flight."""

    failure: str = NOT_FLOWN
    """Why it counts as failed: lost, diverged, no command; "" if it flew."""
    measures: Dict[str, float] = NAN
    """Of `UNITS`; NaN where it failed."""
    seconds: float = float("nan")
    """Of the wall clock."""
    updates: int = 0
    """Of the controller."""
    call: float = float("nan")
    """Median of what an update took, s."""
    slow_call: float = float("nan")
    """What one update of a hundred exceeded, s."""
    rate: float = float("nan")
    """Of the controller, 1/s."""
    delay: float = float("nan")
    """From the controller to the motors, s."""
    warnings: Sequence[str] = ()
    """What was perhaps not meant, as `Simulation.warnings`."""
    log: Optional[Log] = None
    """Thinned, if it was asked for."""
    response: Optional[np.ndarray] = None
    """As `step_response` estimates it, if it was asked for."""
    limit: float = float("inf")
    """Of the rotors, as the log has them, rad/s."""
    rotors: Optional[np.ndarray] = None
    """Where they are in the frame, if it was asked for, m; (n, 3)."""
    refused: bool = False
    """Whether it never flew, being bad input."""

    @property
    def flew(self) -> bool:
        """Whether there is something measured."""
        return not self.failure

    @property
    def was_flown(self) -> bool:
        """Whether it took place, be it that it failed."""
        return self.failure != NOT_FLOWN


def fly_and_measure(
    described: Callable[[], FlightPlan], most: float, keep: bool = False, timed: bool = True
) -> Outcome:
    """Fly and measure.

    Parameters
    ----------
    described
        Gives the flight, guided; that a controller is brought in and made is part of the time.
    most
        Of the wall clock, s.
    keep
        Whether to keep enough of the log to draw it.
    timed
        Whether to clock each update of the controller, which takes a while itself.

    Raises
    ------
    QuadcoreError
        Nothing was flown, or not to its end for want of time.
    """
    started = time.perf_counter()
    failure = ""
    with time_limit(most), suppress_warnings():
        flight = described()
        if timed:
            flight = replace(flight, controller=time_controller(flight.controller))
        simulation = flight.simulation()
        rotors = simulation.rotors
        pilot: Any = flight.pilot(simulation)
        clock = flight.controller
        if timed and not isinstance(clock, TimedController):
            clock = pilot = TimedPilot(pilot)
        topics = _animated_topics(simulation) if keep else []
        rows = Rows(simulation, columns_of(simulation, topics, pilot))
        try:
            with controller_errors_as_failures(simulation):
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
    log = rows.log()
    failure = describe_failure(log) or failure
    measures = NAN
    if not failure:
        share = pilot.saturated / max(1, pilot.updates)
        measures = measure(log, share, rotors)
    outcome = Outcome(
        failure,
        measures,
        time.perf_counter() - started,
        pilot.updates,
        *summarise_durations(clock.seconds if timed else []),
        pilot.rate,
        pilot.delay,
        list(simulation.warnings),
    )
    if not keep:
        return outcome
    response = None if failure else step_response(log)
    limit = min((rotor.max_speed / rotor.slowdown for rotor in rotors), default=np.inf)
    places = np.array([rotor.position for rotor in rotors])
    return outcome._replace(log=decimate(log), response=response, limit=limit, rotors=places)


def _animated_topics(simulation: Simulation) -> List[str]:
    from ..report.player import list_animated_topics  # not every flight should pay for jinja2

    return list_animated_topics(simulation)
