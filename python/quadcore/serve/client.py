"""A client of ``quadcore serve``. It and `protocol` need the standard library alone."""

from __future__ import annotations

import socket
from typing import List, Optional, Sequence, Tuple, Union

from . import protocol
from .protocol import Reply, Request

Row = Tuple[float, ...]


class ServerError(Exception):
    """The server refused a request, or the flight has failed.

    Attributes
    ----------
    failed : bool
        The flight has failed: it stands, until a reset.
    """

    def __init__(self, why: str, failed: bool) -> None:
        super().__init__(why)
        self.failed = failed


class Client:
    """Drives a served flight, which begins anew with each client.

    Parameters
    ----------
    address : int, (str, int) or str
        Port of this machine, host and port, or the path of a unix socket.

    Attributes
    ----------
    dt : float
        Length of a step, s.
    rotors : int
        Numbers of a command.
    columns : list of str
        Names of the numbers of a row: those of a log.

    Raises
    ------
    OSError
        Nobody listens there.
    ServerError
        The server speaks another version.
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
        """Fly on; returns the row at the end.

        Parameters
        ----------
        speeds : sequence of float, optional
            Signed rotor speeds before the division by sim_slow, rad/s; None keeps the ones before.
        steps : int
            How many; 0 gives the row that is.

        Raises
        ------
        ServerError
            The request is at fault, or the flight failed.
        """
        return self._ask(Request.STEP, [steps, *(() if speeds is None else speeds)])

    def reset(self, seed: Optional[int] = None) -> Row:
        """Begin another flight; returns its first row. Without a seed it has the one before."""
        return self._ask(Request.RESET, [] if seed is None else [seed])

    def close(self) -> None:
        """End the flight."""
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
            raise ConnectionError("the server has gone") from None
        if reply != Reply.DONE:
            raise ServerError(protocol.decode_text(answer), reply == Reply.FAILED)
        return answer
