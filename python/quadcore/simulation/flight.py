"""A flight in pieces, whose rows go where they belong as they come."""

from __future__ import annotations

import math
import time
from collections import deque
from contextlib import nullcontext
from numbers import Real
from typing import TYPE_CHECKING, Any, Callable, Deque, List, Optional, Protocol, Sequence, Tuple

import numpy as np

from .. import _core
from ..support import interrupts
from ..support.arguments import shorten
from .commands import CommandsLike, check_commands
from .engines import check_wrenches
from .log import Log
from .trajectory import per_command

if TYPE_CHECKING:
    import numpy.typing as npt

Receive = Callable[[np.ndarray, np.ndarray], None]
Progress = Callable[[int, int], None]

_LONGEST = 1e9  # s
_ROUNDING = 1e-6  # of a pilot's period
_PIECE = 0.02  # s, at least; what is flown between two looks at progress and Ctrl-C
_ROWS = 4096  # of a piece, at most; it stays in the cache until its rows are where they belong


class Pilot(Protocol):
    """What commands a flight as it goes."""

    rate: float
    """How often it is asked, 1/s; at most once a step."""
    delay: float
    """From an answer to the first step that it commands, s; the first one commands at once."""

    columns: Sequence[str] = ()
    """Names of what it tells of its own, beside the state, ``TOPIC.FIELD``."""
    moves: bool = False
    """Whether it moves the vehicle itself, which what a flight calls back may not."""

    def reset(self, simulation: Any) -> None:
        """Begin; the `Simulation` stands at its first step."""

    def speeds(self, simulation: Any) -> npt.ArrayLike:
        """Give the command for the steps until it is asked again, rad/s."""

    def add_columns(self, table: np.ndarray) -> np.ndarray:
        """Add its columns to rows of a log."""
        return table


def fly(
    simulation: _core.Simulation,
    duration: float,
    commands: Optional[CommandsLike],
    log_every: int,
    receive: Receive,
    wrenches: bool = False,
    progress: Optional[Progress] = None,
    pilot: Optional[Pilot] = None,
    topics: Sequence[str] = (),
) -> None:
    """Fly for a while and hand over what is logged, every few hundredths of a second.

    Parameters
    ----------
    duration, commands, log_every, progress
        As for `Simulation.run`.
    receive
        Called as receive(table, wrenches) with new arrays of shape (rows, 14 + n + those of the
        topics and of the pilot) and (rows, terms, 6), first with the present state, and with the
        last rows before anything is raised. An interrupt waits for it.
    wrenches
        Whether to log them; else their array has no rows.
    pilot
        Commands in place of a table.
    topics
        Names of topics to log, too: columns that follow those of the state.

    Raises
    ------
    InputError
        An argument is at fault, or a run flies the simulation already; nothing was flown. Or what
        is called back moves the simulation, or gives what it may not, which ends the flight; when
        the pilot did it is the error's attribute `time`, s.
    FlightError
        The flight failed, or what the pilot gave was no command, be it at the start.
    """
    if wrenches:
        check_wrenches(simulation.engine)
    total = count_steps(duration, simulation.dt)
    log_every = _check_log_every(log_every)
    table = None if commands is None else check_commands(commands, simulation.command_width)
    wrenches = wrenches and len(simulation.wrench_terms) > 0
    moves = pilot is not None and pilot.moves
    run = nullcontext() if moves else _core.Run(simulation)
    if pilot is not None:
        pilot.reset(simulation)  # which may yet put the vehicle where it is to begin
    with run:
        flight = _core.Flight(simulation, table, log_every, wrenches, topics)
        _advance(simulation, flight, total, _ROWS * log_every, receive, progress, pilot)


def _advance(
    simulation: _core.Simulation,
    flight: _core.Flight,
    total: int,
    most: int,
    receive: Receive,
    progress: Optional[Progress],
    pilot: Optional[Pilot],
) -> None:
    """Fly so many steps, in pieces of so many at most."""
    advance = flight.advance if pilot is None else _PilotedFlight(simulation, flight, pilot).advance

    def hand_over() -> None:
        with interrupts.hold_signals():
            table, wrenches = flight.take()
            try:
                whole = (
                    table
                    if pilot is None
                    else _call_with_time(simulation, pilot.add_columns, table)
                )
            except BaseException:  # what was flown is known even so
                beside = 0 if pilot is None else len(pilot.columns)
                receive(np.hstack([table, np.full((len(table), beside), np.nan)]), wrenches)
                raise
            receive(whole, wrenches)

    done, steps, told = 0, 1, 0.0
    try:
        while done < total:
            hand_over()
            steps = min(steps, total - done, most)
            started = time.perf_counter()
            _call_with_time(simulation, advance, steps)
            done += steps
            now = time.perf_counter()
            if now - started < _PIECE:
                steps *= 2
            if progress is not None and (now - told >= _PIECE or done == total):
                progress(done, total)
                told = now
    finally:
        hand_over()


def _call_with_time(simulation: _core.Simulation, act: Callable[[Any], Any], given: Any) -> Any:
    """Call, and add to bad input the time at which it ended the flight, as a `FlightError` has."""
    try:
        return act(given)
    except _core.InputError as error:
        error.time = simulation.time  # type: ignore[attr-defined]
        raise


class _PilotedFlight:
    """A flight whose pilot is asked whenever a step begins at which it is due."""

    def __init__(self, simulation: _core.Simulation, flight: _core.Flight, pilot: Pilot) -> None:
        self._simulation, self._flight, self._pilot = simulation, flight, pilot
        command = simulation.topics.get(simulation.command_topic)
        self._takes_commands = command is not None and command.writer is None
        # By the count of steps: the sum of their times would slip.
        self._per_step = pilot.rate * simulation.dt
        self._delay = math.ceil(pilot.delay / simulation.dt - _ROUNDING)
        self._under_way: Deque[Tuple[int, npt.ArrayLike]] = deque()
        self._steps = 0
        self._due = 0

    def advance(self, steps: int) -> None:
        end = self._steps + steps
        while self._steps < end:
            if self._steps == self._due:
                speeds = self._pilot.speeds(self._simulation)
                arrives = self._steps + (self._delay if self._steps > 0 else 0)
                self._under_way.append((arrives, speeds))
                asked = math.floor(self._steps * self._per_step + _ROUNDING)
                next_time = math.ceil((asked + 1 - _ROUNDING) / self._per_step)
                self._due = max(next_time, self._steps + 1)
            while self._under_way and self._under_way[0][0] <= self._steps:
                self._command(self._under_way.popleft()[1])
            arrival = self._under_way[0][0] if self._under_way else end
            piece = min(self._due, arrival, end) - self._steps
            self._flight.advance(piece)
            self._steps += piece

    def _command(self, speeds: npt.ArrayLike) -> None:
        try:
            self._flight.command(speeds)
        except _core.InputError as error:
            if not self._takes_commands:  # not what was given is at fault
                raise
            simulation, fault = self._simulation, str(error).partition(". Give")[0]
            failure = _core.FlightError(
                f"the flight failed at t = {simulation.time:f} s: the controller returned "
                f"{shorten(speeds)}: {fault}. Return {simulation.command_width} rotor speeds in "
                "rad/s."
            )
            failure.time = simulation.time
            raise failure from error


def list_columns(
    simulation: _core.Simulation, topics: Sequence[str] = (), pilot: Optional[Pilot] = None
) -> List[str]:
    """Name the columns of what `fly` hands over.

    Raises
    ------
    InputError
        A topic that is none, or that goes by the name of what the pilot tells.
    """
    columns: List[str] = _core.flight_columns(simulation, topics)
    told = [] if pilot is None else pilot.columns
    for name in set(topics) & {column.partition(".")[0] for column in told}:
        raise _core.InputError(f"topic '{name}': the log holds what is flown under this name")
    return columns + list(told)


class Rows:
    """Collects what `fly` hands over; without memory for more it keeps what it has."""

    def __init__(self, simulation: _core.Simulation, columns: Sequence[str]) -> None:
        self._columns = list(columns)
        self._terms = simulation.wrench_terms
        self._ignored = simulation.ignored
        self._per_command = per_command(simulation)
        self._count = 0
        self._table = np.empty((0, len(self._columns)))
        self._wrenches = np.empty((0, len(self._terms), 6))
        self._with_wrenches = False

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Take over a piece."""
        end = self._count + len(table)
        _grow(self._table, end)
        self._table[self._count : end] = table
        if len(wrenches):
            self._with_wrenches = True
            _grow(self._wrenches, end)
            self._wrenches[self._count : end] = wrenches
        self._count = end

    def log(self) -> Log:
        """Give what came so far."""
        wrenches = self._wrenches[: self._count]
        named = {name: wrenches[:, i] for i, name in enumerate(self._terms)}
        log = Log.of_rows(
            self._table[: self._count],
            self._columns,
            named if self._with_wrenches else {},
            self._ignored,
        )
        log.per_command = self._per_command
        return log


def _grow(array: np.ndarray, rows: int) -> None:
    """Make room for so many rows and some more, where the array lies if possible."""
    if rows <= len(array):
        return
    # By realloc, which moves large blocks without copying them.
    try:
        array.resize((rows + rows // 8, *array.shape[1:]), refcheck=False)
    except MemoryError:
        array.resize((rows, *array.shape[1:]), refcheck=False)


def count_steps(duration: float, dt: float) -> int:
    """Count the steps that end within a duration; raises `InputError` if it is none."""
    if not (isinstance(duration, Real) and 0 <= duration <= _LONGEST):
        raise _core.InputError(
            f"duration is {shorten(duration)}; give seconds, from 0 to {_LONGEST:g}"
        )
    steps = math.floor(duration / dt + 1e-6)
    if steps == 0 and duration > 0:
        raise _core.InputError(
            f"duration is {duration:g} s, less than a step of {dt:g} s; nothing would fly"
        )
    return steps


def _check_log_every(log_every: object) -> int:
    """Check after how many steps a log has a row."""
    is_whole = isinstance(log_every, (int, np.integer)) and not isinstance(log_every, bool)
    if not is_whole or not 1 <= log_every < 2**63:  # type: ignore[operator]
        raise _core.InputError(f"log_every is {shorten(log_every)}; give a whole number >= 1")
    return int(log_every)  # type: ignore[call-overload,no-any-return]


def check_log_length(duration: float, dt: float, log_every: int) -> None:
    """Raise `InputError` if a log would hold the start alone: nothing could be told from it."""
    steps = count_steps(duration, dt)
    if _check_log_every(log_every) > steps:
        raise _core.InputError(
            f"log_every is {log_every} but the flight has {steps} steps; log more often"
        )
