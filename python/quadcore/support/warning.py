"""Warnings of quadcore."""

import sys
import warnings
from contextlib import contextmanager
from types import FrameType
from typing import Iterator


class QuadcoreWarning(UserWarning):
    """Warning about valid but suspicious input."""


def warn(message: str) -> None:
    """Issue a warning at the line from which the package was called."""
    frame, level = sys._getframe(1), 2
    while _is_own(frame) and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, QuadcoreWarning, stacklevel=level)


def _is_own(frame: FrameType) -> bool:
    name = str(frame.f_globals.get("__name__"))
    return name.partition(".")[0] in ("quadcore", "xacro")  # xacro warns via this module


@contextmanager
def suppress_warnings() -> Iterator[None]:
    """Suppress warnings within the block; the lists of warnings still contain them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", QuadcoreWarning)
        yield
