"""Many independent cases over several processes."""

from __future__ import annotations

import collections
import contextlib
import ctypes
import itertools
import multiprocessing
import os
import signal
import traceback
from multiprocessing.connection import Connection, wait
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Tuple, TypeVar, Union

from .._core import InputError, QuadcoreError
from ..support import interrupts
from ..support.user_code import describe_error

Case = TypeVar("Case")
Result = TypeVar("Result")
Take = Callable[[int, Union[Any, QuadcoreError]], Any]
Progress = Callable[[int, int], None]
Task = Tuple[Callable[[Any], Any], Callable[[Any], Any]]

# Forked, so that the caller's data need not be copied and its script need not be importable.
_FORK = multiprocessing.get_context("fork")

_PATIENCE = 10.0  # s; how long a process that was asked to end may take
_PR_SET_PDEATHSIG = 1  # of linux/prctl.h


def count_cores() -> int:
    """Count the cores that this process may use."""
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
        Runs in forked processes; may be any callable, its result must be picklable. An interrupt
        reaches it as `interrupts.Interrupted`, so that it can leave nothing half done.
    cases
        Taken one by one as processes fall idle, so that they may come from a generator.
    take
        Called as take(index, result) for each case, in the order in which they end. A QuadcoreError
        that `function` raised, without what it carries, and one made for a process that died, come
        in place of the result: the other cases go on. An interrupt waits for it.
    processes
        How many; None takes one per core that this process may use. Fewer if the system gives no
        more.
    conclude
        Called on the result, in the same process, for what stands in its place. An interrupt waits
        until that is done and the outcome was taken: a file that `conclude` writes is there if and
        only if the outcome is.
    apart
        Whether each case has a process of its own, which begins as this one is now: nothing that
        `function` leaves behind, be it in the globals of a module, is there for another case.

    Raises
    ------
    KeyboardInterrupt
        After the results that were there already. No process is left, as none is left when this
        process dies or `take` raises.
    QuadcoreError
        The system gives not even one process.
    RuntimeError
        Anything else that `function` raised, with its traceback; see `contained`.
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
    """Do as `each` does, but with any fault its case's alone.

    Parameters
    ----------
    progress
        Called as progress(done, total) after each outcome was taken; `cases` has a length then.
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


def contain_errors(function: Callable[[Case], Result]) -> Callable[[Case], Result]:
    """Make `function` raise QuadcoreError for any fault, so that it is one case's alone."""

    def call(case: Case) -> Result:
        try:
            return function(case)
        except (QuadcoreError, MemoryError, KeyboardInterrupt):
            raise
        except BaseException as error:  # SystemExit, too: it is not for code that flies to end all
            raise QuadcoreError(describe_error(error)) from error

    return call


class ProcessDied(QuadcoreError):
    """The process of a case died."""

    def __init__(self, exit_code: int) -> None:
        super().__init__(_describe_death(exit_code))
        self.was_killed = exit_code < 0
        """Whether by a signal, which may well have had nothing to do with the case."""


class _WorkerPool:
    """Processes that work on cases."""

    def __init__(
        self,
        function: Callable[[Any], Any],
        conclude: Callable[[Any], Any],
        cases: Iterable[Any],
        apart: bool,
    ) -> None:
        self._task = function, conclude
        self._apart = apart
        self._queue = enumerate(cases)
        self.busy: Dict[Connection, Tuple[int, Any]] = {}
        """Index of the case and process, by the end of its pipe."""

    def start(self, processes: int) -> None:
        """Start so many, or as many as the system gives, each with a case."""
        for _ in range(processes):
            with interrupts.hold_signals():
                if not self._replace():
                    break

    def take(self, connection: Any) -> Tuple[int, Any]:
        """Take over the result that waits in a pipe, and give the process the next case."""
        index, process = self.busy.pop(connection)
        try:
            result, fault = connection.recv()
        except (EOFError, OSError):
            connection.close()
            process.join()
            self._replace()
            return index, ProcessDied(process.exitcode)
        if fault is not None:
            self.busy[connection] = index, process  # to be ended
            raise RuntimeError(fault)
        if self._apart:
            connection.close()
            process.join()
            self._replace()
        else:
            self._give(connection, process)
        return index, result

    def stop(self) -> Iterator[Tuple[int, Any]]:
        """End all, and yield what some had finished."""
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
                process.join()

    def _replace(self) -> bool:
        """Start one more process; without success the others go on alone, if there are any."""
        try:
            self._give(*_start(self._task, list(self.busy)))
        except OSError as error:
            if not self.busy:
                raise QuadcoreError(f"no process can be started: {error.strerror}") from error
            return False
        return True

    def _give(self, connection: Connection, process: Any) -> None:
        for index, case in itertools.islice(self._queue, 1):
            self.busy[connection] = index, process
            with contextlib.suppress(BrokenPipeError):  # recv will tell that it died
                connection.send(case)
            return
        connection.close()  # nothing is left to do: it ends
        process.join()


def _start(task: Task, others: List[Connection]) -> Tuple[Connection, Any]:
    here, there = _FORK.Pipe()
    process = _FORK.Process(
        target=_run_worker, args=(task, there, [here, *others], os.getpid()), daemon=True
    )
    # What comes before the child is ready waits for it, instead of finding the parent's handlers.
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


def _run_worker(task: Task, pipe: Connection, inherited: List[Connection], parent: int) -> None:
    try:
        _set_signals(parent)
        for connection in inherited:  # else nobody would see that the parent is gone
            connection.close()
        _serve(*task, pipe)
    except interrupts.Interrupted as stop:  # everything is left as it should be
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
    """Give the result or the QuadcoreError in its place, and the traceback of any other fault."""
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
    """Leave Ctrl-C and a closed terminal to the parent, which hears them too; end when told to."""

    def end(number: int, _: Any) -> None:
        signal.signal(number, signal.SIG_IGN)  # its group and its parent may both tell
        raise interrupts.Interrupted(number)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, end)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, interrupts.SIGNALS)
    # A parent that is killed outright tells nobody: the kernel does.
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
