"""Strict lockstep: a preloaded library controls the clock of the program."""

from __future__ import annotations

import select
import socket
import struct
import time
from pathlib import Path
from typing import Callable, Dict, Tuple

from .._core import InputError, plugin_folders
from ..support.warning import warn
from .exchange import PATIENCE, Exchange
from .program import Program

_HORIZON = struct.Struct("<q")
_START = 10 * 10**9  # ns; kStart of cpp/lockstep/preload.cpp
_STANDS, _HANDLED = b"s", b"h"
_WAIT = 50_000  # ns
_WAITS = 400
_LOOK = 256  # ticks between two looks at the messages of the program


class StrictExchange(Exchange):
    """Exchange in which the clock of the program stands still between two ticks.

    The library ``cpp/lockstep/preload.cpp`` is preloaded into the program. The main thread of the
    program waits at a horizon of time. In each tick, the program first handles the packets. Then
    the horizon moves by one period, and the program computes up to there. If its loop is late and
    has sent no outputs by then, the horizon moves on in pieces of 50 us, up to 20 ms. Betaflight
    scales its clock by the times in the packets, so that it follows the simulation all the same.

    Parameters
    ----------
    program : Program
        Program that answers.
    period : float
        Time between ticks, s.

    Attributes
    ----------
    missed : int
        Number of ticks in which the program sent no outputs after its first ones.
    """

    def __init__(self, program: Program, period: float) -> None:
        super().__init__(program, 0)
        self._period = round(period * 1e9)
        self._horizon = _START
        self._control, self._theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._control_poll = select.poll()
        self._control_poll.register(self._control, select.POLLIN)
        self._answer = b""
        self._ticks = 0
        self.missed = 0

    def describe_environment(self, ports: Dict[int, int]) -> Tuple[Dict[str, str], Tuple[int, ...]]:
        """Return the environment of the program, and the file descriptors to pass on.

        Parameters
        ----------
        ports
            Replacements of the program's ports; packets to port 0 are discarded.
        """
        fd = self._theirs.fileno()
        environment = {"QUADCORE_LOCKSTEP": str(fd), **describe_preload(ports)}
        return environment, (fd,)

    def begin(self, fail: Callable[[str], Exception]) -> None:
        """Wait until the program has started, and let it create its threads."""
        self._theirs.close()
        self._wait(_STANDS, fail)
        self._move(self._period, fail)

    def send(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> None:
        """Send a packet, and wait until the program has handled it."""
        super().send(packet, port, fail)
        self._wait(_HANDLED, fail)

    def ask(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> bytes:
        """Send a packet, let the program compute one period, and return its latest outputs.

        They are empty as long as the program has sent none.
        """
        began = time.perf_counter()
        self.send(packet, port, fail)
        self._move(self._period, fail)
        answer = self._read_last()
        for _ in range(_WAITS):
            if answer or not self._answer:
                break
            self._move(_WAIT, fail)
            answer = self._read_last()
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

    def _read_last(self) -> bytes:
        """Return the latest packet that has arrived, or an empty one."""
        answer = b""
        while self._poll.poll(0):
            answer = self._socket.recv(65536)
        return answer

    def _move(self, duration: int, fail: Callable[[str], Exception]) -> None:
        """Let the program compute for a duration (ns)."""
        self._horizon += duration
        try:
            self._control.send(_HORIZON.pack(self._horizon))
        except OSError:
            raise fail(self._program.describe_end()) from None
        self._wait(_STANDS, fail)

    def _wait(self, event: bytes, fail: Callable[[str], Exception]) -> None:
        """Wait until the program reports an event; it fails only if it ends."""
        waited = 0.0
        while not self._control_poll.poll(100):
            self._program.read_messages()
            waited += 0.1
            if abs(waited - PATIENCE) < 0.05:
                warn(
                    f"The autopilot has not answered for {PATIENCE:g} s. quadcore waits for it. If "
                    "it is linked statically, use lockstep: plain in the stack file."
                )
        try:
            read = self._control.recv(16)
        except OSError:
            read = b""
        if not read:
            raise fail(self._program.describe_end())
        if read != event:
            raise fail(
                f"the autopilot reported {read!r} instead of {event!r}: it is no program with one "
                "main loop. Use lockstep: plain in the stack file."
            )


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
