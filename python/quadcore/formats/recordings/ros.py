"""Messages of arbitrary topics in a ROS 1 bag."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, List, Sequence

import numpy as np

from ..._core import InputError
from ..bag import open_bag, read_messages
from ..bag_messages import Messages
from .series import Columns, split_topics

MAGIC = b"#ROSBAG V2.0"

_PART = re.compile(r"([A-Za-z_]\w*)|\[(\d+)\]")


def read_bag(path: Path, wanted: Sequence[str]) -> Columns:
    """Read numeric fields ``/TOPIC.FIELD.FIELD`` or ``/TOPIC.FIELD[0]``.

    The times are the header stamps, or the times in the bag for messages without a header.

    Raises
    ------
    InputError
        If rosbags is missing, the bag is damaged, or a message lacks a requested field.
    """
    columns: Dict[str, np.ndarray] = {}
    times: Dict[str, np.ndarray] = {}
    Messages()
    with open_bag(path) as bag:
        for topic, names in split_topics(wanted).items():
            found = [c for c in bag.connections if c.topic == topic]
            values: List[List[float]] = []
            stamps: List[float] = []
            for time, message in read_messages(bag, found):
                stamps.append(_find_stamp(message, time))
                values.append([_find_number(path, message, name) for name in names])
            if not values:
                continue
            for name, column in zip(names, np.array(values).T):
                columns[name], times[name] = column, np.array(stamps)
    return Columns(str(path), columns, times)


def _find_stamp(message: Any, time: int) -> float:
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    return time * 1e-9 if stamp is None else stamp.sec + stamp.nanosec * 1e-9


def _find_number(path: Path, message: Any, name: str) -> float:
    found = message
    try:
        for field, index in _PART.findall(name.partition(".")[2]):
            found = getattr(found, field) if field else found[int(index)]
        return float(found)
    except (AttributeError, IndexError, TypeError, ValueError):
        raise InputError(f"{path}: a message has no number {name}.") from None
