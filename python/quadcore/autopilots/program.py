"""Process of an autopilot; it ends with the flight, even if quadcore crashes."""

from __future__ import annotations

import collections
import os
import select
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Deque, Mapping, Optional, Sequence

from .._core import InputError
from ..support import interrupts
from ..support.output_files import printable_name

_LINES = 5
"""Number of last messages that an error quotes."""

_PATIENCE = 5.0  # s; time limit for a killed process to end
_LONGEST = 60.0  # s; time limit for a program that writes parameters

# Reads the group of the running process. When quadcore ends for any reason, it kills the group and
# removes the folder.
_WATCH = (
    'while read -r group; do last=$group; done; [ -z "$last" ] || kill -s KILL -- "-$last"; '
    'rm -rf -- "$1"'
)


class Program:
    """Program with its own working folder.

    Attributes
    ----------
    folder : Path
        Working folder, which is removed at the end.
    """

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="quadcore-autopilot-"))
        self._messages: Deque[str] = collections.deque(maxlen=_LINES)
        self._rest = b""
        self._process: Optional[subprocess.Popen] = None
        self._terminal = -1
        self._watch = subprocess.Popen(
            ["sh", "-c", _WATCH, "sh", str(self.folder)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def run(self, command: Sequence[str], environment: Mapping[str, str]) -> str:
        """Run a command in the folder until it ends, and return its output.

        Raises
        ------
        InputError
            If the command cannot be run or fails.
        """
        process = self._launch(command, environment, subprocess.PIPE)
        try:
            output = str(process.communicate(timeout=_LONGEST)[0], errors="replace")
        except subprocess.TimeoutExpired:
            raise InputError(
                f"{printable_name(command[0])}: '{' '.join(command[1:])}' did not end within "
                f"{_LONGEST:g} s. Try it in a terminal."
            ) from None
        if process.returncode:
            last = " ".join(output.strip().splitlines()[-1:])
            raise InputError(
                f"{printable_name(command[0])}: '{' '.join(command[1:])}' ended with exit status "
                f"{process.returncode}: {last}"
            )
        return output

    def start(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        passed: Sequence[int] = (),
    ) -> None:
        """Start the program.

        Parameters
        ----------
        command
            Program and arguments.
        environment
            Variables to add to the environment.
        passed
            File descriptors that the program inherits.

        Raises
        ------
        InputError
            If the program cannot be started.
        """
        # Programs write complete lines to a terminal, but blocks to a pipe.
        self._terminal, output = os.openpty()
        os.set_blocking(self._terminal, False)
        try:
            self._launch(command, environment, output, passed)
        finally:
            os.close(output)

    def has_ended(self) -> bool:
        """Whether the program has ended."""
        return self._process is None or self._process.poll() is not None

    def describe_end(self) -> str:
        """Describe how the program ended, with its last messages."""
        assert self._process is not None
        code = self._process.wait()
        how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit status {code}"
        return f"the autopilot ended ({how}). {self.describe_messages()}"

    def describe_messages(self) -> str:
        """Quote the last messages of the program."""
        self.read_messages()
        if not self._messages:
            return "It printed nothing."
        return f"Its last messages: {' | '.join(self._messages)}"

    def read_messages(self) -> None:
        """Read the output of the program, which would block if the buffer were full."""
        while select.select([self._terminal], [], [], 0)[0]:
            try:
                read = os.read(self._terminal, 65536)
            except OSError:  # the program has closed its output
                return
            *lines, self._rest = (self._rest + read).split(b"\n")
            for line in lines:
                text = "".join(c for c in line.decode(errors="replace") if c.isprintable())
                if text.strip():
                    self._messages.append(text.strip())

    def stop(self) -> None:
        """End the program and its children, and remove the folder."""
        assert self._watch.stdin is not None
        self._watch.stdin.close()
        self._watch.wait(_PATIENCE)
        if self._process is not None:
            self._process.wait(_PATIENCE)
            if self._process.stdout is not None:
                self._process.stdout.close()
        if self._terminal >= 0:
            os.close(self._terminal)
            self._terminal = -1

    def _launch(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        output: int,
        passed: Sequence[int] = (),
    ) -> subprocess.Popen:
        assert self._watch.stdin is not None
        with interrupts.hold_signals():
            try:
                self._process = subprocess.Popen(
                    command,
                    cwd=self.folder,
                    env={**os.environ, **environment},
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                    pass_fds=passed,
                )
            except OSError as error:
                raise InputError(
                    f"{printable_name(command[0])}: cannot be run: {error.strerror or error}. "
                    "Correct program: in the stack file."
                ) from error
            self._watch.stdin.write(b"%d\n" % self._process.pid)
            self._watch.stdin.flush()
        return self._process
