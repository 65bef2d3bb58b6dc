"""Client of ``quadcore serve``; this module and `protocol` need only the standard library."""

from __future__ import annotations

import socket
from typing import List, Optional, Sequence, Tuple, Union

from . import protocol
from .protocol import Reply, Request

Row = Tuple[float, ...]


class ServerError(Exception):
    """Error of a request or a flight.

    Attributes
    ----------
    failed : bool
        Whether the flight has failed; then only a reset is possible.
    """

    def __init__(self, why: str, failed: bool) -> None:
        super().__init__(why)
        self.failed = failed


class Client:
    """Connection to a server; each client starts a new flight.

    Parameters
    ----------
    address : int, (str, int) or str
        Port on this machine, host and port, or path of a Unix socket.

    Attributes
    ----------
    dt : float
        Step of the simulation, s.
    rotors : int
        Number of values of a command.
    columns : list of str
        Names of the values of a row, as in a log.

    Raises
    ------
    OSError
        If no server listens at the address.
    ServerError
        If the server uses another version of the protocol.
    """

    def __init__(self, address: Union[int, Tuple[str, int], str]) -> None:
        if isinstance(address, str):
            self._socket = socket.socket(socket.AF_UNIX)
            self._socket.connect(address)
        else:
            to = ("127.0.0.1", address) if isinstance(address, int) else address
            self._socket = socket.create_connection(to)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        _, self.dt, rotors, _ = self._ask(Request.HELLO, [protocol.VERSION])
        self.rotors = int(rotors)
        self.columns: List[str] = protocol.decode_text(self._ask(Request.COLUMNS)).split(",")

    def step(self, speeds: Optional[Sequence[float]] = None, steps: int = 1) -> Row:
        """Advance the flight, and return the last row.

        Parameters
        ----------
        speeds : sequence of float, optional
            Signed rotor speeds before the division by sim_slow, rad/s (default: unchanged).
        steps : int
            Number of steps; 0 returns the current row.

        Raises
        ------
        ServerError
            If the request is invalid or the flight fails.
        """
        return self._ask(Request.STEP, [steps, *(() if speeds is None else speeds)])

    def reset(self, seed: Optional[int] = None) -> Row:
        """Start a new flight, by default with the same seed, and return its first row."""
        return self._ask(Request.RESET, [] if seed is None else [seed])

    def close(self) -> None:
        """End the flight, and close the connection."""
        self._socket.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _ask(self, kind: Request, numbers: Sequence[float] = ()) -> Row:
        self._socket.sendall(protocol.pack_message(kind, numbers))
        try:
            reply, answer = protocol.read_message(self._socket.recv)
        except EOFError:
            raise ConnectionError("the server has closed the connection") from None
        if reply != Reply.DONE:
            raise ServerError(protocol.decode_text(answer), reply == Reply.FAILED)
        return answer
