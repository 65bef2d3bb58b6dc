"""Blackbox logs of Betaflight and related firmware, decoded as documented.

The page "Blackbox logging internals" of Betaflight documents the frames, predictors and encodings.
"""

from __future__ import annotations

import math
import re
import struct
from pathlib import Path
from typing import Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ..._core import InputError
from ...support.arguments import shorten
from ...support.warning import warn
from .bits import ENCODINGS, GROUPS, Reader
from .series import Columns, make_columns

MAGIC = b"H Product:Blackbox flight data recorder"

_EVENTS = {0: 1, 13: 2, 14: 2, 15: 1, 30: 2}
"""Count of numbers after each event type: beep, adjustment, resume, disarming, flight mode."""
_END = 255
_END_TEXT = b"End of log\0"


class _Field(NamedTuple):
    name: str
    predictor: int
    encoding: int
    is_signed: bool


class _Session(NamedTuple):
    """Header of one flight, and the position of its first frame."""

    header: Mapping[str, str]
    fields: Mapping[str, Sequence[_Field]]
    begin: int


def read_blackbox(path: Path, data: bytes) -> Columns:
    """Read the fields of the main frames, in the units of Betaflight's own tools.

    Gyro fields are in deg/s and accelerometer fields in g. Motor fields range from 0 to 1. eRPM
    fields are rotor revolutions per minute.

    Raises
    ------
    InputError
        If the header is damaged, an encoding is unknown, or there are no frames.
    """
    starts = _find_sessions(data)
    decoded = []
    for begin, end in zip(starts, [*starts[1:], len(data)]):
        session = _read_header(path, data, begin, end)
        decoded.append((session, *_read_frames(path, data[:end], session)))
    session, rows, lost = max(decoded, key=lambda each: len(each[1]))
    if not rows:
        raise InputError(f"{path}: the blackbox log contains no frame.")
    if len(starts) > 1:
        warn(f"{path}: {len(starts)} flights in one log; only the longest is read.")
    if lost:
        warn(f"{path}: {lost} bytes of the blackbox log are damaged and left out.")
    names = [field.name for field in session.fields["I"]]
    table = np.array(rows, dtype=float)
    columns = dict(zip(names, table.T))
    return make_columns(
        str(path), columns["time"] * 1e-6, _scale_columns(path, columns, session.header)
    )


def _find_sessions(data: bytes) -> List[int]:
    starts, at = [], data.find(MAGIC)
    while at >= 0:
        starts.append(at)
        at = data.find(MAGIC, at + 1)
    return starts


def _read_header(path: Path, data: bytes, begin: int, end: int) -> _Session:
    header: Dict[str, str] = {}
    at = begin
    while data[at : at + 2] == b"H " and b"\n" in data[at:end]:
        after = data.index(b"\n", at)
        name, _, value = data[at + 2 : after].decode("latin-1").partition(":")
        header[name.strip()] = value.strip()
        at = after + 1
    try:
        fields = {kind: _read_fields(header, kind) for kind in "IPSGH" if _has(header, kind)}
        names = [field.name for field in fields["I"]]
        if "time" not in names or "loopIteration" not in names or "P" not in fields:
            raise KeyError("time, loopIteration or P frames")
    except (KeyError, ValueError) as error:
        raise InputError(f"{path}: the header of the blackbox log is damaged: {error}.") from error
    for group in fields.values():
        for field in group:
            if field.encoding not in ENCODINGS:
                raise InputError(
                    f"{path}: encoding {field.encoding} of field {field.name} is unknown. "
                    "Convert the log with the tool of its firmware to CSV."
                )
    return _Session(header, fields, at)


def _has(header: Mapping[str, str], kind: str) -> bool:
    return f"Field {kind} predictor" in header


def _read_fields(header: Mapping[str, str], kind: str) -> List[_Field]:
    named = "I" if kind == "P" else kind  # P frames use the names of I frames
    names = header[f"Field {named} name"].split(",")
    predictors = [int(text) for text in header[f"Field {kind} predictor"].split(",")]
    encodings = [int(text) for text in header[f"Field {kind} encoding"].split(",")]
    signs = [text == "1" for text in header.get(f"Field {named} signed", "").split(",")]
    signs += [False] * (len(names) - len(signs))
    if not len(names) == len(predictors) == len(encodings):
        raise ValueError(f"fields of {kind} frames have {len(names)} names and other counts")
    return [_Field(*each) for each in zip(names, predictors, encodings, signs)]


def _read_frames(path: Path, data: bytes, session: _Session) -> Tuple[List[List[int]], int]:
    """Return the rows of the main frames, and the number of bytes outside valid frames."""
    rows: List[List[int]] = []
    history: Optional[Tuple[List[int], List[int]]] = None
    predict = _Predictors(path, session)
    reader = Reader(data, session.begin)
    lost = 0
    while reader.at < len(data):
        begin = reader.at
        kind = chr(reader.read_byte())
        try:
            if kind == "E":
                if not _skip_event(reader):
                    break
            elif kind in session.fields and (kind != "P" or history is not None):
                values = _read_values(reader, session.fields[kind])
                if reader.at < len(data) and chr(data[reader.at]) not in "IPSGHE":
                    raise ValueError("no frame follows")
                if kind in "IP":
                    row = predict.complete(kind, values, history)
                    history = (row, history[0] if kind == "P" and history else row)
                    rows.append(row)
            else:
                raise ValueError("no frame")
        except (ValueError, IndexError):  # decoding continues at the next I frame
            history = None
            after = data.find(b"I", begin + 1)
            reader.at = after if after >= 0 else len(data)
            lost += reader.at - begin
    return rows, lost


def _skip_event(reader: Reader) -> bool:
    """Skip an event; return whether the log continues."""
    kind = reader.read_byte()
    if kind == _END and reader.data[reader.at : reader.at + len(_END_TEXT)] == _END_TEXT:
        return False
    if kind not in _EVENTS:
        raise ValueError("the event is unknown")
    for _ in range(_EVENTS[kind]):
        reader.read_unsigned()
    return True


def _read_values(reader: Reader, fields: Sequence[_Field]) -> List[int]:
    values: List[int] = []
    while len(values) < len(fields):
        encoding = fields[len(values)].encoding
        count, most = 1, GROUPS.get(encoding, 1)
        while (
            count < most
            and len(values) + count < len(fields)
            and fields[len(values) + count].encoding == encoding
        ):
            count += 1
        values += ENCODINGS[encoding](reader, count)[:count]
    return values


class _Predictors:
    """Predictions that are added to the values of main frames."""

    def __init__(self, path: Path, session: _Session) -> None:
        header = session.header
        self._fields = session.fields
        names = [field.name for field in session.fields["I"]]
        self._motor = names.index("motor[0]") if "motor[0]" in names else 0
        self._time = names.index("time")
        self._loop = names.index("loopIteration")
        self._interval = _read_interval(path, header)
        self._fixed = {
            4: _read_number(path, header, "minthrottle"),
            8: 1500,
            9: _read_number(path, header, "vbatref"),
            11: _read_number(path, header, "motorOutput"),
        }

    def complete(
        self, kind: str, values: List[int], history: Optional[Tuple[List[int], List[int]]]
    ) -> List[int]:
        """Return the fields of a frame with the predictions added."""
        row: List[int] = []
        for i, (field, value) in enumerate(zip(self._fields[kind], values)):
            value += self._predict(field.predictor, i, row, history)
            value &= 0xFFFFFFFF
            row.append(value - (1 << 32) if field.is_signed and value >> 31 else value)
        return row

    def _predict(
        self,
        predictor: int,
        i: int,
        row: List[int],
        history: Optional[Tuple[List[int], List[int]]],
    ) -> int:
        if predictor == 0:
            return 0
        if predictor in self._fixed:
            return self._fixed[predictor]
        if predictor == 5:
            return row[self._motor]
        if history is None:
            raise ValueError("the frame needs the frame before")
        last, before = history
        if predictor == 1:
            return last[i]
        if predictor == 2:
            return 2 * last[i] - before[i]
        if predictor == 3:
            return int((last[i] + before[i]) / 2)
        if predictor == 6:
            return self._next_iteration(last[self._loop])
        if predictor == 10:
            return last[self._time]
        raise ValueError(f"predictor {predictor} is unknown")

    def _next_iteration(self, last: int) -> int:
        numerator, denominator, every = self._interval
        following = last + 1
        while following % every and (following % every + numerator - 1) % denominator >= numerator:
            following += 1
        return following


def _read_interval(path: Path, header: Mapping[str, str]) -> Tuple[int, int, int]:
    """Return the numerator and denominator of the P interval, and the I interval."""
    text = header.get("P interval", "1/1")
    numerator, _, denominator = text.partition("/")
    try:
        interval = (int(numerator), int(denominator or numerator), int(header["I interval"]))
        if not denominator:  # newer firmware: the number of iterations
            interval = (1, max(1, interval[1]), interval[2])
        if min(interval) < 1:
            raise ValueError(text)
    except (KeyError, ValueError) as error:
        raise InputError(
            f"{path}: the intervals of the blackbox log are damaged: {error}."
        ) from error
    return interval


def _read_numbers(path: Path, header: Mapping[str, str], name: str) -> List[int]:
    """Return the integers of a header entry; empty if the entry is missing."""
    text = header.get(name, "")
    parts = text.split(",") if text else []
    if not all(re.fullmatch("-?[0-9]+", part.strip()) for part in parts):
        raise _make_error(path, name, text)
    return [int(part) for part in parts]


def _read_number(path: Path, header: Mapping[str, str], name: str, fallback: int = 0) -> int:
    return (_read_numbers(path, header, name) or [fallback])[0]


def _read_divisor(path: Path, header: Mapping[str, str], name: str, fallback: int) -> int:
    number = _read_number(path, header, name, fallback)
    if number < 1:
        raise _make_error(path, name, header[name])
    return number


def _make_error(path: Path, name: str, text: str) -> InputError:
    return InputError(
        f"{path}: the header of the blackbox log is damaged: {name} is {shorten(text)}. "
        "Download the log again."
    )


def _scale_columns(
    path: Path, columns: Mapping[str, np.ndarray], header: Mapping[str, str]
) -> Dict[str, np.ndarray]:
    scaled = dict(columns)
    gyro = _read_gyro_scale(path, header)
    one_g = _read_divisor(path, header, "acc_1G", 1)
    low, high = _read_motor_range(path, header)
    poles = _read_divisor(path, header, "motor_poles", 14)
    for name, values in columns.items():
        if name.startswith("gyroADC"):
            scaled[name] = values * gyro
        elif name.startswith("accSmooth"):
            scaled[name] = values / one_g
        elif name.startswith("motor[") and high > low:
            scaled[name] = (values - low) / (high - low)
        elif name.startswith("eRPM["):
            scaled[name] = values * 100 / (poles / 2)
    return scaled


def _read_gyro_scale(path: Path, header: Mapping[str, str]) -> float:
    """Return the scale of the gyro, deg/s per unit; the header contains the bits of a float."""
    name = "gyro_scale" if "gyro_scale" in header else "gyro.scale"
    text = header.get(name, "")
    if not text.startswith("0x"):
        return 1.0
    if not re.fullmatch("0x[0-9a-fA-F]{1,8}", text):
        raise _make_error(path, name, text)
    scale = float(struct.unpack("<f", struct.pack("<I", int(text, 16)))[0])
    if not math.isfinite(scale):
        raise _make_error(path, name, text)
    return scale


def _read_motor_range(path: Path, header: Mapping[str, str]) -> Tuple[int, int]:
    given = _read_numbers(path, header, "motorOutput")
    if len(given) == 2:
        return given[0], given[1]
    return _read_number(path, header, "minthrottle"), _read_number(path, header, "maxthrottle")
