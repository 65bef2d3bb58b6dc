"""Flights of a client, which its requests advance."""

from __future__ import annotations

from contextlib import suppress
from typing import Callable, List, Optional, Sequence

import numpy as np

from .. import _core
from ..formats.rows import Recorder
from ..simulation.simulation import Simulation

_PIECE = 1000  # maximum number of rows in memory
_MOST_STEPS = 1_000_000_000


class ServedFlight:
    """Successive flights of a client; each starts from the initial state of the simulation.

    Parameters
    ----------
    simulation, topics, record, log_every
        As for `Server`.
    check_there
        Function called at intervals during long requests; it raises an error if the client has
        disconnected.
    """

    def __init__(
        self,
        simulation: Simulation,
        topics: Sequence[str],
        record: Optional[Callable[[], Recorder]],
        log_every: int,
        check_there: Callable[[], None],
    ) -> None:
        self._simulation, self._topics = simulation, topics
        self._record, self._log_every = record, log_every
        self._check_there = check_there
        self._recorder: Optional[Recorder] = None
        self._failure: Optional[_core.FlightError] = None
        self._unwritten: Optional[_core.InputError] = None
        self._begin(None)

    def step(self, numbers: Sequence[float]) -> List[float]:
        """Advance the flight, and return the last row.

        Parameters
        ----------
        numbers
            Number of steps, followed by a command (rad/s) or nothing.

        Raises
        ------
        InputError
            If the numbers are invalid. In this case nothing changes.
        FlightError
            If the flight fails or has already failed, or its log cannot be written.
        """
        if not numbers:
            raise _core.InputError(
                "the number of steps is missing. Send it, and a command or nothing."
            )
        steps = _check_whole(numbers[0], "the number of steps", _MOST_STEPS)
        if self._failure is not None:
            raise self._failure
        if steps > 0:
            self._record_from_the_start()
        if len(numbers) > 1:
            self._simulation.command(numbers[1:])
        try:
            for done in range(0, steps, _PIECE):
                if done:
                    self._check_there()
                self._flight.advance(min(_PIECE, steps - done))
                self._take()
        except _core.FlightError as error:
            self._failure = error
            self._take()
            raise
        return self._row

    def reset(self, numbers: Sequence[float]) -> List[float]:
        """Start a new flight, and return its first row.

        Parameters
        ----------
        numbers
            Seed, or nothing to keep the previous seed.

        Raises
        ------
        FlightError
            If the log of the previous flight cannot be written.
        """
        if len(numbers) > 1:
            raise _core.InputError(f"a reset has {len(numbers)} numbers. Send a seed or nothing.")
        seed = _check_whole(numbers[0], "the seed", 2**53) if numbers else None
        before = self._unwritten
        self._finish()
        self._begin(seed)
        if self._unwritten is not before:
            self._failure = _core.FlightError(f"log of the previous flight: {self._unwritten}")
            raise self._failure
        return self._row

    def close(self) -> None:
        """Close the log; raise `InputError` if a log is incomplete."""
        self._finish()
        if self._unwritten is not None:
            raise self._unwritten

    def _finish(self) -> None:
        recorder, self._recorder = self._recorder, None
        if recorder is None:
            return
        try:
            recorder.close()
        except _core.InputError as error:
            self._unwritten = self._unwritten or error

    def _begin(self, seed: Optional[int]) -> None:
        self._simulation.reset(seed)
        self._flight = _core.Flight(self._simulation, None, 1, False, self._topics)
        self._failure = None
        self._rows = 0
        self._take()

    def _take(self) -> None:
        table, wrenches = self._flight.take()
        if len(table) == 0:
            return
        self._row: List[float] = table[-1].tolist()
        begins = self._rows == 0
        logged = table[-self._rows % self._log_every :: self._log_every]
        self._rows += len(table)
        if begins:
            self._first = logged, wrenches
            return
        if self._recorder is not None and len(logged):
            try:
                self._recorder.receive(logged, wrenches)
            except _core.InputError as error:
                self._unwritten = error
                self._finish()
                raise _core.FlightError(f"{error}. The flight has ended.") from error

    def _record_from_the_start(self) -> None:
        """Open the log unless it is open; a flight without steps writes no log."""
        if self._record is None or self._recorder is not None:
            return
        recorder = self._record()
        try:
            recorder.receive(*self._first)
        except _core.InputError:
            with suppress(_core.InputError):
                recorder.close()
            raise
        self._recorder = recorder


def _check_whole(number: float, what: str, largest: int) -> int:
    if not (np.isfinite(number) and 0 <= number <= largest and number == int(number)):
        raise _core.InputError(f"{what} is {number:g}. Give a whole number from 0 to {largest}.")
    return int(number)
