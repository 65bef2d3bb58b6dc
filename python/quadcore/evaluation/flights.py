"""Flying what is to be evaluated, each flight in a process that measures it."""

from __future__ import annotations

import time
import warnings
from typing import Dict, NamedTuple, Optional, Sequence

import numpy as np

from .._core import FlightError
from ..controller import faults_told
from ..flight import Rows, columns_of, fly
from ..flight_plan import FlightPlan
from ..log import Log
from ..study.sampling import thinned
from ..warning import QuadcoreWarning
from .measures import UNITS, drag_power, lost, measure, slow_down
from .step_response import step_response
from .time_limit import time_limit


class Outcome(NamedTuple):
    """What is known of a flight."""

    failure: str
    """Why it counts as failed: lost, diverged, no command; "" if it flew."""
    measures: Dict[str, float]
    """Of `UNITS`; NaN where it failed."""
    seconds: float
    """Of the wall clock."""
    updates: int
    """Of the controller."""
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


NAN = dict.fromkeys(UNITS, float("nan"))


def flown(flight: FlightPlan, most: float, keep: bool = False) -> Outcome:
    """Fly and measure.

    Parameters
    ----------
    flight
        Guided.
    most
        Of the wall clock, s.
    keep
        Whether to keep enough of the log to draw it.

    Raises
    ------
    QuadcoreError
        Nothing was flown, or not to its end for want of time.
    """
    started = time.perf_counter()
    failure = ""
    with time_limit(most), warnings.catch_warnings():
        warnings.simplefilter("ignore", QuadcoreWarning)  # they are kept
        simulation = flight.simulation()
        pilot = flight.pilot(simulation)
        assert pilot is not None
        rows = Rows(simulation, columns_of(simulation, (), pilot))
        try:
            with faults_told(simulation):
                fly(
                    simulation,
                    flight.duration,
                    None,
                    flight.log_every,
                    rows.receive,
                    wrenches=False,
                    pilot=pilot,
                )
        except FlightError as error:
            failure = str(error)
    log = rows.log()
    away = lost(log)
    if away is not None:
        failure = f"lost at t = {away:.6g} s"
    measures = NAN
    if not failure:
        share = pilot.saturated / max(1, pilot.updates)
        measures = measure(log, share, drag_power(simulation))
    seconds = time.perf_counter() - started
    outcome = Outcome(failure, measures, seconds, pilot.updates, list(simulation.warnings))
    if not keep:
        return outcome
    response = None if failure else step_response(log)
    limit = pilot.limit / slow_down(simulation)
    rotors = simulation.model.joint_places
    return outcome._replace(log=thinned(log), response=response, limit=limit, rotors=rotors)
