"""Connections to PX4: TCP for sensors and motors, UDP for set-points and telemetry.

PX4 connects to TCP port 4560 + i, where i is its instance number. It receives MAVLink on UDP port
14580 + i, and sends it to port 14540 + i (``ROMFS/px4fmu_common/init.d-posix/px4-rc.mavlink``).
"""

from __future__ import annotations

import contextlib
import os
import select
import socket
import time
from typing import Callable, Iterator, List, Tuple

from ..._core import InputError
from ..exchange import HOST, check_free
from ..program import Program
from ..waiting import Waiting, describe_durations

_SIMULATOR, _OFFBOARD, _TELEMETRY, _GROUND = 4560, 14580, 14540, 18570
_INSTANCES = 10  # PX4 sends the telemetry of higher instances to a single port

_MOTORS = 93  # MAVLink number of HIL_ACTUATOR_CONTROLS, the answer to HIL_SENSOR

_LOOK = 0.25  # s; interval between checks of the program
_STARTING = 0.05  # s; time limit for an answer while PX4 starts, when it may not answer
_MAGIC, _HEAD, _TAIL, _SIGNATURE = 0xFD, 10, 2, 13  # MAVLink 2

Fail = Callable[[str], Exception]


class Px4Link:
    """Connections to one PX4 program.

    Parameters
    ----------
    program : Program
        PX4 program, which is started after the link.

    Attributes
    ----------
    instance : int
        Instance number for the start of PX4.
    durations : list of float
        Time until each answer, s.

    Raises
    ------
    InputError
        If no instance number is free.
    """

    def __init__(self, program: Program) -> None:
        self._program = program
        self.durations: List[float] = []
        self.has_answered = False
        self._rest = b""
        self._stack = contextlib.ExitStack()
        self.instance, self._server, self._radio = _open_sockets()
        self._stack.callback(self._server.close)
        self._stack.callback(self._radio.close)
        self._socket: socket.socket

    def accept(self, fail: Fail) -> None:
        """Wait until PX4 connects."""
        waiting = Waiting(self._program, fail)
        while not select.select([self._server], [], [], _LOOK)[0]:
            waiting.look()
        self._socket = self._server.accept()[0]
        self._stack.callback(self._socket.close)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._poll = select.poll()
        self._poll.register(self._socket, select.POLLIN)

    def send(self, packet: bytes, port: int, fail: Fail) -> None:
        """Send a UDP packet that has no answer."""
        self._radio.sendto(packet, (HOST, _OFFBOARD + self.instance))

    def ask(self, packet: bytes, port: int, fail: Fail) -> bytes:
        """Send sensor data, and return the motors and the received telemetry.

        Until the first answer of PX4, the result may lack the motors.
        """
        began = time.perf_counter()
        try:
            self._socket.sendall(packet)
            motors = self._wait(find_time(packet), fail)
        except OSError:
            raise self._fail_at_end(fail) from None
        self.has_answered = self.has_answered or bool(motors)
        self.durations.append(time.perf_counter() - began)
        return motors + b"".join(self._read_telemetry())

    def summarize(self) -> str:
        """Describe the answers in one line."""
        return describe_durations(self.durations)

    def close(self) -> None:
        """Close all connections."""
        self._stack.close()

    def _wait(self, asked: int, fail: Fail) -> bytes:
        """Return the motors for sensor data of a time (us); empty if PX4 is still starting."""
        waiting = Waiting(self._program, fail)
        while True:
            for frame in self._split():
                if frame[0] != _MAGIC:
                    raise fail("the autopilot has sent bytes that are not MAVLink 2")
                if find_number(frame) == _MOTORS and find_time(frame) >= asked:
                    return frame
            if self._poll.poll(1000 * (_LOOK if self.has_answered else _STARTING)):
                received = self._socket.recv(65536)
                if not received:
                    raise self._fail_at_end(fail)
                self._rest += received
            else:
                waiting.look()
                if not self.has_answered:
                    return b""

    def _split(self) -> Iterator[bytes]:
        """Yield the complete frames that have arrived, and keep the rest."""
        while len(self._rest) >= _HEAD and len(self._rest) >= find_length(self._rest):
            length = find_length(self._rest)
            frame, self._rest = self._rest[:length], self._rest[length:]
            yield frame

    def _read_telemetry(self) -> Iterator[bytes]:
        with contextlib.suppress(BlockingIOError):
            while True:
                yield self._radio.recv(65536)

    def _fail_at_end(self, fail: Fail) -> Exception:
        time.sleep(_STARTING)  # until the system knows the exit status
        if self._program.has_ended():
            return fail(self._program.describe_end())
        return fail(f"the autopilot has closed the connection. {self._program.describe_messages()}")


def find_length(frame: bytes) -> int:
    """Return the length of a MAVLink 2 frame from its head; 1 if no frame begins here."""
    if frame[0] != _MAGIC:
        return 1
    return _HEAD + frame[1] + _TAIL + (_SIGNATURE if frame[2] & 1 else 0)


def find_number(frame: bytes) -> int:
    """Return the message number of a frame."""
    return int.from_bytes(frame[7:_HEAD], "little")


def find_time(frame: bytes) -> int:
    """Return the time (us) at the start of HIL_SENSOR and HIL_ACTUATOR_CONTROLS."""
    return int.from_bytes(frame[_HEAD : _HEAD + 8], "little")


def _open_sockets() -> Tuple[int, socket.socket, socket.socket]:
    """Return a free instance number, and a TCP server and a UDP socket on its ports."""
    last = None
    for attempt in range(_INSTANCES):
        instance = (os.getpid() + attempt) % _INSTANCES
        with contextlib.ExitStack() as stack:
            server = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_STREAM))
            radio = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                server.bind((HOST, _SIMULATOR + instance))
                server.listen(1)
                radio.bind((HOST, _TELEMETRY + instance))
                for port in (_OFFBOARD, _GROUND):
                    check_free(socket.SOCK_DGRAM, port + instance)
            except (OSError, InputError) as error:
                last = error
                continue
            radio.setblocking(False)
            stack.pop_all()
            return instance, server, radio
    raise InputError(
        f"no port of the instances 0 to {_INSTANCES - 1} of PX4 is free ({last}). End other PX4s, "
        "or use fewer --jobs."
    )
