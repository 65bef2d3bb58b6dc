"""Questions to Betaflight over TCP with MSP (MultiWii Serial Protocol) version 1."""

from __future__ import annotations

import math
import socket
import struct
from typing import Callable, Sequence, Tuple

from ..._core import InputError
from ..exchange import HOST

_ATTITUDE, _SET_MOTOR = 108, 214  # src/main/msp/msp_protocol.h
_START = b"$M>"
_PAUSE = 1e-3  # s; interval between checks for an answer
_LOOKS = 5000
_LONGEST = 1024  # maximum number of bytes per read


class Msp:
    """Connection to the MSP port of a program.

    Parameters
    ----------
    port : int
        TCP port on this machine.
    tick : callable
        Function that lets the program compute one period, because it answers in its main loop.

    Raises
    ------
    InputError
        If the program does not listen on the port, or its answers violate the protocol.
    """

    def __init__(self, port: int, tick: Callable[[], object]) -> None:
        self._tick = tick
        self._read = b""
        try:
            self._socket = socket.create_connection((HOST, port), timeout=5)
        except OSError as error:
            raise InputError(
                f"TCP port {port}: the autopilot does not answer questions there: "
                f"{error.strerror or error}. Use its default serial settings."
            ) from None
        self._socket.settimeout(_PAUSE)

    def read_attitude(self) -> Tuple[float, float, float]:
        """Return the estimated roll, pitch and yaw, rad, for forward, left, up axes."""
        roll, pitch, heading = struct.unpack_from("<hhh", self._ask(_ATTITUDE, b"", 6))
        # A lowered nose is a positive pitch, as about an axis to the left. Headings are clockwise.
        return math.radians(roll / 10), math.radians(pitch / 10), -math.radians(heading)

    def set_motors(self, outputs: Sequence[float]) -> None:
        """Run the motors of a disarmed autopilot at these outputs, from 0 to 1."""
        self._ask(_SET_MOTOR, struct.pack("<4H", *(1000 + round(1000 * x) for x in outputs)), 0)

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def _ask(self, command: int, payload: bytes, size: int) -> bytes:
        """Send a request, and return the payload of the answer, which has at least `size` bytes."""
        body = bytes([len(payload), command]) + payload
        self._socket.sendall(b"$M<" + body + bytes([_compute_checksum(body)]))
        for _ in range(_LOOKS):
            self._tick()
            try:
                received = self._socket.recv(_LONGEST)
            except socket.timeout:
                continue
            if not received:
                raise InputError("The autopilot closed the connection of its MSP port.")
            self._read += received
            self._check_start()
            while len(self._read) >= 6 and len(self._read) >= self._read[3] + 6:
                end = self._read[3] + 6
                frame, self._read = self._read[:end], self._read[end:]
                if _compute_checksum(frame[3:-1]) != frame[-1]:
                    raise InputError("MSP: an answer of the autopilot has a wrong checksum.")
                if frame[4] == command:
                    if frame[3] < size:
                        raise InputError(
                            f"MSP: the answer to {command} has {frame[3]} bytes instead of {size}."
                        )
                    return frame[5:-1]
        raise InputError(f"MSP: the autopilot did not answer the request {command}.")

    def _check_start(self) -> None:
        start = self._read[: len(_START)]
        if not _START.startswith(start):
            raise InputError(
                f"MSP: an answer of the autopilot starts with {start!r} instead of {_START!r}."
            )


def _compute_checksum(body: bytes) -> int:
    check = 0
    for byte in body:
        check ^= byte
    return check
