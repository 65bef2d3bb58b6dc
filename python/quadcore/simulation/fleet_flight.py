"""Loop of a flight of several vehicles in one world."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any, List, Optional, Sequence

from .. import _core
from ..support import interrupts
from .commands import CommandsLike, check_commands
from .flight import (
    Pace,
    Pilot,
    Progress,
    Receive,
    advance_in_pieces,
    check_log_every,
    close_at_end,
    count_steps,
)


@dataclass
class FlightOfVehicle:
    """Flight of one vehicle of a fleet.

    Attributes
    ----------
    name : str
        Name of the vehicle.
    simulation : Simulation
        Vehicle.
    receive : callable
        As for `flight.fly`.
    commands, pilot, wrenches, topics
        As for `flight.fly`.
    """

    name: str
    simulation: Any
    receive: Receive
    commands: Optional[CommandsLike] = None
    pilot: Optional[Pilot] = None
    wrenches: bool = False
    topics: Sequence[str] = ()


def fly_fleet(
    fleet: _core.Fleet,
    duration: float,
    flights: Sequence[FlightOfVehicle],
    log_every: int = 1,
    progress: Optional[Progress] = None,
) -> None:
    """Simulate all vehicles of a fleet for a duration, and pass on the rows of each vehicle.

    Parameters
    ----------
    duration, log_every, progress
        As for `Simulation.run`.
    flights
        Flight of each vehicle, in the order of the fleet.

    Raises
    ------
    InputError, FlightError
        As for `flight.fly`. If the commands of a vehicle cause the error, its attribute `vehicle`
        is the name of the vehicle.
    """
    total = count_steps(duration, fleet.dt)
    log_every = check_log_every(log_every)
    with ExitStack() as stack:
        for flight in flights:
            if flight.pilot is not None:
                stack.enter_context(close_at_end(flight.pilot))
                flight.pilot.reset(flight.simulation)
        for flight in flights:
            stack.enter_context(_core.Run(flight.simulation))
        seats = [_Seat(flight, log_every) for flight in flights]
        _advance(fleet, seats, total, log_every, progress)


class _Seat:
    """Flight of a vehicle in the core, and the source of its commands."""

    def __init__(self, flight: FlightOfVehicle, log_every: int) -> None:
        simulation, pilot = flight.simulation, flight.pilot
        table = None
        if flight.commands is not None:
            table = check_commands(flight.commands, simulation.command_width)
        wrenches = flight.wrenches and len(simulation.wrench_terms) > 0
        to_fill = 0 if pilot is None else len(pilot.columns)
        self.core = _core.Flight(simulation, table, log_every, wrenches, flight.topics, to_fill)
        self._prepare = self.core.advance if pilot is None else pilot.begin(simulation, self.core)
        self._flight, self._pilot = flight, pilot

    def prepare(self, steps: int) -> int:
        """Publish the command that is due, and return the steps until the next command."""
        try:
            return self._prepare(steps)
        except Exception as error:
            self._name(error)
            raise

    def hand_over(self) -> None:
        """Pass the new rows on."""
        table, wrenches = self.core.take()
        try:
            if self._pilot is not None:
                self._pilot.fill_columns(table)
        except BaseException as error:
            self._name(error)
            raise
        finally:  # the states are valid even if the columns of the pilot are not
            self._flight.receive(table, wrenches)

    def _name(self, error: BaseException) -> None:
        error.vehicle = self._flight.name  # type: ignore[attr-defined]
        if isinstance(error, _core.InputError):
            error.time = self._flight.simulation.time  # type: ignore[attr-defined]


def _advance(
    fleet: _core.Fleet,
    seats: List[_Seat],
    total: int,
    log_every: int,
    progress: Optional[Progress],
) -> None:
    """Simulate `total` steps in pieces, and pass on the rows of all vehicles."""
    flights = [seat.core for seat in seats]

    def advance(steps: int) -> None:
        while steps > 0:
            now = steps
            for seat in seats:
                now = min(now, seat.prepare(now))
            fleet._advance(now, flights)
            steps -= now

    def hand_over() -> None:
        with interrupts.hold_signals():
            for seat in seats:
                seat.hand_over()

    advance_in_pieces(total, log_every, advance, hand_over, progress, Pace(0, fleet.dt))
