"""Numbers of a blackbox log as bytes, in the encodings of its documentation."""

from __future__ import annotations

from typing import Callable, Dict, List


class Reader:
    """Reader of the bytes of a log; it raises IndexError at the end."""

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at = data, at

    def read_byte(self) -> int:
        """Read a byte."""
        value = self.data[self.at]
        self.at += 1
        return value

    def read_unsigned(self) -> int:
        """Read an unsigned number: seven bits per byte; the last byte lacks the highest bit."""
        value = shift = 0
        while True:
            byte = self.read_byte()
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                return value
            shift += 7
            if shift > 28:
                raise ValueError("a number has more than 32 bits")

    def read_signed(self) -> int:
        """Read a signed number in zigzag encoding: 0, -1, 1, -2 and so on."""
        value = self.read_unsigned()
        return (value >> 1) ^ -(value & 1)

    def read_little(self, size: int) -> int:
        """Read a signed little-endian number with this number of bytes."""
        end = self.at + size
        if end > len(self.data):
            raise IndexError
        value = int.from_bytes(self.data[self.at : end], "little", signed=True)
        self.at = end
        return value


def _extend(value: int, bits: int) -> int:
    """Extend the sign of a number that has its sign in the highest bit."""
    return value - (1 << bits) if value >> (bits - 1) else value


def _read_unsigned(reader: Reader, count: int) -> List[int]:
    return [reader.read_unsigned()]


def _read_signed(reader: Reader, count: int) -> List[int]:
    return [reader.read_signed()]


def _read_negated(reader: Reader, count: int) -> List[int]:
    return [-_extend(reader.read_unsigned() & 0x3FFF, 14)]


def _read_nothing(reader: Reader, count: int) -> List[int]:
    return [0]


def _read_tagged(reader: Reader, count: int) -> List[int]:
    """Read up to 8 numbers; the bits of the first byte mark those that are not 0."""
    if count == 1:
        return [reader.read_signed()]
    tag = reader.read_byte()
    return [reader.read_signed() if tag >> i & 1 else 0 for i in range(count)]


def _read_three(reader: Reader, count: int) -> List[int]:
    first = reader.read_byte()
    kind = first >> 6
    if kind == 0:
        return [_extend(first >> shift & 3, 2) for shift in (4, 2, 0)]
    if kind == 1:
        second = reader.read_byte()
        return [_extend(part, 4) for part in (first & 15, second >> 4, second & 15)]
    if kind == 2:
        return [_extend(part & 63, 6) for part in (first, reader.read_byte(), reader.read_byte())]
    return _read_sized(reader, first)


def _read_sized(reader: Reader, tag: int) -> List[int]:
    return [reader.read_little(1 + (tag >> shift & 3)) for shift in (0, 2, 4)]


def _read_three_variable(reader: Reader, count: int) -> List[int]:
    """Read three numbers of 2, 2, 2 or 5, 5, 4 or 8, 7, 7 bits, or of whole bytes."""
    first = reader.read_byte()
    kind = first >> 6
    if kind == 3:
        return _read_sized(reader, first)
    if kind == 0:
        widths, packed = (2, 2, 2), first
    elif kind == 1:
        widths, packed = (5, 5, 4), first << 8 | reader.read_byte()
    else:
        widths, packed = (8, 7, 7), first << 16 | reader.read_byte() << 8 | reader.read_byte()
    _, b, c = widths
    parts = (packed >> b + c, packed >> c, packed)
    return [_extend(part & ((1 << bits) - 1), bits) for part, bits in zip(parts, widths)]


def _read_four(reader: Reader, count: int) -> List[int]:
    """Read four numbers of 0, 4, 8 or 16 bits from a stream of half bytes."""
    tag = reader.read_byte()
    sizes = [(0, 1, 2, 4)[tag >> shift & 3] for shift in (0, 2, 4, 6)]
    whole = (sum(sizes) + 1) // 2
    end = reader.at + whole
    if end > len(reader.data):
        raise IndexError
    stream, left = int.from_bytes(reader.data[reader.at : end], "big"), 2 * whole
    reader.at = end
    values = []
    for size in sizes:
        left -= size
        part = stream >> 4 * left & ((1 << 4 * size) - 1)
        values.append(_extend(part, 4 * size) if size else 0)
    return values


ENCODINGS: Dict[int, Callable[[Reader, int], List[int]]] = {
    0: _read_signed,
    1: _read_unsigned,
    3: _read_negated,
    6: _read_tagged,
    7: _read_three,
    8: _read_four,
    9: _read_nothing,
    10: _read_three_variable,
}
"""Readers of numbers by encoding; the second argument is the number of fields in the group."""

GROUPS = {6: 8, 7: 3, 8: 4, 10: 3}
"""Maximum number of adjacent fields that one call of a reader reads."""
