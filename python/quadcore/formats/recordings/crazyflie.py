"""Version 2 files of the micro-SD card deck of a Crazyflie.

Bitcraze's page on the deck describes the format. The byte 0xBC and the version come first. They are
followed by the event types, with the names and types of their variables, and the events with their
times (us). The file ends with a CRC-32 of everything before it.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Dict, List, Tuple

import numpy as np

from ..._core import InputError
from .series import Columns

MAGIC = b"\xbc"

_TYPES = "BbHhIifd"
"""Supported types of variables, as letters of the module struct."""


def read_crazyflie(path: Path, data: bytes) -> Columns:
    """Read the variables of all events by name, such as ``gyro.x``.

    Raises
    ------
    InputError
        If the file is damaged or truncated, or has another version.
    """
    if len(data) < 9 or struct.unpack_from("<I", data, len(data) - 4)[0] != zlib.crc32(data[:-4]):
        raise InputError(
            f"{path}: the checksum of the Crazyflie log is wrong. Copy the file again."
        )
    version, count = struct.unpack_from("<HH", data, 1)
    if version != 2:
        raise InputError(f"{path}: version {version} of Crazyflie logs is unknown. Use version 2.")
    try:
        kinds, at = _read_events(data, count)
        rows = _split_rows(data, kinds, at)
    except (struct.error, ValueError, KeyError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: the Crazyflie log is damaged: {error}.") from error
    columns: Dict[str, np.ndarray] = {}
    times: Dict[str, np.ndarray] = {}
    for kind, records in rows.items():
        event, record = kinds[kind]
        table = np.frombuffer(records, dtype=record)
        for name in (record.names or ())[2:]:
            shown = name if name not in columns else f"{event}.{name}"
            columns[shown] = table[name]
            times[shown] = table["time"] * 1e-6
    return Columns(str(path), columns, times)


def _read_events(data: bytes, count: int) -> Tuple[Dict[int, Tuple[str, np.dtype]], int]:
    """Read the name and record of each event type, and return the end of the header."""
    kinds: Dict[int, Tuple[str, np.dtype]] = {}
    at = 5
    for _ in range(count):
        (kind,) = struct.unpack_from("<H", data, at)
        event, at = _read_name(data, at + 2)
        (variables,) = struct.unpack_from("<H", data, at)
        at += 2
        fields: List[Tuple[str, str]] = [("kind", "<u2"), ("time", "<u8")]
        for _ in range(variables):
            text, at = _read_name(data, at)
            name, letter = text[:-3], text[-2:-1]
            if text[-3:] != f"({letter})" or letter not in _TYPES:
                raise ValueError(f"'{text}' is no variable")
            fields.append((name, f"<{letter}"))
        kinds[kind] = event, np.dtype(fields)
    return kinds, at


def _read_name(data: bytes, at: int) -> Tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode("ascii"), end + 1


def _split_rows(data: bytes, kinds: Dict[int, Tuple[str, np.dtype]], at: int) -> Dict[int, bytes]:
    """Return the records of each event type as bytes."""
    end = len(data) - 4
    if len(kinds) == 1:
        [(kind, (_, record))] = kinds.items()
        if (end - at) % record.itemsize:
            raise ValueError("the last row is incomplete")
        return {kind: data[at:end]}
    parts: Dict[int, List[bytes]] = {kind: [] for kind in kinds}
    while at < end:
        (kind,) = struct.unpack_from("<H", data, at)
        after = at + kinds[kind][1].itemsize
        if after > end:
            raise ValueError("the last row is incomplete")
        parts[kind].append(data[at:after])
        at = after
    return {kind: b"".join(records) for kind, records in parts.items()}
