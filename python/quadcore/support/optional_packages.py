"""Optional packages and the messages for missing ones."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Iterator

from .._core import InputError


@contextmanager
def require_package(what: str, package: str, extra: str) -> Iterator[None]:
    """Convert an import error to a message that names the package to install.

    Parameters
    ----------
    what
        Feature that requires the package.
    package
        Name of the package.
    extra
        Extra of quadcore that installs the package.

    Raises
    ------
    InputError
        If the package cannot be imported.
    """
    try:
        yield
    except ImportError:
        raise InputError(
            f"{what} requires the package {package}. Install it: pip install 'quadcore[{extra}]'"
        ) from None
