"""The error with which a command ends when flights failed."""

from __future__ import annotations

from typing import Callable, Sequence

from .._core import FlightError, InputError


def report_failures(failures: Sequence[str], refused: int, name: Callable[[int], str]) -> None:
    """Raise `FlightError` if flights failed, or `InputError` if every flight was refused.

    Parameters
    ----------
    failures
        Reason of each failed flight, "" for the others.
    refused
        Number of flights that bad input prevented.
    name
        Names a flight, by its position.
    """
    failed = [i for i, failure in enumerate(failures) if failure]
    if not failed:
        return
    count, first = len(failures), f"{name(failed[0])}: {failures[failed[0]]}"
    if refused == count:
        raise InputError(f"{count} of {count} flights were refused. The first one: {first}")
    raise FlightError(f"{len(failed)} of {count} flights failed. The first one: {first}")
