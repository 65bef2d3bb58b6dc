"""What all formats give and take."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict, NamedTuple, Protocol, Sequence, Tuple

import numpy as np


class Table(NamedTuple):
    """Numbers from a file, and how a row is called in an error."""

    rows: np.ndarray
    place: Callable[[int], str]
    counted: str
    """How rows are counted, if that needs to be said."""


Topics = Dict[str, Dict[str, np.ndarray]]


def split_columns(columns: Sequence[str], rows: np.ndarray) -> Tuple[Sequence[str], Topics]:
    """Tell the columns of the state from those of topics, ``TOPIC.FIELD``, which follow them.

    Parameters
    ----------
    columns
        Their names.
    rows
        Shape (n, columns).

    Returns
    -------
    of_state
        Names of the first columns.
    topics
        Topic -> field -> its column, shape (n,).
    """
    topics: Topics = {}
    for i, column in enumerate(columns):
        topic, is_topic, field = column.partition(".")
        if is_topic:
            topics.setdefault(topic, {})[field] = rows[:, i]
    return columns[: len(columns) - sum(map(len, topics.values()))], topics


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
