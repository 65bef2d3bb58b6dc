"""The program: ``quadcore``, ``python -m quadcore``."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import NoReturn

from .cli import main

_FIRST_OF_SIGNALS = 128


def run() -> NoReturn:
    """End the process with the status of the command line.

    One that a signal ended is left at once, for the modules of others (in C) whose work it cut off
    may abort when the interpreter is taken down.
    """
    status = main()
    if status > _FIRST_OF_SIGNALS:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        os._exit(status)
    sys.exit(status)


if __name__ == "__main__":
    run()
