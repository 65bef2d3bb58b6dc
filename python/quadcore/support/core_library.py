"""Loads the core before all else, to say which package a system's library that is missing is in."""

from __future__ import annotations

import re


def find_remedy(message: str) -> str:
    """Add to the loader's message about a library what brings it; "" about anything else.

    Debian names a library's package by its file: libode.so.8 is in libode8, libtinyxml2.so.9 in
    libtinyxml2-9.
    """
    missing = re.match(r"((lib[\w+-]*\w)\.so\.([\d.]+)): cannot open shared object file", message)
    if not missing:
        return ""
    file, name, version = missing.groups()
    package = f"{name}{'-' if name[-1].isdigit() else ''}{version}"
    return (
        f"quadcore was built with {file}, which is not there; install it (Debian, Ubuntu: "
        f"apt-get install {package}), or build quadcore anew"
    )


try:
    from .. import _core  # noqa: F401
except ImportError as error:
    said = find_remedy(str(error))
    if not said:
        raise
    raise ImportError(said) from None
