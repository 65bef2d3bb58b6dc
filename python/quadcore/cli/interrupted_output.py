"""Keeps the results of an interrupted command."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterator

from ..support import interrupts
from . import terminal


@contextmanager
def keep_partial_output(
    attribute: str, out: Path | None, write: Callable[[Any], Any], what: str = "results so far"
) -> Iterator[None]:
    """Write the results that an interrupt of the block carries, and print where they are.

    Parameters
    ----------
    attribute
        Attribute of the KeyboardInterrupt that holds the results. Without it nothing is written.
    out
        Where the results are written; None: nowhere.
    write
        Writes the results.
    what
        Names the results in the message.
    """
    try:
        yield
    except KeyboardInterrupt as stop:
        partial = getattr(stop, attribute, None)
        if out is not None and partial is not None:
            with interrupts.hold_signals():
                write(partial)
            terminal.print_message(f"{what}: {out}")
        raise
