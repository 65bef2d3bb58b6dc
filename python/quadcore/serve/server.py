"""Server for flights of one simulation, with one client at a time."""

from __future__ import annotations

import errno
import os
import socket
import stat
from contextlib import suppress
from typing import Callable, List, Optional, Sequence, Tuple, Union

from .. import _core
from ..formats.rows import Recorder
from ..simulation.flight import list_columns
from ..simulation.simulation import Simulation
from . import protocol
from .connection import Connection
from .protocol import ProtocolError, Reply, Request
from .served_flight import ServedFlight

TIMEOUT = 60.0
"""Default time limit for a silent client, s."""

_LONGEST = 1e6  # s; maximum time limit


class Server:
    """Server on a local socket; the simulation runs in lockstep with its client.

    Parameters
    ----------
    simulation : Simulation
        Simulation to serve. Each client starts from its initial state.
    address : int or str
        Port of 127.0.0.1 (0: any free port), or path of a new Unix socket.
    topics : sequence of str
        Topics with columns that follow those of the state in each row.
    record : callable, optional
        Function called at the start of each flight; returns a recorder of its rows.
    log_every : int
        Steps between recorded rows.
    timeout : float
        Time after which a silent client is disconnected, s; see `Connection`.

    Attributes
    ----------
    address : str
        Address of the server.

    Raises
    ------
    InputError
        If the address is in use, a topic does not exist, or the timeout is not positive.
    """

    def __init__(
        self,
        simulation: Simulation,
        address: Union[int, str] = 0,
        topics: Sequence[str] = (),
        record: Optional[Callable[[], Recorder]] = None,
        log_every: int = 1,
        timeout: float = TIMEOUT,
    ) -> None:
        if not 0 < timeout <= _LONGEST:
            raise _core.InputError(
                f"the timeout is {timeout:g} s. Give more than 0, at most {_LONGEST:g}."
            )
        self._timeout = timeout
        self._simulation, self._topics = simulation, list(topics)
        self._record, self._log_every = record, log_every
        self._start = simulation.snapshot()  # includes the seed
        self.columns = list_columns(simulation, topics)
        self._socket, self._path = _listen(address)
        self._is_closed = False
        if self._path is None:
            self.address = "{}:{}".format(*self._socket.getsockname())
        else:
            self.address = self._path

    def serve(self, tell: Callable[[str], None], clients: Optional[int] = None) -> None:
        """Serve clients one after another, until `close` or for a number of clients.

        Parameters
        ----------
        tell
            Function called with a line about each disconnected client or incomplete log.
        clients
            Number of clients (default: unlimited).
        """
        served = 0
        while served != clients:
            try:
                connection, _ = self._socket.accept()
            except OSError:
                if self._is_closed:
                    return
                raise
            served += 1
            with connection:
                try:
                    self._serve(Connection(connection, self._socket, self._timeout))
                except (ProtocolError, ConnectionError, _core.InputError) as error:
                    tell(f"client {served}: {error}")

    def close(self) -> None:
        """Stop listening; any thread may call this. The current client is still served."""
        self._is_closed = True
        with suppress(OSError):  # some systems can shut down only connected sockets
            self._socket.shutdown(socket.SHUT_RDWR)  # wakes a waiting accept
        self._socket.close()
        if self._path is not None:
            os.unlink(self._path)
            self._path = None

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _serve(self, client: Connection) -> None:
        self._simulation.restore(self._start)
        flown = ServedFlight(
            self._simulation,
            self._topics,
            self._record,
            self._log_every,
            client.check_there,
        )
        try:
            while True:
                try:
                    kind, numbers = client.receive()
                except EOFError:
                    return
                except ProtocolError as error:
                    client.send(_pack_text(Reply.REFUSED, str(error)))
                    raise
                client.send(self._answer(flown, Request(kind), numbers))
        finally:
            flown.close()

    def _answer(self, flown: ServedFlight, kind: Request, numbers: Sequence[float]) -> bytes:
        try:
            if kind == Request.HELLO:
                return protocol.pack_message(Reply.DONE, self._greet(numbers))
            if kind == Request.COLUMNS:
                return _pack_text(Reply.DONE, ",".join(self.columns))
            if kind == Request.STEP:
                return protocol.pack_message(Reply.DONE, flown.step(numbers))
            return protocol.pack_message(Reply.DONE, flown.reset(numbers))
        except _core.InputError as error:
            return _pack_text(Reply.REFUSED, str(error))
        except _core.FlightError as error:
            return _pack_text(Reply.FAILED, str(error))

    def _greet(self, numbers: Sequence[float]) -> List[float]:
        if list(numbers) != [protocol.VERSION]:
            version = ", ".join(f"{number:g}" for number in numbers) or "''"
            raise _core.InputError(
                f"unsupported protocol version {version} (expected {protocol.VERSION})"
            )
        simulation = self._simulation
        return [protocol.VERSION, simulation.dt, simulation.command_width, len(self.columns)]


def _pack_text(reply: Reply, text: str) -> bytes:
    return protocol.pack_message(reply, protocol.encode_text(text))


def _listen(address: Union[int, str]) -> Tuple[socket.socket, Optional[str]]:
    """Open a listening socket; return it and its path (None for a port)."""
    listening = socket.socket(socket.AF_INET if isinstance(address, int) else socket.AF_UNIX)
    try:
        if isinstance(address, int):
            listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listening.bind(("127.0.0.1", address))
        else:
            if not address:
                raise _core.InputError("the path of the socket is empty. Name one.")
            _remove_stale_socket(address)
            listening.bind(address)
        listening.listen()
    except (OSError, OverflowError) as error:
        listening.close()
        raise _core.InputError(
            f"cannot listen at {address}: {error}. Give another address."
        ) from None
    return listening, None if isinstance(address, int) else address


def _remove_stale_socket(path: str) -> None:
    """Remove the socket file of a killed server."""
    if not (os.path.exists(path) and stat.S_ISSOCK(os.stat(path).st_mode)):
        return
    with socket.socket(socket.AF_UNIX) as probe:
        if probe.connect_ex(path) == errno.ECONNREFUSED:
            os.unlink(path)
