"""What goes over the socket: docs/serve.md has it in words.

Numbers are all float64, little-endian. A message is a kind, how many numbers follow, and these. Of
the standard library alone, as the client is.
"""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import Callable, List, Sequence, Tuple

VERSION = 1

LONGEST = 1_000_000
"""Numbers of a message, at most."""

_HEAD = struct.Struct("<2d")


class Request(IntEnum):
    """What a client asks for."""

    HELLO = 0
    """VERSION -> VERSION, dt (s), speeds of a command, columns of a row"""
    COLUMNS = 1
    """nothing -> names of the columns of a row, with commas, as text"""
    STEP = 2
    """how many steps, and a command (rad/s) or none, which keeps the one before -> a row"""
    RESET = 3
    """nothing or a seed -> the row of the start"""


class Reply(IntEnum):
    """How a request went."""

    DONE = 0
    REFUSED = 1
    """the request is at fault and changed nothing: why, as text"""
    FAILED = 2
    """the flight has failed, at the row before; only a reset helps: why, as text"""


class ProtocolError(Exception):
    """What came is no message."""


def pack_message(kind: int, numbers: Sequence[float] = ()) -> bytes:
    """Write a message."""
    return struct.pack(f"<{2 + len(numbers)}d", kind, len(numbers), *numbers)


def encode_text(text: str) -> List[int]:
    """Code a text: a number for each byte of UTF-8."""
    return list(text.encode())


def decode_text(numbers: Sequence[float]) -> str:
    """Read a text."""
    return bytes(int(number) for number in numbers).decode(errors="replace")


def read_message(receive: Callable[[int], bytes]) -> Tuple[int, Tuple[float, ...]]:
    """Read a message: its kind and numbers.

    Parameters
    ----------
    receive
        Gives so many bytes at most, none at the end, as `socket.recv` does.

    Raises
    ------
    EOFError
        There is no other.
    ProtocolError
        What came is none.
    """
    head = _receive_exactly(_HEAD.size, receive)
    if not head:
        raise EOFError
    if len(head) < _HEAD.size:
        raise ProtocolError(f"ended within a message, after {len(head)} bytes of its head")
    kind, count = _HEAD.unpack(head)
    for name, number, largest in (("kind", kind, max(Request)), ("length", count, LONGEST)):
        if not (number == number and 0 <= number <= largest and number == int(number)):
            raise ProtocolError(f"a message of {name} {number:g}; a whole number to {largest}")
    body = _receive_exactly(8 * int(count), receive)
    if len(body) < 8 * count:
        raise ProtocolError(f"ended within a message, after {len(body)} of {8 * int(count)} bytes")
    return int(kind), struct.unpack(f"<{int(count)}d", body)


def _receive_exactly(count: int, receive: Callable[[int], bytes]) -> bytes:
    """So many bytes, or fewer at the end."""
    data = b""
    while len(data) < count:
        piece = receive(count - len(data))
        if not piece:
            break
        data += piece
    return data
