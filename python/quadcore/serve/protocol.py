"""Protocol of the simulation server; docs/serve.md describes it.

All numbers are little-endian float64. A message consists of its kind, the count of the following
numbers, and these numbers. The module needs only the standard library.
"""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import Callable, List, Sequence, Tuple

VERSION = 1

LONGEST = 1_000_000
"""Maximum count of numbers in a message."""

_HEAD = struct.Struct("<2d")


class Request(IntEnum):
    """Kind of request from the client."""

    HELLO = 0
    """VERSION -> VERSION, dt (s), number of speeds in a command, number of columns in a row"""
    COLUMNS = 1
    """nothing -> names of the columns of a row as text, separated by commas"""
    STEP = 2
    """number of steps, and a command (rad/s) or nothing to keep the previous one -> a row"""
    RESET = 3
    """nothing or a seed -> the first row"""


class Reply(IntEnum):
    """Kind of reply from the server."""

    DONE = 0
    REFUSED = 1
    """The request is invalid and changed nothing; the reply contains the reason as text."""
    FAILED = 2
    """The flight failed after the previous row, and only a reset is possible; reason as text."""


class ProtocolError(Exception):
    """Malformed message."""


def pack_message(kind: int, numbers: Sequence[float] = ()) -> bytes:
    """Encode a message."""
    return struct.pack(f"<{2 + len(numbers)}d", kind, len(numbers), *numbers)


def encode_text(text: str) -> List[int]:
    """Encode a text as one number per UTF-8 byte."""
    return list(text.encode())


def decode_text(numbers: Sequence[float]) -> str:
    """Decode a text from one number per UTF-8 byte."""
    return bytes(int(number) for number in numbers).decode(errors="replace")


def read_message(receive: Callable[[int], bytes]) -> Tuple[int, Tuple[float, ...]]:
    """Read a message, and return its kind and numbers.

    Parameters
    ----------
    receive
        Function that returns at most the given number of bytes, and none at the end, like
        `socket.recv`.

    Raises
    ------
    EOFError
        If there are no more messages.
    ProtocolError
        If the message is malformed.
    """
    head = _receive_exactly(_HEAD.size, receive)
    if not head:
        raise EOFError
    if len(head) < _HEAD.size:
        raise ProtocolError(f"incomplete message: {len(head)} bytes of its head")
    kind, count = _HEAD.unpack(head)
    for name, number, largest in (("kind", kind, max(Request)), ("length", count, LONGEST)):
        if not (number == number and 0 <= number <= largest and number == int(number)):
            raise ProtocolError(
                f"message with {name} {number:g}. Send a whole number up to {largest}."
            )
    body = _receive_exactly(8 * int(count), receive)
    if len(body) < 8 * count:
        raise ProtocolError(f"incomplete message: {len(body)} of {8 * int(count)} bytes")
    return int(kind), struct.unpack(f"<{int(count)}d", body)


def _receive_exactly(count: int, receive: Callable[[int], bytes]) -> bytes:
    """Receive this number of bytes, or fewer at the end."""
    data = b""
    while len(data) < count:
        piece = receive(count - len(data))
        if not piece:
            break
        data += piece
    return data
