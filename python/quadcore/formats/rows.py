"""What all formats give and take."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, NamedTuple, Protocol

import numpy as np


class Table(NamedTuple):
    """Numbers from a file, and how a row is called in an error."""

    rows: np.ndarray
    place: Callable[[int], str]
    counted: str
    """How rows are counted, if that needs to be said."""


class Recorder(Protocol):
    """What takes over the rows of a flight."""

    wrenches: bool
    """Whether it wants the wrenches."""

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Take over a piece, as `flight.fly` hands it over."""

    def close(self) -> None:
        """Finish, whether all was flown or not."""


class LogFile(Recorder, Protocol):
    """A file that holds a flight."""

    path: Path
