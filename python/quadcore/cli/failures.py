"""How a command ends when flights failed."""

from __future__ import annotations

from .._core import FlightError, InputError, QuadcoreError


def failure(failed: int, count: int, refused: int, first: str) -> QuadcoreError:
    """Make the error to end with: bad input if that is why none of the flights began.

    Parameters
    ----------
    failed, count
        How many, of how many.
    refused
        How many of those were bad input.
    first
        Which failed first, and why.
    """
    if refused == count:
        return InputError(f"{count} of {count} flights were refused; the first, {first}")
    return FlightError(f"{failed} of {count} flights failed; the first, {first}")
