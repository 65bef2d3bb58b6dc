"""Where the shipped models, worlds and settings lie."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def root() -> Path:
    """Folder that holds ``urdf/``, ``worlds/`` and ``config/``.

    Installed, they lie inside the package; in a source checkout, at the top of the repository.
    """
    return _PACKAGE if (_PACKAGE / "urdf").is_dir() else _PACKAGE.parents[1]


def shipped(folder: str) -> dict[str, Path]:
    """Files of a shipped folder, by name without suffixes (``"quadrotor"``, ``"empty"``)."""
    return {path.name.split(".")[0]: path for path in sorted((root() / folder).glob("*.*"))}


def cmake_prefix() -> str:
    """Folder to add to ``CMAKE_PREFIX_PATH`` so that ``find_package(quadcore)`` succeeds."""
    return str(_PACKAGE)
