"""The category of quadcore's warnings."""

import warnings
from contextlib import contextmanager
from typing import Iterator


class QuadcoreWarning(UserWarning):
    """What is allowed but was perhaps not meant."""


@contextmanager
def unheard() -> Iterator[None]:
    """Let what is doubtful within the block be no news: simulations keep it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", QuadcoreWarning)
        yield
