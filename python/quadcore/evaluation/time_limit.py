"""A limit of the wall clock for what may never return."""

from __future__ import annotations

import faulthandler
import os
import signal
from contextlib import contextmanager
from typing import Any, Iterator

from .._core import FlightError

_AGAIN = 0.5  # s; who took the exception for one of its own is told once more
_PATIENCE = 5.0  # s; what is not back by then does not run Python, and is ended


class _TimeIsUp(KeyboardInterrupt):
    """Not an Exception, so that a controller that catches those does not go on."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """End the block after some time; for the main thread of a process made for it.

    Parameters
    ----------
    seconds : float
        Of the wall clock.

    Raises
    ------
    FlightError
        The block was not done. If it does not run Python at all, the process ends instead.
    """
    is_up = False

    def end(number: int, frame: Any) -> None:
        nonlocal is_up
        is_up = True
        raise _TimeIsUp

    before = signal.signal(signal.SIGALRM, end)
    with open(os.devnull, "w") as nowhere:
        faulthandler.dump_traceback_later(seconds + _PATIENCE, exit=True, file=nowhere)
        signal.setitimer(signal.ITIMER_REAL, seconds, _AGAIN)
        try:
            yield
        except _TimeIsUp:
            pass
        except Exception:  # what others made of it, an engine for instance
            if not is_up:
                raise
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            faulthandler.cancel_dump_traceback_later()
            signal.signal(signal.SIGALRM, before)
    if is_up:
        raise FlightError(f"not done within the time limit of {seconds:g} s")
