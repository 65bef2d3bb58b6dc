"""Meshes of visuals: .stl, .obj and .dae files."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Tuple

import numpy as np

from .._core import InputError
from ..support.input_files import check_regular, is_file
from ..support.optional_packages import require_package

_SUFFIXES = (".stl", ".obj", ".dae")
_MOST_FACES = 200_000  # maximum number of faces of a mesh; a page with more would load slowly


def read_mesh(filename: str, folder: Path) -> Tuple[np.ndarray, np.ndarray]:
    """Read the triangles of a mesh.

    Parameters
    ----------
    filename
        File name as in a URDF: ``package://PACKAGE/PATH``, ``file://PATH`` or a path.
    folder
        Folder to which relative paths refer.

    Returns
    -------
    vertices : ndarray (n, 3)
        Vertices in the axes and units of the file.
    faces : ndarray (m, 3)
        Indices of the vertices of each triangle.

    Raises
    ------
    InputError
        If the file is missing or is not a mesh, or a package to read it is not installed.
    """
    path = _find_file(filename, folder)
    if path.suffix.lower() not in _SUFFIXES:
        raise InputError(f"{path}: is no mesh of a known kind. Use {', '.join(_SUFFIXES)}.")
    if not is_file(path):
        raise InputError(f"{path}: does not exist. Correct the file name.")
    check_regular(path)
    with require_package("reading meshes", "trimesh", "mesh"):
        import trimesh
    if path.suffix.lower() == ".dae":
        with require_package("reading .dae meshes", "pycollada", "mesh"):
            import collada  # noqa: F401
    try:
        mesh: Any = trimesh.load(str(path), force="mesh")
        vertices, faces = np.asarray(mesh.vertices, float), np.asarray(mesh.faces, int)
    except Exception as error:  # a damaged file can raise any exception
        raise InputError(f"{path}: cannot be read as a mesh ({error}). Export it again.") from None
    if not 0 < len(faces) <= _MOST_FACES or not np.isfinite(vertices).all():
        raise InputError(
            f"{path}: has {len(faces)} triangles; 1 to {_MOST_FACES} are drawn. Simplify the mesh."
        )
    return vertices, faces


def _find_file(filename: str, folder: Path) -> Path:
    scheme, separator, rest = filename.partition("://")
    if not separator:
        return folder / filename
    if scheme == "file":
        return Path(rest)
    package, _, path = rest.partition("/")
    if scheme != "package":
        raise InputError(f"'{filename}' has an unknown scheme. Use package:// or file://.")
    import rospkg

    try:
        return Path(rospkg.RosPack().get_path(package)) / path
    except rospkg.ResourceNotFound:
        raise InputError(
            f"'{filename}': the ROS package '{package}' is not found. Source its workspace."
        ) from None
