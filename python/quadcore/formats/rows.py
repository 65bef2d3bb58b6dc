"""Data that all formats exchange."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict, List, Mapping, NamedTuple, Optional, Protocol, Sequence, Tuple

import numpy as np

from .._core import InputError, log_columns

_ROUNDNESS = 1e-2
"""Accepted deviation of the norm of a quaternion from 1, for logs with few digits."""

_WRENCH = ("fx", "fy", "fz", "tx", "ty", "tz")


class Table(NamedTuple):
    """Numbers from a file, and functions for messages about its rows."""

    rows: np.ndarray
    place: Callable[[int], str]
    counted: str
    """Remark on the numbering of rows, or ""."""


class LogRows(NamedTuple):
    """Contents of a log file; see `Trajectory`."""

    columns: Sequence[str]
    """Columns of the state, then ``TOPIC.FIELD``."""
    rows: np.ndarray
    wrenches: Mapping[str, np.ndarray]
    ignored: Sequence[str]


Topics = Dict[str, Dict[str, np.ndarray]]


def split_columns(columns: Sequence[str], rows: np.ndarray) -> Tuple[Sequence[str], Topics]:
    """Split the columns of the state from the columns ``TOPIC.FIELD`` that follow.

    Parameters
    ----------
    columns
        Names of the columns.
    rows
        Rows of the log, shape (n, columns).

    Returns
    -------
    of_state
        Names of the columns of the state.
    topics
        Columns by topic and field, shape (n,).
    """
    topics: Topics = {}
    for i, column in enumerate(columns):
        topic, is_topic, field = column.partition(".")
        if is_topic:
            topics.setdefault(topic, {})[field] = rows[:, i]
    return columns[: len(columns) - sum(map(len, topics.values()))], topics


def list_wrench_columns(terms: Sequence[str]) -> List[str]:
    """List the columns of wrenches; there are six per wrench, after all other columns."""
    return [f"wrench_{term}.{field}" for term in terms for field in _WRENCH]


def find_wrench_terms(columns: Sequence[str]) -> List[str]:
    """Return the names of the wrenches from the columns at the end of a list."""
    terms: List[str] = []
    for end in range(len(columns), len(_WRENCH) - 1, -len(_WRENCH)):
        six = list(columns[end - len(_WRENCH) : end])
        term = six[0].partition(".")[0][len("wrench_") :]
        if six != list_wrench_columns([term]):
            break
        terms.insert(0, term)
    return terms


def append_wrenches(table: np.ndarray, wrenches: Optional[np.ndarray]) -> np.ndarray:
    """Append wrenches (rows, terms, 6), unless None, to a table (rows, columns)."""
    if wrenches is None:
        return table
    return np.hstack([table, wrenches.reshape(len(table), len(_WRENCH) * wrenches.shape[1])])


def check_log_columns(place: str, columns: Sequence[str]) -> int:
    """Count the columns of the state; raise `InputError` if the columns are not those of a log."""
    of_state = [column for column in columns if "." not in column]
    fixed = log_columns(0)
    expected = log_columns(max(0, len(of_state) - len(fixed)))
    if list(columns[: len(expected)]) != expected:
        raise InputError(
            f"{place}: this is not a log: the columns are '{','.join(columns)[:80]}'. "
            f"Use '{','.join(fixed)}', a column per rotor, then those of topics."
        )
    return len(expected)


def check_log_rows(place: Callable[[int], str], rows: np.ndarray, of_state: int) -> None:
    """Raise `InputError` if the rows cannot be those of a flight.

    Parameters
    ----------
    place
        Function that returns the name of a row in messages.
    rows
        Rows of the log, shape (n, columns).
    of_state
        Number of columns of the state; other columns may be NaN.
    """
    if len(rows) == 0:
        raise InputError(f"{place(0)}: the log has no rows. Write one for the start at least.")
    wrong = ~np.isfinite(rows[:, :of_state]).all(axis=1)
    if wrong.any():
        raise InputError(f"{place(int(wrong.argmax()))}: the state is not finite. Correct the row.")
    where = log_columns(0).index("qx")
    turned = np.abs(np.linalg.norm(rows[:, where : where + 4], axis=1) - 1) > _ROUNDNESS
    if turned.any():
        raise InputError(
            f"{place(int(turned.argmax()))}: the orientation is no unit quaternion qx, qy, qz, qw"
        )
    late = np.diff(rows[:, 0]) <= 0
    if late.any():
        raise InputError(f"{place(1 + int(late.argmax()))}: the time is not later than before")


class Recorder(Protocol):
    """Receiver of the logged rows of a flight."""

    wrenches: bool
    """Whether the recorder needs wrenches."""

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Receive a piece of rows; see `flight.fly`."""

    def close(self) -> None:
        """Finish recording, even if the flight is incomplete."""


class LogFile(Recorder, Protocol):
    """Recorder that writes to a file."""

    path: Path
