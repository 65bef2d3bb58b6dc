"""Wall-clock limit for code that may never return."""

from __future__ import annotations

import ctypes
import faulthandler
import os
import signal
import threading
from contextlib import contextmanager
from typing import IO, Any, Iterator, List, Optional

from .._core import FlightError

_AGAIN = 0.5  # s; the exception is raised again at this interval, in case user code catches it
_PATIENCE = 5.0  # s; then the process is ended, because it does not run Python code

_report: Optional[IO[bytes]] = None


class _TimeIsUp(KeyboardInterrupt):
    """Exception at the limit; not an Exception subclass, so that user code does not catch it."""


def report_to(stream: IO[bytes]) -> None:
    """Set the file through which another process detects that a limit has ended this process."""
    global _report
    _report = stream


def read_report(stream: IO[bytes]) -> str:
    """Read the message of the time limit that ended a process; "" without a message."""
    stream.seek(0)
    limit, _, traceback = stream.read().decode(errors="replace").partition("\n")
    return _describe(float(limit)) if traceback else ""


def _describe(seconds: float) -> str:
    return f"not done within the time limit of {seconds:g} s"


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Limit the duration of the block.

    Parameters
    ----------
    seconds : float
        Wall-clock limit, s.

    Raises
    ------
    FlightError
        If the limit is exceeded. If the block does not run Python code, a child process is ended
        instead. In any thread but the main thread, the error then waits until the block runs Python
        code again.
    """
    is_main = threading.current_thread() is threading.main_thread()
    expired: List[bool] = []
    with (_alarm if is_main else _watch)(seconds, expired):
        try:
            yield
        except _TimeIsUp:
            pass
        except Exception:  # an engine may have converted the exception
            if not expired:
                raise
    if expired:
        raise FlightError(_describe(seconds))


@contextmanager
def _alarm(seconds: float, expired: List[bool]) -> Iterator[None]:
    """Raise `_TimeIsUp` in the main thread, and end a process that does not respond."""

    def end(number: int, frame: Any) -> None:
        expired.append(True)
        raise _TimeIsUp

    before = signal.signal(signal.SIGALRM, end)
    with open(os.devnull, "wb") as nowhere:
        if _report is not None:
            _report.seek(0)
            _report.truncate()
            _report.write(f"{seconds:g}\n".encode())
            _report.flush()
        file = nowhere if _report is None else _report
        faulthandler.dump_traceback_later(seconds + _PATIENCE, exit=True, file=file)
        signal.setitimer(signal.ITIMER_REAL, seconds, _AGAIN)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            faulthandler.cancel_dump_traceback_later()
            signal.signal(signal.SIGALRM, before)


@contextmanager
def _watch(seconds: float, expired: List[bool]) -> Iterator[None]:
    """Raise `_TimeIsUp` in this thread, which receives no signals."""
    raise_in = ctypes.pythonapi.PyThreadState_SetAsyncExc
    thread = ctypes.c_ulong(threading.get_ident())
    over, turn = threading.Event(), threading.Lock()

    def watch() -> None:
        pause = seconds
        while not over.wait(pause):
            with turn:
                if not over.is_set():
                    expired.append(True)
                    raise_in(thread, ctypes.py_object(_TimeIsUp))
            pause = _AGAIN

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        with turn:
            over.set()
        raise_in(thread, None)  # withdraw a pending exception
        watcher.join()
