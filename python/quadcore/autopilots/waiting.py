"""Waiting for the answers of an autopilot while its program runs."""

from __future__ import annotations

import time
from typing import Callable, Sequence

import numpy as np

from ..support.warning import warn
from .program import Program

PATIENCE = 2.0
"""Time without an answer after which a warning is issued, s."""


class Waiting:
    """Wait for a single answer.

    Parameters
    ----------
    program : Program
        Program that should answer.
    fail : callable
        Function that makes an error from a reason.
    advice : str, default ""
        Sentence for the warning. Default: the last messages of the program.
    """

    def __init__(
        self, program: Program, fail: Callable[[str], Exception], advice: str = ""
    ) -> None:
        self._program, self._fail, self._advice = program, fail, advice
        self._began = time.perf_counter()
        self._has_warned = False

    def look(self) -> None:
        """Raise an error if the program has ended, and warn once about a long silence."""
        self._program.read_messages()
        if self._program.has_ended():
            raise self._fail(self._program.describe_end())
        if time.perf_counter() - self._began > PATIENCE and not self._has_warned:
            warn(
                f"The autopilot has not answered for {PATIENCE:g} s. quadcore waits for it. "
                f"{self._advice or self._program.describe_messages()}"
            )
            self._has_warned = True


def describe_durations(durations: Sequence[float]) -> str:
    """Describe the number of answers and their durations (s)."""
    if not durations:
        return "no answers"
    median, slow = np.quantile(durations, [0.5, 0.99]) * 1e6
    return f"{len(durations)} answers, median {median:.0f} us, 99 % within {slow:.0f} us"
