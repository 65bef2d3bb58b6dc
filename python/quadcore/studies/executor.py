"""Parallel execution of independent cases in several processes."""

from __future__ import annotations

import collections
import contextlib
import ctypes
import gc
import itertools
import multiprocessing
import os
import signal
import tempfile
import traceback
from multiprocessing.connection import Connection, wait
from typing import (
    IO,
    Any,
    Callable,
    Dict,
    Iterable,
    Iterator,
    List,
    Optional,
    Tuple,
    TypeVar,
    Union,
)

from .._core import InputError, QuadcoreError
from ..support import interrupts
from ..support.user_code import describe_error
from . import time_limit

Case = TypeVar("Case")
Result = TypeVar("Result")
Take = Callable[[int, Union[Any, QuadcoreError]], Any]
Progress = Callable[[int, int], None]
Task = Tuple[Callable[[Any], Any], Callable[[Any], Any]]

# Fork: the child needs no copy of the caller's data and does not import its script.
_FORK = multiprocessing.get_context("fork")

_PATIENCE = 10.0  # s; time that a process has to end
_PR_SET_PDEATHSIG = 1  # constant of linux/prctl.h


def count_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def run_cases(
    function: Callable[[Case], Result],
    cases: Iterable[Case],
    take: Take,
    processes: Optional[int] = None,
    conclude: Callable[[Result], Any] = lambda result: result,
    apart: bool = False,
) -> None:
    """Call `function` on every case, in parallel.

    Parameters
    ----------
    function
        Callable that runs in forked processes; its result must be picklable. On an interrupt it
        receives `interrupts.Interrupted`, so that it can clean up.
    cases
        Cases, possibly from a generator. Each idle process takes the next case.
    take
        Function called as take(index, result) for each case, in the order of completion. If
        `function` raises a QuadcoreError or its process dies, the result is a QuadcoreError, and
        the other cases continue. An interrupt waits for `take`.
    processes
        Number of processes. None: one per usable core. Fewer run if there are fewer cases, or if
        the system cannot start all of them.
    conclude
        Function called with the result in the same process; its return value replaces the result.
        An interrupt waits until `take` has received the result. Therefore a file written by
        `conclude` exists if and only if the result does.
    apart
        Whether each case runs in a separate process, a copy of this one, so that cases share no
        state.

    Raises
    ------
    KeyboardInterrupt
        On an interrupt, after `take` has received the available results. No process remains, even
        if this process dies or `take` raises.
    QuadcoreError
        If the system cannot start a process.
    RuntimeError
        If `function` raises any other exception; the message contains the traceback. See
        `contain_errors`.
    """
    pool = _WorkerPool(function, conclude, cases, apart)
    try:
        pool.start(processes or count_cores())
        while pool.busy:
            for connection in wait(list(pool.busy)):
                with interrupts.hold_signals():
                    take(*pool.take(connection))
    except KeyboardInterrupt:
        with interrupts.hold_signals():
            for outcome in pool.stop():
                take(*outcome)
        raise
    finally:
        collections.deque(pool.stop(), maxlen=0)


def run_contained(
    function: Callable[[Case], Result],
    cases: Iterable[Case],
    take: Take,
    processes: Optional[int] = None,
    conclude: Callable[[Any], Any] = lambda result: result,
    progress: Optional[Progress] = None,
    apart: bool = False,
) -> None:
    """Call `run_cases` so that an exception fails only its own case.

    Parameters
    ----------
    progress
        Function called as progress(done, total) after each `take`; `cases` must have a length.
    """
    done = 0

    def take_and_report(index: int, outcome: Any) -> None:
        nonlocal done
        take(index, outcome)
        done += 1
        if progress is not None:
            progress(done, len(cases))  # type: ignore[arg-type]

    run_cases(
        contain_errors(function), cases, take_and_report, processes, contain_errors(conclude), apart
    )


def call_apart(function: Callable[[], Result]) -> Result:
    """Call a function in a separate process, and return its result, which must be picklable.

    Raises
    ------
    QuadcoreError
        If the function raises an exception, or its process dies.
    KeyboardInterrupt
        If the user interrupts; no process remains in this case.
    """
    outcomes: List[Any] = []
    run_contained(lambda _: function(), [0], lambda _, outcome: outcomes.append(outcome), 1)
    if isinstance(outcomes[0], QuadcoreError):
        raise outcomes[0]
    result: Result = outcomes[0]
    return result


def contain_errors(function: Callable[[Case], Result]) -> Callable[[Case], Result]:
    """Make `function` raise QuadcoreError instead of any other exception."""

    def call(case: Case) -> Result:
        try:
            return function(case)
        except (QuadcoreError, MemoryError, KeyboardInterrupt):
            raise
        except BaseException as error:  # includes SystemExit: user code must not end the study
            raise QuadcoreError(describe_error(error)) from error

    return call


class ProcessDied(QuadcoreError):
    """Error of a case with a process that died."""

    def __init__(self, exit_code: int, reason: str = "") -> None:
        super().__init__(reason or _describe_death(exit_code))
        self.was_killed = exit_code < 0
        """Whether a signal ended the process, possibly for a reason unrelated to the case."""


class _WorkerPool:
    """Pool of processes that run cases."""

    def __init__(
        self,
        function: Callable[[Any], Any],
        conclude: Callable[[Any], Any],
        cases: Iterable[Any],
        apart: bool,
    ) -> None:
        self._task = function, conclude
        self._apart = apart
        self._queue: Iterator[Tuple[int, Any]] = enumerate(cases)
        self.busy: Dict[Connection, Tuple[int, Any]] = {}
        """Index of the running case and the process, by pipe."""

    def start(self, processes: int) -> None:
        """Start up to this number of processes, each with a case."""
        for _ in range(processes):
            with interrupts.hold_signals():
                if not self._replace():
                    break

    def take(self, connection: Any) -> Tuple[int, Any]:
        """Receive a result from a pipe, and send the next case."""
        index, process = self.busy.pop(connection)
        try:
            result, fault = connection.recv()
        except (EOFError, OSError):
            connection.close()
            process.join()
            reason = time_limit.read_report(process.report)
            process.report.close()
            self._replace()
            return index, ProcessDied(process.exitcode, reason)
        if fault is not None:
            self.busy[connection] = index, process  # so that stop() ends it
            raise RuntimeError(fault)
        if self._apart:
            connection.close()
            _join(process)
            self._replace()
        else:
            self._give(connection, process)
        return index, result

    def stop(self) -> Iterator[Tuple[int, Any]]:
        """End all processes, and yield the completed results."""
        for _, process in self.busy.values():
            process.terminate()
        while self.busy:
            connection, (index, process) = self.busy.popitem()
            with contextlib.suppress(EOFError, OSError):
                if connection.poll(_PATIENCE):
                    result, fault = connection.recv()
                    if fault is None:
                        yield index, result
            connection.close()
            process.join(_PATIENCE)
            if process.exitcode is None:
                process.kill()
            _join(process)

    def _replace(self) -> bool:
        """Start a process with the next case; return False without a case or if it cannot start."""
        case = next(self._queue, None)
        if case is None:
            return False
        try:
            connection, process = _start(self._task, list(self.busy))
        except OSError as error:
            if not self.busy:
                raise QuadcoreError(f"no process can be started: {error.strerror}") from error
            self._queue = itertools.chain([case], self._queue)
            return False
        self._send(connection, process, *case)
        return True

    def _give(self, connection: Connection, process: Any) -> None:
        """Send the next case to an idle process, which ends if no case remains."""
        case = next(self._queue, None)
        if case is not None:
            self._send(connection, process, *case)
            return
        connection.close()
        _join(process)

    def _send(self, connection: Connection, process: Any, index: int, case: Any) -> None:
        self.busy[connection] = index, process
        with contextlib.suppress(BrokenPipeError):  # recv reports the dead process
            connection.send(case)


def _join(process: Any) -> None:
    """Wait until a process ends."""
    process.join()
    process.report.close()


def _start(task: Task, others: List[Connection]) -> Tuple[Connection, Any]:
    here, there = _FORK.Pipe()
    report = tempfile.TemporaryFile()  # noqa: SIM115  (open while the process runs)
    process: Any = _FORK.Process(
        target=_run_worker, args=(task, there, [here, *others], os.getpid(), report), daemon=True
    )
    process.report = report
    # Block signals until the child has installed its handlers.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, interrupts.SIGNALS)
    try:
        process.start()
    except OSError:
        here.close()
        raise
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        there.close()
    return here, process


def _run_worker(
    task: Task, pipe: Connection, inherited: List[Connection], parent: int, report: IO[bytes]
) -> None:
    gc.freeze()  # the parent's objects: no search for garbage visits or copies them
    try:
        _set_signals(parent)
        time_limit.report_to(report)
        for connection in inherited:  # so that the pipes close when the parent dies
            connection.close()
        _serve(*task, pipe)
    except interrupts.Interrupted as stop:  # cleanup is complete
        signal.signal(stop.number, signal.SIG_DFL)
        os.kill(os.getpid(), stop.number)


def _serve(
    function: Callable[[Any], Any], conclude: Callable[[Any], Any], pipe: Connection
) -> None:
    with contextlib.suppress(EOFError, BrokenPipeError, ConnectionResetError):
        while True:
            result, fault = _call(function, pipe.recv())
            with interrupts.hold_signals():
                if fault is None and not isinstance(result, QuadcoreError):
                    result, fault = _call(conclude, result)
                pipe.send((result, fault))


def _call(function: Callable[[Any], Any], argument: Any) -> Tuple[Any, Optional[str]]:
    """Return the result or a QuadcoreError, and the traceback of any other exception or None."""
    try:
        return function(argument), None
    except InputError as error:
        return InputError(str(error)), None
    except QuadcoreError as error:
        return QuadcoreError(str(error)), None
    except MemoryError:
        return QuadcoreError("no memory left"), None
    except Exception:
        return None, traceback.format_exc()


def _set_signals(parent: int) -> None:
    """Ignore Ctrl-C and a closed terminal, which the parent handles; SIGTERM ends the process."""

    def end(number: int, _: Any) -> None:
        signal.signal(number, signal.SIG_IGN)  # the signal may arrive twice
        raise interrupts.Interrupted(number)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, end)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, interrupts.SIGNALS)
    # The kernel sends SIGTERM if the parent is killed.
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGTERM), 0, 0, 0)
    if os.getppid() != parent:
        raise interrupts.Interrupted(signal.SIGTERM)


def _describe_death(exit_code: int) -> str:
    if exit_code >= 0:
        return f"its process ended with status {exit_code}"
    try:
        return f"its process was ended by {signal.Signals(-exit_code).name}"
    except ValueError:  # most real-time signals have no name
        return f"its process was ended by signal {-exit_code}"
