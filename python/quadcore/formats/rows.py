"""What all formats give and take."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict, List, Mapping, NamedTuple, Optional, Protocol, Sequence, Tuple

import numpy as np

from .._core import InputError, log_columns

_ROUNDNESS = 1e-2
"""By which the length of a quaternion may differ from 1 in logs with few digits."""

_WRENCH = ("fx", "fy", "fz", "tx", "ty", "tz")


class Table(NamedTuple):
    """Numbers from a file, and how a row is called in an error."""

    rows: np.ndarray
    place: Callable[[int], str]
    counted: str
    """How rows are counted, if that needs to be said."""


class LogRows(NamedTuple):
    """What a file holds of a flight; see `Trajectory`."""

    columns: Sequence[str]
    """Those of the state, then TOPIC.FIELD."""
    rows: np.ndarray
    wrenches: Mapping[str, np.ndarray]
    ignored: Sequence[str]


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


def list_wrench_columns(terms: Sequence[str]) -> List[str]:
    """Name the columns of wrenches where they stand in rows: behind all others, six of each."""
    return [f"wrench_{term}.{field}" for term in terms for field in _WRENCH]


def find_wrench_terms(columns: Sequence[str]) -> List[str]:
    """Name the wrenches whose columns are the last of these."""
    terms: List[str] = []
    for end in range(len(columns), len(_WRENCH) - 1, -len(_WRENCH)):
        six = list(columns[end - len(_WRENCH) : end])
        term = six[0].partition(".")[0][len("wrench_") :]
        if six != list_wrench_columns([term]):
            break
        terms.insert(0, term)
    return terms


def append_wrenches(table: np.ndarray, wrenches: Optional[np.ndarray]) -> np.ndarray:
    """Put wrenches (rows, terms, 6), if any, behind the columns of a table (rows, columns)."""
    if wrenches is None:
        return table
    return np.hstack([table, wrenches.reshape(len(table), len(_WRENCH) * wrenches.shape[1])])


def check_log_columns(place: str, columns: Sequence[str]) -> int:
    """Count those of the state; raises `InputError` unless these are the columns of a log."""
    of_state = [column for column in columns if "." not in column]
    fixed = log_columns(0)
    expected = log_columns(max(0, len(of_state) - len(fixed)))
    if list(columns[: len(expected)]) != expected:
        raise InputError(
            f"{place}: no log of quadcore: the columns are '{','.join(columns)[:80]}'; "
            f"a log has '{','.join(fixed)}', a column of each rotor, and those of topics"
        )
    return len(expected)


def check_log_rows(place: Callable[[int], str], rows: np.ndarray, of_state: int) -> None:
    """Raise `InputError` unless the rows are those of a flight; `place` is called with a row.

    Parameters
    ----------
    place
        How a row is called.
    rows
        Shape (n, columns).
    of_state
        How many columns are the state's; those of topics may be NaN.
    """
    if len(rows) == 0:
        raise InputError(f"{place(0)}: no row; a log holds the start at least")
    wrong = ~np.isfinite(rows[:, :of_state]).all(axis=1)
    if wrong.any():
        raise InputError(f"{place(int(wrong.argmax()))}: the state is not finite")
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
