"""Many independent cases over several processes."""

from __future__ import annotations

import contextlib
import itertools
import multiprocessing
import os
import signal
import traceback
from multiprocessing.connection import Connection, wait
from typing import Any, Callable, Dict, Generator, Iterable, List, Optional, Tuple, TypeVar, Union

from ._core import QuadcoreError

Case = TypeVar("Case")
Result = TypeVar("Result")

# Forked, so that the caller's data need not be copied and its script need not be importable.
_FORK = multiprocessing.get_context("fork")


def each(
    function: Callable[[Case], Result], cases: Iterable[Case], processes: Optional[int] = None
) -> Generator[Tuple[int, Union[Result, QuadcoreError]], None, None]:
    """Call `function` on every case, in parallel.

    Parameters
    ----------
    function
        Runs in forked processes; may be any callable, its result must be picklable.
    cases
        Taken one by one as processes fall idle, so that they may come from a generator.
    processes
        How many; None takes one per core that this process may use.

    Yields
    ------
    (index, result)
        Of each case, in the order in which they end. A QuadcoreError that `function` raised, and
        one made for a process that died, come in place of the result: the other cases go on.

    Raises
    ------
    RuntimeError
        Anything else that `function` raised, with its traceback.
    """
    queue = enumerate(cases)
    busy: Dict[Connection, Tuple[int, Any]] = {}

    def give(connection: Connection, process: Any) -> None:
        for index, case in itertools.islice(queue, 1):
            busy[connection] = index, process
            with contextlib.suppress(BrokenPipeError):  # recv will tell that it died
                connection.send(case)
            return
        connection.close()  # nothing is left to do: it ends
        process.join()

    try:
        for _ in range(processes or len(os.sched_getaffinity(0))):
            give(*_start(function, list(busy)))
        while busy:
            for connection in wait(list(busy)):
                assert isinstance(connection, Connection)
                index, process = busy.pop(connection)
                try:
                    result, fault = connection.recv()
                except EOFError:
                    process.join()
                    result, fault = QuadcoreError(_death(process.exitcode)), None
                    connection, process = _start(function, list(busy))
                if fault is not None:
                    raise RuntimeError(fault)
                give(connection, process)
                yield index, result
    finally:
        for connection, (_, process) in busy.items():
            process.terminate()
            process.join()
            connection.close()


def _start(function: Callable[[Any], Any], others: List[Connection]) -> Tuple[Connection, Any]:
    here, there = _FORK.Pipe()
    process = _FORK.Process(target=_work, args=(function, there, [here, *others]), daemon=True)
    process.start()
    there.close()
    return here, process


def _work(function: Callable[[Any], Any], pipe: Connection, inherited: List[Connection]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent hears Ctrl-C too and ends us
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    for connection in inherited:  # else nobody would see that the parent is gone
        connection.close()
    with contextlib.suppress(EOFError, BrokenPipeError):
        while True:
            case = pipe.recv()
            outcome: Tuple[Any, Optional[str]]
            try:
                outcome = function(case), None
            except QuadcoreError as error:
                outcome = QuadcoreError(str(error)), None
            except MemoryError:
                outcome = QuadcoreError("no memory left"), None
            except Exception:
                outcome = None, traceback.format_exc()
            pipe.send(outcome)


def _death(exit_code: int) -> str:
    if exit_code < 0:
        return f"its process was ended by {signal.Signals(-exit_code).name}"
    return f"its process ended with status {exit_code}"
