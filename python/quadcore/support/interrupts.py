"""Signals that request the end of a long computation.

SIGINT (Ctrl-C), SIGTERM (``kill``, ``timeout``, Slurm, ``docker stop``) and SIGHUP (a closed
terminal) raise the same exception, which is a KeyboardInterrupt. Code that saves its work on Ctrl-C
therefore saves it for all three signals.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from contextlib import contextmanager
from importlib.machinery import ExtensionFileLoader
from types import FrameType
from typing import Any, Dict, Iterator, List, Optional

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

ENDED = 128
"""Exit status of a process that a signal ended, minus the number of the signal."""

_HEARD_TWICE = 0.5  # s; signals within this time count as one
_AGAIN = 0.02  # s; delay before a signal during the start of a C module is sent again


class Interrupted(KeyboardInterrupt):
    """Exception for one of `SIGNALS`.

    Parameters
    ----------
    number : int
        Number of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


def exit_status(stop: KeyboardInterrupt) -> int:
    """Return the exit status of an interrupted process: 130, 143 or 129."""
    return ENDED + (stop.number if isinstance(stop, Interrupted) else signal.SIGINT)


@contextmanager
def raise_on_signals() -> Iterator[None]:
    """Raise `Interrupted` for each of `SIGNALS` within the block; use it in the main thread.

    Ignored SIGTERM and SIGHUP stay ignored (``nohup``). SIGINT is always handled, because shells
    start background jobs with ignored SIGINT. After the first signal, only a second Ctrl-C raises
    again, so that work can be saved. Signals within half a second count as one, because ``timeout``
    signals both the process and its group. If other code converts the exception to an error, the
    block still raises `Interrupted`. Signals wait while a C module starts, because the interpreter
    cannot exit after some interrupted module starts.
    """
    raised: List[Interrupted] = []
    first = 0.0

    def raise_it(number: int, frame: Optional[FrameType]) -> None:
        nonlocal first
        if _starts_module_in_c(frame):
            again = threading.Timer(_AGAIN, os.kill, (os.getpid(), number))
            again.daemon = True
            again.start()
            return
        now = time.monotonic()
        if raised and (number != signal.SIGINT or now - first < _HEARD_TWICE):
            return
        first = first or now
        raised.append(Interrupted(number))
        raise raised[-1]

    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        for number in SIGNALS:
            if number == signal.SIGINT or before[number] != signal.SIG_IGN:
                signal.signal(number, raise_it)
        yield
    except Exception as error:
        if raised:
            raise raised[0] from error
        raise
    finally:
        for changed, handler in before.items():
            signal.signal(changed, handler)


def _starts_module_in_c(frame: Optional[FrameType]) -> bool:
    while frame is not None:
        if isinstance(frame.f_locals.get("self"), ExtensionFileLoader):
            return True
        frame = frame.f_back
    return False


@contextmanager
def hold_signals() -> Iterator[None]:
    """Defer `SIGNALS` and SIGALRM until the end of the block, except for a second Ctrl-C.

    Use it for steps that must be complete, such as the replacement of a file. A deferred signal
    takes effect even if the block raises an error, unless that is a KeyboardInterrupt. The block
    has no effect outside the main thread, because Python runs handlers only there.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handlers: Dict[int, Any] = {}
    waiting: List[int] = []
    holding = True

    def hold(number: int, frame: Any) -> None:
        if holding and not (waiting and number == signal.SIGINT):
            waiting.append(number)
        else:
            handlers[number](number, frame)

    try:
        for number in (*SIGNALS, signal.SIGALRM):
            handler = signal.getsignal(number)
            if callable(handler):
                handlers[number] = handler
                signal.signal(number, hold)
        yield
    except KeyboardInterrupt:
        waiting.clear()  # an interrupt ends the block already
        raise
    finally:
        holding = False
        for changed, handler in handlers.items():
            signal.signal(changed, handler)
        if waiting:
            handlers[waiting[0]](waiting[0], None)
