"""quadcore's warnings."""

import sys
import warnings
from contextlib import contextmanager
from types import FrameType
from typing import Iterator


class QuadcoreWarning(UserWarning):
    """What is allowed but was perhaps not meant."""


def warn(message: str) -> None:
    """Warn of the line that called the package, however deep in it the doubt arose."""
    frame, level = sys._getframe(1), 2
    while _is_ours(frame) and frame.f_back is not None:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, QuadcoreWarning, stacklevel=level)


def _is_ours(frame: FrameType) -> bool:
    name = str(frame.f_globals.get("__name__"))
    return name.partition(".")[0] in ("quadcore", "xacro")  # xacro warns through us


@contextmanager
def suppress_warnings() -> Iterator[None]:
    """Let what is doubtful within the block be no news: simulations keep it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", QuadcoreWarning)
        yield
