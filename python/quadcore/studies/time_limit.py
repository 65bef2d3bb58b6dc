"""A limit of the wall clock for what may never return."""

from __future__ import annotations

import ctypes
import faulthandler
import os
import signal
import threading
from contextlib import contextmanager
from typing import Any, Iterator, List

from .._core import FlightError

_AGAIN = 0.5  # s; who took the exception for one of its own is told once more
_PATIENCE = 5.0  # s; what is not back by then does not run Python, and is ended


class _TimeIsUp(KeyboardInterrupt):
    """Not an Exception, so that a controller that catches those does not go on."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """End the block after some time.

    Parameters
    ----------
    seconds : float
        Of the wall clock.

    Raises
    ------
    FlightError
        The block was not done. If it does not run Python at all, the process ends instead, which
        was made for it; a block in another than the main thread is waited for.
    """
    is_main = threading.current_thread() is threading.main_thread()
    told: List[bool] = []
    with (_alarm if is_main else _watch)(seconds, told):
        try:
            yield
        except _TimeIsUp:
            pass
        except Exception:  # what others made of it, an engine for instance
            if not told:
                raise
    if told:
        raise FlightError(f"not done within the time limit of {seconds:g} s")


@contextmanager
def _alarm(seconds: float, told: List[bool]) -> Iterator[None]:
    """Raise `_TimeIsUp` in the main thread, and end a process that does not hear it."""

    def end(number: int, frame: Any) -> None:
        told.append(True)
        raise _TimeIsUp

    before = signal.signal(signal.SIGALRM, end)
    with open(os.devnull, "w") as nowhere:
        faulthandler.dump_traceback_later(seconds + _PATIENCE, exit=True, file=nowhere)
        signal.setitimer(signal.ITIMER_REAL, seconds, _AGAIN)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            faulthandler.cancel_dump_traceback_later()
            signal.signal(signal.SIGALRM, before)


@contextmanager
def _watch(seconds: float, told: List[bool]) -> Iterator[None]:
    """Raise `_TimeIsUp` in this thread, which is none that hears signals."""
    raise_in = ctypes.pythonapi.PyThreadState_SetAsyncExc
    thread = ctypes.c_ulong(threading.get_ident())
    over, turn = threading.Event(), threading.Lock()

    def watch() -> None:
        pause = seconds
        while not over.wait(pause):
            with turn:
                if not over.is_set():
                    told.append(True)
                    raise_in(thread, ctypes.py_object(_TimeIsUp))
            pause = _AGAIN

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        with turn:
            over.set()
        raise_in(thread, None)  # what is on its way
        watcher.join()
