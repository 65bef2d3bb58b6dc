"""Log columns of a user-defined controller: the values in its attribute `log`."""

from __future__ import annotations

from typing import Any, List, Mapping, Sequence

import numpy as np

from .._core import InputError
from ..support.arguments import shorten

TOPIC = "controller"
"""Topic of these columns in the log."""


def list_names(controller: Any) -> List[str]:
    """List the names in the mapping `log` of a controller; empty without this attribute.

    Raises
    ------
    InputError
        If a name is not an identifier.
    """
    log = getattr(controller, "log", None)
    if not isinstance(log, Mapping):
        return []
    for name in log:
        if not (isinstance(name, str) and name.isidentifier()):
            raise InputError(
                f"controller: its log has the key {shorten(name)}. Use names of letters, digits "
                "and underscores."
            )
    return list(log)


class OwnColumns:
    """Values that a controller writes to its `log` at each call.

    Parameters
    ----------
    controller
        Controller. The names that its `log` has now become the columns.
    """

    def __init__(self, controller: Any) -> None:
        self._controller = controller
        self._names = list_names(controller)
        self.clear()

    @property
    def columns(self) -> Sequence[str]:
        """Names of the columns."""
        return [f"{TOPIC}.{name}" for name in self._names]

    def clear(self) -> None:
        """Discard all values."""
        self._times: List[float] = []
        self._rows: List[List[float]] = []

    def note(self, t: float) -> None:
        """Record the current values after a call at time `t` (s).

        Raises
        ------
        InputError
            If the names have changed, or a value is not a number.
        """
        log = self._controller.log
        if list(log) != self._names:
            raise InputError(
                f"controller: its log has {shorten(list(log))} instead of "
                f"{shorten(self._names)}. Set all names in the constructor."
            )
        try:
            self._rows.append([float(value) for value in log.values()])
        except (TypeError, ValueError):
            raise InputError(f"controller: its log is {shorten(log)}. Give numbers.") from None
        self._times.append(t)

    def sample(self, times: np.ndarray) -> np.ndarray:
        """Return the values of the last call before each time; NaN before the first call.

        Parameters
        ----------
        times : ndarray (rows,)
            Times in ascending order, s; later than the times of earlier calls of this method.

        Returns
        -------
        ndarray (rows, names)
        """
        found = np.full((len(times), len(self._names)), np.nan)
        last = np.searchsorted(self._times, times, side="left") - 1
        if len(times) and self._names and last[-1] >= 0:
            found[last >= 0] = np.array(self._rows)[last[last >= 0]]
            del self._times[: last[-1]], self._rows[: last[-1]]
        return found
