"""Messages of clients of `quadcore serve`, whole, torn and odd."""

from __future__ import annotations

import random
import socket
import struct
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Callable

import odd

import quadcore as qc
from quadcore.serve import Server, protocol
from quadcore.serve.protocol import Request

# More steps take longer, and nothing else.
_NUMBERS = [number for number in odd.NUMBERS if not 3 < number <= 1e9]
_STEPS = (0, 1, 2, 3, -1, 0.5, 2e9, *_NUMBERS)


def target() -> Callable[[random.Random], None]:
    """Make a server, which serves each input's client after that has sent everything."""
    path = Path(tempfile.mkdtemp()) / "socket"
    server = Server(qc.Simulation("quadrotor", "eigen", spawn=(0, 0, 0.5)), str(path))

    def run(chance: random.Random) -> None:
        with socket.socket(socket.AF_UNIX) as client:
            client.connect(server.address)
            client.sendall(b"".join(message(chance) for _ in range(1 + chance.randrange(4))))
            client.shutdown(socket.SHUT_WR)
            server.serve(odd.check_one_line, clients=1)
            _read_replies(client)

    return run


def message(chance: random.Random) -> bytes:
    """Make a message, which is often a good one."""
    kind = chance.choice((*Request, *Request, -1, 4, 0.5, float("nan")))
    if chance.randrange(4) == 0:
        numbers = [chance.choice(_NUMBERS) for _ in range(chance.randrange(8))]
    elif kind == Request.HELLO:
        numbers = [protocol.VERSION]
    elif kind == Request.STEP:
        numbers = [chance.choice(_STEPS), *[chance.uniform(0, 600)] * chance.choice((0, 4, 4, 3))]
    elif kind == Request.RESET:
        numbers = [chance.choice(_NUMBERS)] * chance.randrange(3)
    else:
        numbers = []
    whole = protocol.pack_message(kind, numbers)
    change = chance.randrange(8)
    if change == 0:
        return whole[: chance.randrange(len(whole) + 1)]
    if change == 1:
        return whole[:8] + struct.pack("<d", chance.choice(_NUMBERS)) + whole[16:]
    if change == 2:
        place = chance.randrange(16)  # of the head
        return whole[:place] + bytes([chance.randrange(256)]) + whole[place + 1 :]
    return whole


def _read_replies(client: socket.socket) -> None:
    """Check that what came back is whole messages."""
    with suppress(EOFError, ConnectionResetError):
        while True:
            kind, _ = protocol.read_message(client.recv)
            assert kind in (0, 1, 2)
