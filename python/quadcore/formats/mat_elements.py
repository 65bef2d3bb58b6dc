"""Data elements of MATLAB files of versions 5, 6 and 7."""

from __future__ import annotations

import struct
from typing import Optional, Tuple

import numpy as np

HEADER = 128
"""Bytes before the first element."""

MATRIX, COMPRESSED = 14, 15

_NUMBERS = {
    1: "i1",
    2: "u1",
    3: "i2",
    4: "u2",
    5: "i4",
    6: "u4",
    7: "f4",
    9: "f8",
    12: "i8",
    13: "u8",
}
_CODECS = {1: "utf-8", 2: "utf-8", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
_ORDERS = {b"\x00\x01IM": "<", b"\x01\x00MI": ">"}  # the end of the header: version and byte order


def find_byte_order(data: bytes) -> Optional[str]:
    """Return the byte order "<" or ">"; None for any other format."""
    return _ORDERS.get(data[HEADER - 4 : HEADER])


class Elements:
    """Reader of consecutive data elements.

    All methods raise ValueError if the next element is damaged or has another type.
    """

    def __init__(self, data: memoryview, order: str) -> None:
        self.data, self.order = data, order
        self._at = 0

    def __bool__(self) -> bool:
        return self._at < len(self.data)

    def take(self) -> Tuple[int, Elements]:
        """Read the type and the content of the next element."""
        kind, size, begin, end = self._read_tag()
        if begin + size > len(self.data):
            raise ValueError(f"an element of {size} bytes is longer than what holds it")
        self._at = min(end, len(self.data))  # the last element may lack its padding
        return kind, Elements(self.data[begin : begin + size], self.order)

    def take_size(self, expected: int) -> int:
        """Read the tag of an element, check its type, and return the size of its content."""
        kind, size, self._at, _ = self._read_tag()
        if kind != expected:
            raise ValueError(f"an element of type {kind} instead of {expected}")
        return size

    def take_matrix(self) -> Elements:
        """Read the content of a matrix."""
        kind, content = self.take()
        if kind != MATRIX:
            raise ValueError(f"an element of type {kind} instead of a matrix")
        return content

    def take_bytes(self) -> bytes:
        """Read bytes of characters."""
        kind, content = self.take()
        if kind not in _CODECS:
            raise ValueError(f"an element of type {kind} instead of characters")
        return bytes(content.data)

    def take_text(self) -> str:
        """Read a text."""
        kind, content = self.take()
        codec = _CODECS.get(kind)
        if codec is None:
            raise ValueError(f"an element of type {kind} instead of characters")
        suffix = {"<": "-le", ">": "-be"}[self.order] if codec != "utf-8" else ""
        return bytes(content.data).decode(codec + suffix)

    def take_numbers(self, expected: Optional[str] = None) -> np.ndarray:
        """Read numbers of a type such as "i4", or of any type; shape (n,)."""
        kind, content = self.take()
        held = _NUMBERS.get(kind)
        if held is None or expected not in (None, held):
            wanted = np.dtype(expected).name if expected else "numbers"
            raise ValueError(f"an element of type {kind} instead of {wanted}")
        return np.frombuffer(content.data, f"{self.order}{held}")

    def _read_tag(self) -> Tuple[int, int, int, int]:
        """Return type and size, and the positions of the content and the next element."""
        at = self._at
        if at + 8 > len(self.data):
            raise ValueError("it ends within a tag")
        kind, size = struct.unpack_from(f"{self.order}2I", self.data, at)
        if kind >> 16:  # small element with its content in the tag
            kind, size = kind & 0xFFFF, kind >> 16
            if size > 4:
                raise ValueError(f"a small element of {size} bytes has more than 4")
            return kind, size, at + 4, at + 8
        padding = 0 if kind in (MATRIX, COMPRESSED) else -size % 8
        return kind, size, at + 8, at + 8 + size + padding
