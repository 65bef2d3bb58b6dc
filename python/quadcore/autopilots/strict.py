"""Strict lockstep: a preloaded library controls the clock of the program."""

from __future__ import annotations

import socket
import struct
import time
from pathlib import Path
from typing import Callable, Dict, Tuple

from .._core import InputError, plugin_folders
from .exchange import Exchange
from .program import Program
from .waiting import Waiting

_COMMAND = struct.Struct("<qq")  # Command of cpp/lockstep/preload.cpp
_LIMIT = struct.pack("ll", 0, 100_000)  # timeval; s, us
_LONGEST = 65536  # bytes
_START = 10 * 10**9  # ns; kStart of cpp/lockstep/preload.cpp
_WAIT = 50_000  # ns
_WAITS = 400
_ADVICE = "If it is linked statically, use lockstep: plain in the stack file."
_LOOK = 256  # ticks between checks for messages of the program


class StrictExchange(Exchange):
    """Exchange in which the clock of the program stops between ticks.

    The library ``cpp/lockstep/preload.cpp`` is preloaded into the program. The main thread of the
    program waits at a time horizon. In each tick, the program first handles the packets. Then the
    horizon moves by one period, and the program computes up to this time. The event that ends the
    tick contains the outputs. If the loop is late and has sent no outputs, the horizon moves on in
    pieces of 50 us, up to 20 ms. Betaflight scales its clock by the times in the packets, so it
    still follows the simulation.

    Parameters
    ----------
    program : Program
        Program that answers.
    period : float
        Time between ticks, s.

    Attributes
    ----------
    missed : int
        Number of ticks without outputs after the first ones.
    """

    def __init__(self, program: Program, period: float) -> None:
        super().__init__(program, 0)
        self._period = round(period * 1e9)
        self._horizon = _START
        self._control, self._theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._control.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, _LIMIT)
        self._sent = 0
        self._answer = b""
        self._ticks = 0
        self.missed = 0

    def describe_environment(
        self, ports: Dict[int, int], answers: int
    ) -> Tuple[Dict[str, str], Tuple[int, ...]]:
        """Return the environment of the program, and the file descriptors that it inherits.

        Parameters
        ----------
        ports
            Replacements of the program's ports; packets to port 0 are discarded.
        answers
            Port to which the program sends its outputs.
        """
        fd = self._theirs.fileno()
        control = {"QUADCORE_LOCKSTEP": str(fd), "QUADCORE_ANSWERS": str(answers)}
        return {**control, **describe_preload(ports)}, (fd,)

    def begin(self, fail: Callable[[str], Exception]) -> None:
        """Wait until the program has started, and let it create its threads."""
        self._theirs.close()
        self._wait(fail)
        self._move(self._period, fail)

    def send(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> None:
        """Send a packet, and wait until the program has handled it."""
        super().send(packet, port, fail)
        self._sent += 1
        self._move(0, fail)

    def ask(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> bytes:
        """Send a packet, let the program compute one period, and return its latest outputs.

        The outputs are empty until the program has sent some.
        """
        began = time.perf_counter()
        super().send(packet, port, fail)
        self._sent += 1
        answer = self._move(self._period, fail)
        for _ in range(_WAITS):
            if answer or not self._answer:
                break
            answer = self._move(_WAIT, fail)
        if answer:
            self._answer = answer
        elif self._answer:
            self.missed += 1
        self.durations.append(time.perf_counter() - began)
        self._ticks += 1
        if self._ticks % _LOOK == 0:
            self._program.read_messages()
        return self._answer

    def summarize(self) -> str:
        """Describe the answers in one line."""
        return f"{super().summarize()}, {self.missed} missed"

    def close(self) -> None:
        """Close the sockets."""
        super().close()
        self._control.close()
        self._theirs.close()

    def _move(self, duration: int, fail: Callable[[str], Exception]) -> bytes:
        """Let the program compute for a duration (ns), and return its latest outputs."""
        self._horizon += duration
        try:
            self._control.send(_COMMAND.pack(self._horizon, self._sent))
        except OSError:
            raise fail(self._program.describe_end()) from None
        return self._wait(fail)

    def _wait(self, fail: Callable[[str], Exception]) -> bytes:
        """Wait until the program stops at the horizon, and return its latest outputs."""
        waiting = Waiting(self._program, fail, _ADVICE)
        while True:
            try:
                event = self._control.recv(_LONGEST)
                break
            except BlockingIOError:
                waiting.look()
            except OSError:
                event = b""
                break
        if not event:
            raise fail(self._program.describe_end())
        return event[1:]


def describe_preload(ports: Dict[int, int]) -> Dict[str, str]:
    """Return the environment that preloads the library and replaces ports."""
    library = _find_library()
    return {
        "LD_PRELOAD": str(library),
        "QUADCORE_PORTS": ",".join(f"{old}:{new}" for old, new in ports.items()),
    }


def _find_library() -> Path:
    library = Path(plugin_folders()[-1]) / "lockstep" / "libquadcore_lockstep.so"
    if not library.is_file():
        raise InputError(f"{library}: the file is missing. Build quadcore again.")
    return library
