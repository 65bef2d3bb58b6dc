"""Where the shipped models, worlds and settings lie."""

from __future__ import annotations

from pathlib import Path

from .. import _core

_PACKAGE = Path(__file__).resolve().parents[1]


def root() -> Path:
    """Folder that holds ``urdf/``, ``worlds/`` and ``config/``.

    Installed by pip, they lie inside the package; by catkin, in ``share/quadcore`` of the same
    space; in a source checkout, at the top of the repository.
    """
    folders = (_PACKAGE, *_PACKAGE.parents)
    places = (place for folder in folders for place in (folder, folder / "share" / "quadcore"))
    return next((place for place in places if (place / "worlds/empty.world").is_file()), _PACKAGE)


def shipped(folder: str) -> dict[str, Path]:
    """Files of a shipped folder, by name without suffixes (``"quadrotor"``, ``"empty"``)."""
    return {path.name.split(".")[0]: path for path in sorted((root() / folder).glob("*.*"))}


def cmake_prefix() -> str:
    """Give the folder to add to ``CMAKE_PREFIX_PATH`` for ``find_package(quadcore)``.

    Returns
    -------
    str
        Absolute.
    """
    folders = Path(_core.__file__).resolve().parents  # pip's package, or catkin's space
    return str(next(folder for folder in folders if (folder / "lib/cmake/quadcore").is_dir()))
