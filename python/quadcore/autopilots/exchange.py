"""Stop-and-wait exchange of datagrams with an autopilot on this machine."""

from __future__ import annotations

import contextlib
import itertools
import os
import select
import socket
import time
from typing import Callable, List

from .._core import InputError
from .program import Program
from .waiting import Waiting, describe_durations

HOST = "127.0.0.1"

_AGAIN = 0.25  # s; time without an answer after which a request is repeated
_SETTLE = 0.02  # s; later answers to a repeated request are discarded
_FIRST_PORT, _PORTS = 16384, 16384  # range in which free ports are searched
_asked = itertools.count()  # number of calls of find_free_port


class Exchange:
    """UDP socket that sends requests and waits for answers while the other program runs.

    Parameters
    ----------
    program : Program
        Program that answers.
    port : int
        Port to which the program sends its answers. 0: any free port.

    Attributes
    ----------
    durations : list of float
        Time until each answer, s.
    repeated : int
        Number of repeated requests.

    Raises
    ------
    InputError
        If the port is in use.
    """

    def __init__(self, program: Program, port: int) -> None:
        self._program = program
        self.durations: List[float] = []
        self.repeated = 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((HOST, port))
        except OSError as error:
            self._socket.close()
            raise describe_taken("UDP", port, error) from error
        self._socket.setblocking(False)
        self._poll = select.poll()
        self._poll.register(self._socket, select.POLLIN)

    @property
    def port(self) -> int:
        """Port to which the program sends its answers."""
        return int(self._socket.getsockname()[1])

    def send(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> None:
        """Send a packet that has no answer; the arguments are those of `ask`."""
        self._socket.sendto(packet, (HOST, port))

    def ask(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> bytes:
        """Send a packet, and return the answer.

        Parameters
        ----------
        packet
            Request, which is repeated if there is no answer.
        port
            Port of the program.
        fail
            Function that makes the error if the program ends.
        """
        began = asked = time.perf_counter()
        repeated, waiting = False, Waiting(self._program, fail)
        self._socket.sendto(packet, (HOST, port))
        while not self._poll.poll(_AGAIN * 1000):
            waiting.look()
            now = time.perf_counter()
            if now - asked >= _AGAIN:
                self._socket.sendto(packet, (HOST, port))
                self.repeated += 1
                repeated, asked = True, now
        answer = self._socket.recv(65536)
        self.durations.append(time.perf_counter() - began)
        if repeated:
            self.discard()
        return answer

    def wait_for_sender(self, fail: Callable[[str], Exception]) -> int:
        """Wait for the first packet of the program, and return its source port."""
        waiting = Waiting(self._program, fail)
        while not self._poll.poll(_AGAIN * 1000):
            waiting.look()
        return int(self._socket.recvfrom(65536)[1][1])

    def discard(self) -> None:
        """Discard answers that arrive within a short time."""
        while self._poll.poll(_SETTLE * 1000):
            self._socket.recv(65536)

    def summarize(self) -> str:
        """Describe the answers in one line."""
        return f"{describe_durations(self.durations)}, {self.repeated} questions repeated"

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def check_free(kind: int, port: int) -> None:
    """Raise `InputError` if another program uses a port on this machine.

    Parameters
    ----------
    kind
        ``socket.SOCK_DGRAM`` for UDP, ``socket.SOCK_STREAM`` for TCP.
    port
        Port.
    """
    with socket.socket(socket.AF_INET, kind) as probe:
        if kind == socket.SOCK_STREAM:  # earlier connections may still linger
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            name = "TCP" if kind == socket.SOCK_STREAM else "UDP"
            raise describe_taken(name, port, error) from error


def find_free_port(kind: int) -> int:
    """Return a port on this machine that is currently free.

    The system assigns ports from 32768 on. This port is lower, so no connection takes it before the
    autopilot opens it. Each process starts the search at another port.
    """
    for _ in range(_PORTS):
        port = _FIRST_PORT + (8 * os.getpid() + next(_asked)) % _PORTS
        with contextlib.suppress(InputError):
            check_free(kind, port)
            return port
    raise InputError("no port is free. End other autopilots or simulators.")


def describe_taken(kind: str, port: int, error: OSError) -> InputError:
    """Make the error for a port that is in use."""
    return InputError(
        f"{kind} port {port}: {error.strerror or error}. End the other autopilot or simulator, or "
        "run one flight at a time (--jobs 1)."
    )
