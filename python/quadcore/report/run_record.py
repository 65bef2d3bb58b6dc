"""Record of the command that makes results: what the head of a page shows."""

from __future__ import annotations

import platform
import shlex
import time
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Dict, Iterator, Sequence

from .. import __version__

_record: ContextVar[Dict[str, str]] = ContextVar("quadcore_run_record")


@contextmanager
def record_command(words: Sequence[str]) -> Iterator[None]:
    """Record a command line within the block."""
    record = {
        "command": shlex.join(["quadcore", *words]),
        "quadcore": __version__,
        "date": time.strftime("%Y-%m-%d %H:%M:%S %z"),
        "host": platform.node(),
    }
    token = _record.set(record)
    try:
        yield
    finally:
        _record.reset(token)


def describe_command() -> Dict[str, str]:
    """Return command line, version, date and host; empty if no command runs."""
    return dict(_record.get({}))
