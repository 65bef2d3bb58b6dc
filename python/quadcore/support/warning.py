"""Warnings of quadcore."""

import sys
import warnings
from contextlib import contextmanager
from types import FrameType
from typing import Iterator


class QuadcoreWarning(UserWarning):
    """Valid but suspicious input."""


def warn(message: str) -> None:
    """Issue a warning at the line that called the package."""
    frame, level = sys._getframe(1), 2
    while _is_own(frame) and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, QuadcoreWarning, stacklevel=level)


def _is_own(frame: FrameType) -> bool:
    name = str(frame.f_globals.get("__name__"))
    return name.partition(".")[0] in ("quadcore", "xacro")  # xacro warns through this module


@contextmanager
def suppress_warnings() -> Iterator[None]:
    """Suppress warnings within the block; simulations still list them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", QuadcoreWarning)
        yield
