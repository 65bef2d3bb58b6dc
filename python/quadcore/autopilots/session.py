"""Recorded sessions: the answers of an autopilot in a flight, and digests of the requests.

A session file is compressed with gzip. It contains a line of JSON, and one record for each answer.
A record contains the CRC-32 of all packets since the last answer, and the answer in pieces. Each
piece begins with its length; a piece of 255 bytes is followed by another one.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import struct
import zlib
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, Protocol, Tuple, Union

from .._core import InputError
from ..support.input_files import LARGEST, open_file
from ..support.output_files import atomic_write, printable_name

_VERSION = 1
_DIGEST = struct.Struct("<I")
_PIECE = 255  # maximum size of a piece, bytes

Fail = Callable[[str], Exception]


class Link(Protocol):
    """Connection to an autopilot that answers requests."""

    def send(self, packet: bytes, port: int, fail: Fail) -> None:
        """Send a packet that has no answer."""

    def ask(self, packet: bytes, port: int, fail: Fail) -> bytes:
        """Send a packet, and return the answer."""


class Recorder:
    """Link that records the packets of another link.

    Parameters
    ----------
    link : Link
        Link to the autopilot.
    path : path
        Path of the file, which is written when the exchange is closed.
    about : dict
        Description of the flight as plain values.
    """

    def __init__(self, link: Link, path: Path, about: Dict[str, Any]) -> None:
        self._link, self._path = link, path
        self._head = json.dumps({"quadcore session": _VERSION, **about}, sort_keys=True)
        self._records: List[bytes] = []
        self._digest = 0

    def send(self, packet: bytes, port: int, fail: Fail) -> None:
        """Send a packet as `Link.send` does."""
        self._digest = zlib.crc32(packet, self._digest)
        self._link.send(packet, port, fail)

    def ask(self, packet: bytes, port: int, fail: Fail) -> bytes:
        """Send a request as `Link.ask` does, and record the answer."""
        answer = self._link.ask(packet, port, fail)
        digest = zlib.crc32(packet, self._digest)
        self._records.append(_DIGEST.pack(digest) + _join(answer))
        self._digest = 0
        return answer

    def write(self) -> None:
        """Write the file."""
        content = self._head.encode() + b"\n" + b"".join(self._records)
        with atomic_write(self._path) as stream, gzip.GzipFile(
            "", "wb", 9, stream, mtime=0
        ) as compressed:
            compressed.write(content)


class Session:
    """Recorded session that answers instead of the program.

    Parameters
    ----------
    path : str or path
        Session file.

    Attributes
    ----------
    about : dict
        Description of the flight.

    Raises
    ------
    InputError
        If the file is missing or damaged.
    """

    def __init__(self, path: Union[str, Path]) -> None:
        self.file = printable_name(path)
        with open_file(Path(path)) as stream:
            try:
                with gzip.open(stream) as opened:
                    content = opened.read(LARGEST + 1)
                head, _, rest = content.partition(b"\n")
                self.about: Dict[str, Any] = json.loads(head)
                version = self.about["quadcore session"]
                self._records = list(_split(rest))
            except (
                OSError,
                EOFError,
                ValueError,
                LookupError,
                TypeError,
                struct.error,
                zlib.error,
            ) as error:
                raise InputError(f"{self.file}: is no whole session. Record it again.") from error
        if version != _VERSION or len(content) > LARGEST:
            raise InputError(f"{self.file}: its version or size is not supported. Record it again.")
        self._digest = 0
        self._next = 0

    def send(self, packet: bytes, port: int, fail: Fail) -> None:
        """Add a packet to the digest."""
        self._digest = zlib.crc32(packet, self._digest)

    def ask(self, packet: bytes, port: int, fail: Fail) -> bytes:
        """Return the recorded answer if the packets match the recorded ones."""
        if self._next == len(self._records):
            raise fail(f"{self.file} ends here. Replay no more than was recorded.")
        digest, answer = self._records[self._next]
        if zlib.crc32(packet, self._digest) != digest:
            raise fail(
                f"the flight differs from {self.file}, which was recorded with other values or "
                "another version of quadcore"
            )
        self._next += 1
        self._digest = 0
        return answer

    def rewind(self) -> None:
        """Return to the start of the flight."""
        self._digest = self._next = 0

    @property
    def is_at_end(self) -> bool:
        """Whether all recorded answers were used."""
        return self._next == len(self._records)


def describe_session(
    stack: str, program: Path, settings: Mapping[str, Any], parameters: Mapping[str, str]
) -> Dict[str, Any]:
    """Return the description of a flight for `Recorder` as plain values.

    Parameters
    ----------
    stack
        Name of the stack.
    program
        Path of the program.
    settings
        Arguments of the stack's class for the replay of the session.
    parameters
        Parameters of the autopilot.
    """
    return {
        "autopilot": stack,
        "settings": dict(settings),
        "program": program.name,
        "sha256": hashlib.sha256(program.read_bytes()).hexdigest(),
        "parameters": dict(parameters),
    }


def _join(answer: bytes) -> bytes:
    """Encode an answer in pieces."""
    pieces = [answer[at : at + _PIECE] for at in range(0, len(answer) + 1, _PIECE)]
    return b"".join(bytes([len(piece)]) + piece for piece in pieces)


def _split(content: bytes) -> Iterator[Tuple[int, bytes]]:
    """Yield the digest and the answer of each record."""
    at = 0
    while at < len(content):
        (digest,) = _DIGEST.unpack_from(content, at)
        at += _DIGEST.size
        answer, size = b"", _PIECE
        while size == _PIECE:
            size = content[at]
            at += 1
            if at + size > len(content):
                raise ValueError("a record is cut")
            answer += content[at : at + size]
            at += size
        yield digest, answer
