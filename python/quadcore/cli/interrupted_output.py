"""What was flown is kept when a command is interrupted."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterator

from ..support import interrupts
from . import terminal


@contextmanager
def keep_partial_output(
    what: str, out: Path | None, write: Callable[[Any], Any], told: str = "what was flown"
) -> Iterator[None]:
    """Write what an interrupt of the block carries, wholly, and say where it is.

    Parameters
    ----------
    what
        Attribute of the KeyboardInterrupt that holds it; without it, nothing is written.
    out
        Where it goes; None: nowhere.
    write
        Called with it.
    told
        What it is.
    """
    try:
        yield
    except KeyboardInterrupt as stop:
        partial = getattr(stop, what, None)
        if out is not None and partial is not None:
            with interrupts.hold_signals():
                write(partial)
            terminal.say(f"{told}: {out}")
        raise
