"""ULog files of PX4.

PX4's page on the format describes the messages. Each has a header of two bytes for the size and one
for the kind. Definitions precede the data.
"""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import IO, Any, Dict, Iterator, List, Sequence, Tuple

import numpy as np

from ..._core import InputError
from ...support.optional_packages import require_package
from ...support.warning import warn
from .series import Columns, open_content, split_topics

MAGIC = b"ULog\x01\x12\x35"

_HEADER = 16  # bytes before the first message
_DEFINITIONS = b"BFIMPQ"
"""Kinds of messages before the data: flags, formats, information and parameters."""
_FLAGS, _SUBSCRIPTION = b"B", ord("A")
_INCOMPATIBLE = 11
"""Index of the flag byte; its first bit announces appended data."""
_PART = 2**24  # bytes that are decoded at once


def read_ulog(path: Path, wanted: Sequence[str]) -> Columns:
    """Read fields ``TOPIC.FIELD``, or ``TOPIC#1.FIELD`` for the second instance of a topic.

    The file is decoded in parts, and only the requested fields are kept. The times are those of the
    samples if the topic contains them, or else those of the messages.

    Raises
    ------
    InputError
        If pyulog is missing, or the file is damaged.

    Warns
    -----
    QuadcoreWarning
        If the file ends within a message.
    """
    with require_package(f"{path}: a ULog", "pyulog", "ulog"):
        from pyulog import ULog
    topics = list(dict.fromkeys(topic.partition("#")[0] for topic in split_topics(wanted)))
    parts: Dict[str, List[np.ndarray]] = {}
    with open_content(path) as stream:
        for part in _split(path, stream):
            try:
                with contextlib.redirect_stdout(io.StringIO()):  # pyulog prints reports of damage
                    log = ULog(io.BytesIO(part), topics, disable_str_exceptions=True)
            except Exception as error:  # a damaged file can raise any exception
                raise InputError(f"{path}: the ULog is damaged: {error}.") from error
            if log.file_corruption:
                raise InputError(f"{path}: the ULog is damaged. Copy the file again.")
            for topic in log.data_list:
                _take_columns(topic, wanted, parts)
    joined = {name: np.concatenate(parts.pop(name)) for name in list(parts)}
    columns = {name: values for name, values in joined.items() if name in wanted}
    return Columns(str(path), columns, {name: joined[_name_time(name)] for name in columns})


def _take_columns(topic: Any, wanted: Sequence[str], parts: Dict[str, List[np.ndarray]]) -> None:
    """Append the requested fields of a topic and its times to the parts of each column."""
    name = topic.name if topic.multi_id == 0 else f"{topic.name}#{topic.multi_id}"
    fields = [field for field in topic.data if f"{name}.{field}" in wanted]
    if not fields:
        return
    stamp = "timestamp_sample" if "timestamp_sample" in topic.data else "timestamp"
    parts.setdefault(_name_time(name), []).append(topic.data[stamp] * 1e-6)
    for field in fields:
        parts.setdefault(f"{name}.{field}", []).append(topic.data[field].copy())


def _name_time(column: str) -> str:
    return column.partition(".")[0] + ".time of the samples"


def _split(path: Path, stream: IO[bytes]) -> Iterator[bytes]:
    """Split a ULog into parts of whole messages; each has the definitions and subscriptions."""
    begin, rest = _read_definitions(stream)
    flags = begin[_HEADER + 2 : _HEADER + _INCOMPATIBLE + 1]
    if flags[:1] == _FLAGS and flags[-1] & 1:  # the flags refer to offsets in the whole file
        yield begin + rest + stream.read()
        return
    while True:
        subscriptions: List[bytes] = []
        at = _find_last_end(rest, subscriptions)
        yield begin + rest[:at]
        begin += b"".join(subscriptions)
        rest = rest[at:]
        following = stream.read(_PART)
        if not following:
            break
        rest += following
    if rest:
        warn(f"{path}: the ULog ends within a message, which is left out.")


def _read_definitions(stream: IO[bytes]) -> Tuple[bytes, bytes]:
    """Read the definitions, and the start of the data after them."""
    data, at = stream.read(_PART), _HEADER
    while True:
        if at + 3 > len(data):
            following = stream.read(_PART)
            if not following:
                return data, b""
            data += following
        elif data[at + 2] in _DEFINITIONS:
            at += 3 + data[at] + 256 * data[at + 1]
        else:
            return data[:at], data[at:]


def _find_last_end(data: bytes, subscriptions: List[bytes]) -> int:
    """Return the end of the last complete message, and collect the subscriptions before it."""
    at, end = 0, len(data) - 3
    while at <= end:
        after = at + 3 + data[at] + 256 * data[at + 1]
        if after > len(data):
            break
        if data[at + 2] == _SUBSCRIPTION:
            subscriptions.append(data[at:after])
        at = after
    return at
