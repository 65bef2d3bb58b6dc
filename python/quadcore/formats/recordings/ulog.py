"""ULog files of PX4."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Dict, Sequence

import numpy as np

from ..._core import InputError
from ...support.optional_packages import require_package
from .series import Columns, split_topics

MAGIC = b"ULog\x01\x12\x35"


def read_ulog(path: Path, wanted: Sequence[str]) -> Columns:
    """Read fields ``TOPIC.FIELD``, or ``TOPIC#1.FIELD`` of the second instance of a topic.

    Topics that are not wanted are skipped while the file is read. The times are those of the
    samples, if the topic contains them.

    Raises
    ------
    InputError
        If pyulog is missing, or the file is damaged.
    """
    with require_package(f"{path}: a ULog", "pyulog", "ulog"):
        from pyulog import ULog
    topics = [topic.partition("#")[0] for topic in split_topics(wanted)]
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # pyulog prints about damage
            log = ULog(str(path), list(dict.fromkeys(topics)), disable_str_exceptions=True)
    except Exception as error:  # a broken file makes anything
        raise InputError(f"{path}: the ULog is damaged: {error}.") from error
    columns: Dict[str, np.ndarray] = {}
    times: Dict[str, np.ndarray] = {}
    for topic in log.data_list:
        name = topic.name if topic.multi_id == 0 else f"{topic.name}#{topic.multi_id}"
        stamp = "timestamp_sample" if "timestamp_sample" in topic.data else "timestamp"
        time = topic.data[stamp] * 1e-6
        for field, values in topic.data.items():
            columns[f"{name}.{field}"] = values
            times[f"{name}.{field}"] = time
    if log.file_corruption:
        raise InputError(f"{path}: the ULog is damaged. Copy the file again.")
    return Columns(str(path), columns, times)
