"""Choice of the flights and of the rows of a log that are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, List, TypeVar

import numpy as np

if TYPE_CHECKING:
    from ..simulation.trajectory import Trajectory

    AnyLog = TypeVar("AnyLog", bound=Trajectory)

_POINTS = 600  # per flight: finer than a plot shows


def pick_evenly(count: int, most: int) -> List[int]:
    """Return all indices below `count`, or `most` evenly spaced ones with the first and last."""
    return [round(i) for i in np.linspace(0, count - 1, min(count, most))]


def decimate(log: AnyLog, most: int = _POINTS) -> AnyLog:
    """Return a log of at most `most` evenly spaced rows."""
    rows = pick_evenly(len(log), most)
    topics = {
        name: {field: column[rows] for field, column in fields.items()}
        for name, fields in log.topics.items()
    }
    decimated = type(log)(log.table[rows], {}, topics=topics)
    decimated.per_command = log.per_command
    return decimated
