"""Odd values: numbers at which arithmetic breaks, arrays of odd shapes, types and layouts."""

from __future__ import annotations

import math
import random
from typing import Any, Callable, Sequence, Tuple

import numpy as np

import quadcore as qc

NUMBERS = (
    *(0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 3.0, 1e-9, 1e-320, 1e9, 1e18, 1e19, 1e38, 1e154, 1e308),
    *(-1e308, math.inf, -math.inf, math.nan, 2.0**31, 2.0**32, 2.0**53, 2.0**63, 2.0**64),
)
WHOLE = (0, 1, -1, 2, 3, 4, 7, 8, 64, 255, 2**31, 2**32, 2**53, 2**63 - 1, 2**63, 2**64, -(2**63))
TEXTS = ("", " ", "0", "1", "nan", "a b", "1 2 3", "\0", "\n", "\x1b[2J", "\udc80", "é", "x" * 3000)
OTHERS = (None, True, False, b"", b"1", (), [], {}, set(), object(), len, int, 1j, ..., range(3))
DTYPES = (
    "f8",
    "f8",
    "f8",
    "f4",
    "i4",
    "i8",
    "u8",
    "u1",
    "?",
    ">f8",
    "c16",
    "O",
    "S3",
    "U3",
    "M8[s]",
)


def number(chance: random.Random) -> Any:
    """Give any number."""
    kind = chance.randrange(4)
    if kind == 0:
        return chance.choice(WHOLE)
    if kind == 1:
        return chance.uniform(-10, 10)
    return chance.choice(NUMBERS)


def value(chance: random.Random) -> Any:
    """Give anything."""
    kind = chance.randrange(8)
    if kind < 3:
        return number(chance)
    if kind == 3:
        return chance.choice(TEXTS)
    if kind == 4:
        return chance.choice(OTHERS)
    if kind == 5:
        return [number(chance) for _ in range(chance.randrange(8))]
    return array(chance, (chance.randrange(4), chance.randrange(8)))


def array(chance: random.Random, shape: Tuple[int, ...]) -> Any:
    """Give an array like one of this shape, of which something is often wrong."""
    if chance.randrange(4) == 0:
        shape = _other_shape(chance, shape)
    rows = _filled(chance, shape)
    return chance.choice(LAYOUTS)(chance, rows)


def _other_shape(chance: random.Random, shape: Tuple[int, ...]) -> Tuple[int, ...]:
    sizes = list(shape)
    change = chance.randrange(5)
    if change == 0 or not sizes:
        sizes.insert(chance.randrange(len(sizes) + 1), chance.choice((0, 1, 2)))
    elif change == 1:
        sizes.pop(chance.randrange(len(sizes)))
    elif change == 2:
        sizes.reverse()
    else:
        sizes[chance.randrange(len(sizes))] = chance.choice((0, 1, 2, 3, 5, 50))
    return tuple(sizes)


def _filled(chance: random.Random, shape: Tuple[int, ...]) -> np.ndarray:
    rows = np.full(shape, chance.choice((0.0, 1.0, 300.0)))
    if rows.size and chance.randrange(2):
        rows.flat[chance.randrange(rows.size)] = chance.choice(NUMBERS)
    return rows


def _retyped(chance: random.Random, rows: np.ndarray) -> Any:
    try:
        with np.errstate(all="ignore"):
            return rows.astype(chance.choice(DTYPES))
    except (TypeError, ValueError, OverflowError):
        return rows


def _unaligned(chance: random.Random, rows: np.ndarray) -> np.ndarray:
    memory = bytearray(rows.nbytes + 9)
    other = np.frombuffer(memory, np.uint8, rows.nbytes, 1 + chance.randrange(8))
    other = other.view(np.float64).reshape(rows.shape)
    other[...] = rows
    return other


def _strided(chance: random.Random, rows: np.ndarray) -> np.ndarray:
    return np.repeat(rows, 2, axis=-1)[..., :: chance.choice((2, -2))] if rows.ndim else rows


def _read_only(_: random.Random, rows: np.ndarray) -> np.ndarray:
    rows.flags.writeable = False
    return rows


def _as_it_is(_: random.Random, rows: np.ndarray) -> np.ndarray:
    return rows


LAYOUTS: Sequence[Callable[[random.Random, np.ndarray], Any]] = (
    _as_it_is,
    _as_it_is,
    _retyped,
    _unaligned,
    _strided,
    _read_only,
    lambda _, rows: np.asfortranarray(rows),
    lambda _, rows: rows.tolist(),
    lambda _, rows: np.ma.array(rows, mask=rows > 0),
    # Python itself goes through no others.
    lambda _, rows: memoryview(rows) if rows.ndim == 1 else rows,
    lambda _, rows: np.broadcast_to(rows, (2, *rows.shape)),
)


def call(function: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
    """Call what may refuse its arguments in one line of quadcore's own."""
    try:
        return function(*arguments, **named)
    except qc.QuadcoreError as error:
        check_one_line(str(error))
        return None


def check_one_line(text: str) -> None:
    """Raise AssertionError unless a message is one short line without control characters."""
    if not text or len(text) > 1000 or any(c < " " or c == "\x7f" for c in text):
        raise AssertionError(f"not a message of one line: {text!r}")
