"""Which of many flights, and which rows of a log, are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, List, TypeVar

import numpy as np

if TYPE_CHECKING:
    from ..simulation.trajectory import Trajectory

    Flown = TypeVar("Flown", bound=Trajectory)

_POINTS = 600  # per flight: finer than a picture shows


def pick_evenly(count: int, most: int) -> List[int]:
    """All of so many, or evenly many with the first and the last."""
    return [round(i) for i in np.linspace(0, count - 1, min(count, most))]


def thin(log: Flown, most: int = _POINTS) -> Flown:
    """Rows enough to draw."""
    picked = pick_evenly(len(log), most)
    topics = {
        name: {field: column[picked] for field, column in fields.items()}
        for name, fields in log.topics.items()
    }
    kept = type(log)(log.table[picked], {}, topics=topics)
    kept.per_command = log.per_command
    return kept
