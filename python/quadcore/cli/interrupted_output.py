"""Output of the partial results of an interrupted command."""

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
    """Write the results in an interrupt of the block, and print their location.

    Parameters
    ----------
    attribute
        Attribute of the KeyboardInterrupt that contains the results. Without it, nothing is
        written.
    out
        Location of the results. None: nothing is written.
    write
        Function that writes the results.
    what
        Name of the results in the message.
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
