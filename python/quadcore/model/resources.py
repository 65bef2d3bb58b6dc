"""Paths of the built-in models, worlds and settings."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from .. import _core

_PACKAGE = Path(__file__).resolve().parents[1]


@lru_cache(maxsize=None)
def find_root() -> Path:
    """Return the folder that contains ``urdf/``, ``worlds/`` and ``config/``.

    With pip, this is the package folder. With catkin, it is ``share/quadcore`` in the same space.
    In a checkout, it is the root of the repository.
    """
    folders = (_PACKAGE, *_PACKAGE.parents)
    places = (place for folder in folders for place in (folder, folder / "share" / "quadcore"))
    return next((place for place in places if (place / "worlds/empty.world").is_file()), _PACKAGE)


def list_shipped(folder: str) -> dict[str, Path]:
    """Return the files in a built-in folder by name without suffixes, such as "quadrotor"."""
    return {path.name.split(".")[0]: path for path in sorted((find_root() / folder).glob("*.*"))}


def cmake_prefix() -> str:
    """Return the folder to add to ``CMAKE_PREFIX_PATH`` for ``find_package(quadcore)``.

    Returns
    -------
    str
        Absolute path.
    """
    folders = Path(_core.__file__).resolve().parents  # package folder (pip) or space (catkin)
    return str(next(folder for folder in folders if (folder / "lib/cmake/quadcore").is_dir()))
