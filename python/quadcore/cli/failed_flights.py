"""Errors with which commands report failed flights."""

from __future__ import annotations

from typing import Callable, Sequence

from .._core import FlightError, InputError


def report_failures(failures: Sequence[str], refused: int, name: Callable[[int], str]) -> None:
    """Raise `FlightError` if flights failed, or `InputError` if every flight was refused.

    Parameters
    ----------
    failures
        Failure of each flight; "" for success.
    refused
        Number of flights that did not run because of bad input.
    name
        Function that returns the name of a flight from its index.
    """
    failed = [i for i, failure in enumerate(failures) if failure]
    if not failed:
        return
    count, first = len(failures), f"{name(failed[0])}: {failures[failed[0]]}"
    if refused == count:
        raise InputError(f"{count} of {count} flights were refused. The first one: {first}")
    raise FlightError(f"{len(failed)} of {count} flights failed. The first one: {first}")
