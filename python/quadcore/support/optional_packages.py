"""Packages that only some of quadcore needs."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Iterator

from .._core import InputError


@contextmanager
def require_package(what: str, package: str, extra: str) -> Iterator[None]:
    """Say in an error of an import what to install.

    Parameters
    ----------
    what
        That needs it.
    package
        Its name.
    extra
        Of quadcore, which brings it.

    Raises
    ------
    InputError
        It cannot be imported.
    """
    try:
        yield
    except ImportError:
        raise InputError(
            f"{what} needs the package {package}; install it: pip install 'quadcore[{extra}]'"
        ) from None
