"""How a command ends when flights failed."""

from __future__ import annotations

from typing import Callable, Sequence

from .._core import FlightError, InputError


def report_failures(failures: Sequence[str], refused: int, name: Callable[[int], str]) -> None:
    """Raise the error to end with if flights failed: bad input if none of them began.

    Parameters
    ----------
    failures
        Reason of each flight, "" if it flew.
    refused
        How many of them were bad input.
    name
        Names a flight, by its position.
    """
    failed = [i for i, failure in enumerate(failures) if failure]
    if not failed:
        return
    count, first = len(failures), f"{name(failed[0])}: {failures[failed[0]]}"
    if refused == count:
        raise InputError(f"{count} of {count} flights were refused; the first, {first}")
    raise FlightError(f"{len(failed)} of {count} flights failed; the first, {first}")
