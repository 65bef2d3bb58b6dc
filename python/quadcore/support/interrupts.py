"""The signals by which a person, a shell or a batch system asks long work to end.

SIGINT (Ctrl-C), SIGTERM (``kill``, ``timeout``, Slurm, ``docker stop``) and SIGHUP (a terminal that
was closed) are one thing here, an exception that is a KeyboardInterrupt: whatever keeps work when
Ctrl-C is pressed keeps it for all three.
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
"""A process that a signal ended has this status, and more by the number of the signal."""

_HEARD_TWICE = 0.5  # s
_AGAIN = 0.02  # s; until a signal is sent anew that met the start of a module in C


class Interrupted(KeyboardInterrupt):
    """One of `SIGNALS` came.

    Parameters
    ----------
    number : int
        Which.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


def exit_status(stop: KeyboardInterrupt) -> int:
    """Status with which a process that was asked to end does so: 130, 143 or 129."""
    return ENDED + (stop.number if isinstance(stop, Interrupted) else signal.SIGINT)


@contextmanager
def raise_on_signals() -> Iterator[None]:
    """Let each of `SIGNALS` raise `Interrupted` within the block; for the main thread.

    SIGTERM and SIGHUP stay ignored if they are (``nohup``); SIGINT is heard all the same, because
    shells start background jobs with it ignored. Once one was raised, no other is, so that work can
    be kept, but a second Ctrl-C of a person who does not want to wait. What comes within half a
    second is not one: ``timeout`` sends its signal to the process and to its group. Whatever error
    code by others made of it leaves the block as what was raised. While a module in C starts,
    signals wait: some leave the interpreter unable to end when they are cut off.
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
    """Let `SIGNALS` that Python handles wait until the block has ended; a second Ctrl-C does not.

    For what must be done wholly or not at all: a file put in its place, a result taken over. In
    threads other than the main one, where Python runs no handlers, it does nothing.
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
        for number in SIGNALS:
            handler = signal.getsignal(number)
            if callable(handler):
                handlers[number] = handler
                signal.signal(number, hold)
        yield
    finally:
        holding = False
        for changed, handler in handlers.items():
            signal.signal(changed, handler)
    if waiting:
        handlers[waiting[0]](waiting[0], None)
