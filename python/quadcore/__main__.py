"""The program: ``quadcore``, ``python -m quadcore``."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import NoReturn

from .cli import main
from .support.interrupts import ENDED


def run() -> NoReturn:
    """End the process with the status of the command line.

    One that a signal ended is left at once, for the modules of others (in C) whose work it cut off
    may abort when the interpreter is taken down.
    """
    status = main()
    if status > ENDED:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        os._exit(status)
    sys.exit(status)


if __name__ == "__main__":
    run()
