"""Import of the core, with a hint if a system library is missing."""

from __future__ import annotations

import re


def find_remedy(message: str) -> str:
    """Return a hint with the package of a missing library, from the loader's message; else "".

    Debian derives package names from file names: libode8 contains libode.so.8, and libtinyxml2-9
    contains libtinyxml2.so.9.
    """
    missing = re.match(r"((lib[\w+-]*\w)\.so\.([\d.]+)): cannot open shared object file", message)
    if not missing:
        return ""
    file, name, version = missing.groups()
    package = f"{name}{'-' if name[-1].isdigit() else ''}{version}"
    return (
        f"quadcore was built with {file}, which is missing. Install it (Debian, Ubuntu: "
        f"apt-get install {package}), or rebuild quadcore."
    )


try:
    from .. import _core  # noqa: F401
except ImportError as error:
    remedy = find_remedy(str(error))
    if not remedy:
        raise
    raise ImportError(remedy) from None
