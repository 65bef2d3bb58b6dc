"""Connection to a client, with time limits so that silent clients do not block others."""

from __future__ import annotations

import select
import socket
import time
from typing import Tuple

from . import protocol

_GONE = select.POLLRDHUP | select.POLLHUP | select.POLLERR


class Connection:
    """Receives messages from a client and sends replies.

    Parameters
    ----------
    client : socket
        Socket of the client.
    others : socket
        Listening socket, at which other clients wait.
    timeout : float
        Maximum silence, s. It applies before the first message, within a message, and while a
        client does not read replies. Between messages, it applies only while another client waits.

    Raises
    ------
    ConnectionError
        If the client has disconnected or is silent for too long.
    """

    def __init__(self, client: socket.socket, others: socket.socket, timeout: float) -> None:
        self._client, self._others, self._timeout = client, others, timeout
        self._has_asked = False
        if client.family != socket.AF_UNIX:
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def receive(self) -> Tuple[int, Tuple[float, ...]]:
        """Wait for a message, and return kind and numbers; errors as in `protocol.read_message`."""
        self._wait()
        end = time.monotonic() + self._timeout

        def receive(count: int) -> bytes:
            self._client.settimeout(max(end - time.monotonic(), 1e-3))
            return self._client.recv(count)

        try:
            message = protocol.read_message(receive)
        except socket.timeout:
            raise ConnectionError(f"silent within a message for {self._timeout:g} s") from None
        self._has_asked = True
        return message

    def send(self, message: bytes) -> None:
        """Send a message."""
        self._client.settimeout(self._timeout)
        try:
            self._client.sendall(message)
        except socket.timeout:
            raise ConnectionError(f"no answer read for {self._timeout:g} s") from None

    def check_there(self) -> None:
        """Raise `ConnectionError` if the client has disconnected."""
        poll = select.poll()
        poll.register(self._client, _GONE)
        if poll.poll(0):
            raise ConnectionError("disconnected before its steps were complete")

    def _wait(self) -> None:
        """Wait until a message starts or the client disconnects."""
        poll = select.poll()
        poll.register(self._client, select.POLLIN)
        if poll.poll(1000 * self._timeout):
            return
        if self._has_asked and self._comes_first(poll):
            return
        raise ConnectionError(f"no message for {self._timeout:g} s")

    def _comes_first(self, poll: select.poll) -> bool:
        """Continue to wait; return whether the client sends data before another client connects."""
        others = self._others.fileno()
        if others >= 0:  # otherwise the server is closed
            poll.register(others, select.POLLIN)
        while True:
            ready = dict(poll.poll())
            if ready.pop(self._client.fileno(), 0):
                return True
            if ready.get(others, 0) & select.POLLIN:
                return False
            poll.unregister(others)
