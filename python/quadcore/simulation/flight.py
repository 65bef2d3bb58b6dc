"""Loop of a flight, which passes on the logged rows in pieces."""

from __future__ import annotations

import math
import time
from contextlib import contextmanager, nullcontext
from functools import partial
from numbers import Real
from typing import TYPE_CHECKING, Any, Callable, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from .. import _core
from ..support import interrupts
from ..support.arguments import shorten
from ..support.user_code import describe_error
from ..support.warning import warn
from .commands import CommandsLike, check_commands
from .engines import check_wrenches

if TYPE_CHECKING:
    import numpy.typing as npt

Receive = Callable[[np.ndarray, np.ndarray], None]
Progress = Callable[[int, int], None]

_LONGEST = 1e9  # s; maximum duration
_PIECE = 0.02  # s; minimum interval between checks of progress and Ctrl-C
_GROWTH = 256  # maximum growth of a piece over the previous one
_PACED = 0.04  # s; maximum wall-clock duration of a piece of a paced flight
_ROWS = 4096  # maximum number of rows in a piece, so that a piece stays in the cache


class Pilot:
    """Source of the commands of a flight."""

    rate: float
    """Calls of `speeds` per simulated second, 1/s; at most one call per step."""
    delay: float
    """Actuation delay, s; the command of the first call acts at once."""

    columns: Sequence[str] = ()
    """Names of the columns ``TOPIC.FIELD`` that the pilot adds to the log."""
    moves: bool = False
    """Whether the pilot itself moves the vehicle; other callbacks must not do so."""

    def reset(self, simulation: Any) -> None:
        """Prepare for a flight; the simulation is in its initial state."""

    def begin(self, simulation: Any, flight: _core.Flight) -> Callable[[int], int]:
        """Return a function that advances a flight by a number of steps, and returns that number.

        For a vehicle of a fleet, the function publishes the command that is due, and returns the
        number of steps until the next command.
        """
        loop = _core.ControlLoop(flight, self.rate, self.delay)
        limits = np.full(simulation.command_width, np.inf)
        return lambda steps: loop.advance(steps, lambda: self.speeds(simulation), limits)

    def speeds(self, simulation: Any) -> npt.ArrayLike:
        """Return the command that holds until the next call, rad/s."""
        raise NotImplementedError

    def close(self) -> None:
        """Release what `reset` acquired; this is called once after every `reset`."""

    def fill_columns(self, table: np.ndarray) -> None:
        """Fill the columns of the pilot, which are the last columns of the rows."""


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
    pace: float = 0.0,
) -> None:
    """Simulate for a duration, and pass on the logged rows every few hundredths of a second.

    Parameters
    ----------
    duration, commands, log_every, progress
        As for `Simulation.run`.
    receive
        Function called as receive(table, wrenches) with new arrays of shape (rows, columns) and
        (rows, terms, 6). The columns are those of the state, the topics and the pilot. The first
        call contains the current state. If an exception occurs, the last call precedes it.
        Interrupts wait for the call.
    wrenches
        Whether to log wrenches. Otherwise the array of wrenches has no rows.
    pilot
        Source of the commands, instead of a table.
    topics
        Names of topics to log; their columns follow those of the state.
    pace
        Maximum simulated seconds per second of wall-clock time. 0: as fast as possible.

    Raises
    ------
    InputError
        If an argument is invalid or the simulation is already running; in this case nothing is
        simulated. Also if a callback moves the simulation or returns invalid values, which ends the
        flight. The attribute `time` is then the time of the end, s.
    FlightError
        If the flight fails, or the pilot returns an invalid command.
    """
    total, log_every = check_run(simulation, duration, log_every, wrenches)
    table = None if commands is None else check_commands(commands, simulation.command_width)
    wrenches = wrenches and len(simulation.wrench_terms) > 0
    moves = pilot is not None and pilot.moves
    run = nullcontext() if moves else _core.Run(simulation)
    with nullcontext() if pilot is None else close_at_end(pilot):
        if pilot is not None:
            pilot.reset(simulation)  # reset may still change the initial state
        with run:
            to_fill = 0 if pilot is None else len(pilot.columns)
            flight = _core.Flight(simulation, table, log_every, wrenches, topics, to_fill)
            clock = Pace(pace, simulation.dt)
            _advance(simulation, flight, total, log_every, receive, progress, pilot, clock)


def check_run(
    simulation: _core.Simulation, duration: float, log_every: int, wrenches: bool
) -> Tuple[int, int]:
    """Return the numbers of steps and of steps per row; raises `InputError` as `fly` does."""
    if simulation.in_fleet:
        raise _core.InputError("run(): this vehicle belongs to a fleet. Use Fleet.run.")
    if wrenches:
        check_wrenches(simulation.engine)
    return count_steps(duration, simulation.dt), check_log_every(log_every)


class Pace:
    """Clock that limits a flight to the pace of wall-clock time."""

    def __init__(self, pace: float, dt: float) -> None:
        self._seconds_per_step = dt / pace if pace else 0.0
        self._began = time.monotonic()

    def __bool__(self) -> bool:
        return self._seconds_per_step > 0

    def limit(self, steps: int) -> int:
        """Return a number of steps, or fewer if they take longer than the longest piece."""
        return max(1, min(steps, int(_PACED / self._seconds_per_step))) if self else steps

    def wait(self, steps: int) -> None:
        """Wait until the given number of steps is due."""
        ahead = self._began + steps * self._seconds_per_step - time.monotonic()
        if self._seconds_per_step and ahead > 0:
            time.sleep(ahead)


@contextmanager
def close_at_end(pilot: Pilot) -> Iterator[None]:
    """Close the pilot after the block, even after an error; interrupts wait until it is closed."""
    try:
        yield
    except BaseException:
        with interrupts.hold_signals():
            try:
                pilot.close()
            except Exception as error:  # the reason for the end of the flight matters more
                warn(f"controller: its close() failed: {describe_error(error)}")
        raise
    with interrupts.hold_signals():
        pilot.close()


def _advance(
    simulation: _core.Simulation,
    flight: _core.Flight,
    total: int,
    log_every: int,
    receive: Receive,
    progress: Optional[Progress],
    pilot: Optional[Pilot],
    pace: Pace,
) -> None:
    """Simulate `total` steps in pieces, and pass on their rows."""
    advance = flight.advance if pilot is None else pilot.begin(simulation, flight)

    def hand_over() -> None:
        with interrupts.hold_signals():
            table, wrenches = flight.take()
            try:
                if pilot is not None:
                    _call_with_time(simulation, pilot.fill_columns, table)
            finally:  # the states are valid even if the columns of the pilot are not
                receive(table, wrenches)

    act = partial(_call_with_time, simulation, advance)
    advance_in_pieces(total, log_every, act, hand_over, progress, pace)


def advance_in_pieces(
    total: int,
    log_every: int,
    advance: Callable[[int], None],
    hand_over: Callable[[], None],
    progress: Optional[Progress],
    pace: Pace,
) -> None:
    """Simulate `total` steps, with a look at the clock every few hundredths of a second.

    Parameters
    ----------
    advance
        Function that simulates a number of steps.
    hand_over
        Function that passes on the new rows. It is also called at the end, even after an error.
    log_every, progress, pace
        As for `fly`, with a clock for the pace. The last step reports its progress, too.
    """
    most = pace.limit(_ROWS * log_every)
    done, steps, last_report = 0, 1, 0.0
    rows_at, handed_over = 0, time.perf_counter()
    try:
        while done < total:
            steps = min(steps, total - done, most)
            is_late = time.perf_counter() - handed_over >= _PIECE
            if pace or is_late or done + steps - rows_at > most:
                hand_over()
                rows_at, handed_over = done, time.perf_counter()
            pace.wait(done)
            started = time.perf_counter()
            advance(steps)
            done += steps
            now = time.perf_counter()
            if now - started < _PIECE:
                steps *= min(_GROWTH, 1 + int(_PIECE / max(now - started, _PIECE / _GROWTH)))
            if progress is not None and (now - last_report >= _PIECE or done == total):
                progress(done, total)
                last_report = now
    finally:
        hand_over()


def _call_with_time(simulation: _core.Simulation, act: Callable[[Any], Any], given: Any) -> Any:
    """Call a function, and add the simulation time to an `InputError`."""
    try:
        return act(given)
    except _core.InputError as error:
        error.time = simulation.time  # type: ignore[attr-defined]
        raise


def list_columns(
    simulation: _core.Simulation, topics: Sequence[str] = (), pilot: Optional[Pilot] = None
) -> List[str]:
    """List the columns of the rows that `fly` passes on.

    Raises
    ------
    InputError
        If a topic does not exist, or has the name of a column of the pilot.
    """
    columns: List[str] = _core.flight_columns(simulation, topics)
    of_pilot = [] if pilot is None else pilot.columns
    for name in set(topics) & {column.partition(".")[0] for column in of_pilot}:
        raise _core.InputError(f"topic '{name}': the log holds what is flown under this name")
    return columns + list(of_pilot)


def count_steps(duration: float, dt: float) -> int:
    """Count the steps that end within a duration; raise `InputError` if it is invalid."""
    if not (isinstance(duration, Real) and 0 <= duration <= _LONGEST):
        raise _core.InputError(
            f"duration is {shorten(duration)}. Give seconds, from 0 to {_LONGEST:g}."
        )
    steps = math.floor(duration / dt + 1e-6)
    if steps == 0 and duration > 0:
        raise _core.InputError(
            f"duration is {duration:g} s, less than a step of {dt:g} s. Give more."
        )
    return steps


def check_log_every(log_every: object) -> int:
    """Return the number of steps between rows; raise `InputError` if it is invalid."""
    is_whole = isinstance(log_every, (int, np.integer)) and not isinstance(log_every, bool)
    if not is_whole or not 1 <= log_every < 2**63:  # type: ignore[operator]
        raise _core.InputError(f"log_every is {shorten(log_every)}. Give a whole number >= 1.")
    return int(log_every)  # type: ignore[call-overload,no-any-return]


def check_log_length(duration: float, dt: float, log_every: int) -> None:
    """Raise `InputError` if a log would contain only the initial state."""
    steps = count_steps(duration, dt)
    if check_log_every(log_every) > steps:
        raise _core.InputError(
            f"log_every is {log_every} but the flight has {steps} steps. Log more often."
        )
