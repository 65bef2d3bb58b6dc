"""Monitor for the arming of an autopilot in flight."""

from __future__ import annotations

from typing import Callable, Optional

from .._core import FlightError

_DISARMED = 0.1  # s without output after which an armed autopilot counts as disarmed


class ArmingWatch:
    """Ends a flight if the autopilot does not arm, or disarms in flight.

    Parameters
    ----------
    fail : callable
        Function that makes an error from a time (s) and a reason.
    quote : callable
        Function that quotes the last messages of the autopilot.
    """

    def __init__(self, fail: Callable[[float, str], FlightError], quote: Callable[[], str]) -> None:
        self._fail, self._quote = fail, quote
        self._off_since: Optional[float] = None

    def check(self, t: float, is_wanted: bool, is_armed: bool) -> None:
        """Raise `FlightError` if the autopilot should be armed in flight but is not."""
        if t < 0 or not is_wanted or is_armed:
            self._off_since = None
            return
        if self._off_since is None:
            self._off_since = t
        if t == 0:
            raise self._fail(t, f"the autopilot did not arm. {self._quote()}")
        if t - self._off_since >= _DISARMED:
            raise self._fail(self._off_since, f"the autopilot disarmed. {self._quote()}")
