"""The XML documents of a model or a world, from a file or a shipped name."""

from __future__ import annotations

from pathlib import Path
from typing import Mapping

from . import resources, xml_source
from ._core import Document, InputError
from .files import is_file, shown
from .forks import LOCK


def load_description(model: str, xacro_args: Mapping[str, str]) -> Document:
    """Read a model.

    Parameters
    ----------
    model
        Path to a URDF file or to a xacro file (name ending in ``.xacro`` or, as RotorS has it,
        ``.gazebo``; then it is expanded), or the name of a shipped model, such as ``"quadrotor"``.
    xacro_args
        Values of the xacro file's arguments, by name.

    Raises
    ------
    InputError
        No such model, malformed XML, a fault in the xacro, or arguments for a file that is none.

    Warns
    -----
    QuadcoreWarning
        An argument that the xacro file does not have.
    """
    path = _find("model", model, "urdf")
    if path.suffix not in (".xacro", ".gazebo"):
        if xacro_args:
            raise InputError(f"{path}: takes no xacro arguments: it is no .xacro file")
        return _plain(path)
    # Only models that need it pay for importing xacro.
    with LOCK:
        from .xacro_expansion import expand

    lines = expand(str(path), xacro_args)
    return Document(
        shown(path),
        "\n".join(text for text, _ in lines),
        [(shown(place.file), place.line) for _, place in lines],
    )


def load_world(world: str | None) -> Document:
    """Read a world: a path, the name of a shipped one (``"empty"``), or None for ``"empty"``.

    Raises
    ------
    InputError
        No such world, or malformed XML.
    """
    return _plain(_find("world", "empty" if world is None else world, "worlds"))


def _find(kind: str, name: str, folder: str) -> Path:
    path = Path(name)
    if is_file(path):
        return path
    shipped = resources.shipped(folder)
    by_name = {**shipped, **{file.name: file for file in shipped.values()}}
    if name in by_name:
        return by_name[name]
    if path.is_dir():
        raise InputError(f"{name}: is a folder; name the {kind} file in it")
    known = ", ".join(shipped) or "none"
    raise InputError(f"{name}: no such file, and no shipped {kind} of that name ({known})")


def _plain(path: Path) -> Document:
    text = xml_source.read(path)
    xml_source.check(shown(path), text)
    return Document(shown(path), text)
