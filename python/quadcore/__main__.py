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

    After a signal the process ends at once: C modules of other packages that the signal interrupted
    may abort when the interpreter shuts down.
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
