"""Models and worlds, from a file or a shipped name."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Mapping, Optional, Sequence, Tuple, Union

from .. import _core
from .._core import Document, InputError, Model, World
from ..support.arguments import LIST, NAME, OPTIONS, check, read_once
from ..support.import_lock import LOCK
from ..support.input_files import check_regular, is_file
from ..support.output_files import shown
from ..support.parameters import did_you_mean
from . import resources, xml_source

_XACRO = (".xacro", ".gazebo")
"""Ends of names of files that are expanded; RotorS has the second."""


def read_model(
    model: Union[str, Path] = "quadrotor",
    xacro_args: Optional[Mapping[str, object]] = None,
    ignore: Sequence[str] = (),
) -> Model:
    """Read a model, to fly it often or to take it elsewhere: it holds its text, no path.

    Parameters
    ----------
    model
        URDF or xacro file, or the name of a shipped model ("quadrotor").
    xacro_args
        Arguments of a xacro model.
    ignore
        As for `Simulation`; a name that nothing goes by is refused when the model flies.

    Returns
    -------
    Model
        For any number of simulations.

    Raises
    ------
    InputError
        The model is at fault; the message carries ``FILE:LINE``.
    """
    check({"model": model, "xacro_args": xacro_args}, {"model": NAME})
    arguments = {name: str(value) for name, value in (xacro_args or {}).items()}
    return _core.read_model(
        load_description(str(model), arguments), list_of_names("ignore", ignore)
    )


def read_world(world: Union[str, Path, None] = None, ignore: Sequence[str] = ()) -> World:
    """Read a world, to fly in it often or to take it elsewhere.

    Parameters
    ----------
    world
        World file, or the name of a shipped one; None is empty.world.
    ignore
        As for `read_model`.

    Returns
    -------
    World
        For any number of simulations.

    Raises
    ------
    InputError
        The world is at fault; the message carries ``FILE:LINE``.
    """
    check({"world": world}, OPTIONS)
    document = load_world(None if world is None else str(world))
    return _core.read_world(document, list_of_names("ignore", ignore))


def read_both(
    model: Union[str, Path, Model],
    world: Union[str, Path, World, None],
    xacro_args: Optional[Mapping[str, object]],
    ignore: Sequence[str],
) -> Tuple[Model, World]:
    """Read a model and a world, each unless it is read already.

    Raises
    ------
    InputError
        One of them is at fault, or nothing in them goes by a name to ignore.
    """
    names = list_of_names("ignore", ignore)
    if not isinstance(model, Model):
        model = read_model(model, xacro_args, names)
    elif xacro_args:
        raise InputError("xacro_args: the model is read already; give them to its reader")
    if not isinstance(world, World):
        world = read_world(world, names)
    _core.check_ignored(names, [model.passed_over, world.passed_over])
    return model, world


def list_of_names(argument: str, names: Sequence[str]) -> list[str]:
    """Check names given as an argument, which may come one by one."""
    names = read_once(names)
    check({argument: names}, {argument: LIST})
    return list(map(str, names))


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
        No such model, malformed XML, an error in the xacro, an argument that the xacro file does
        not have, or arguments for a file without xacro.
    """
    path = _find("model", model, "urdf")
    if path.suffix not in _XACRO:
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


def xacro_arguments(model: Union[str, Path], given: Mapping[str, object]) -> Dict[str, str]:
    """Tell what each argument of a model's xacro file is: as given, or its default.

    Raises
    ------
    InputError
        As of `load_description`; a file that is no xacro file has none.
    """
    path = _find("model", str(model), "urdf")
    if path.suffix not in _XACRO:
        return {}
    with LOCK:
        from .xacro_expansion import arguments_of

    return arguments_of(str(path), {name: str(value) for name, value in given.items()})


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
    if path.exists():
        check_regular(path)
    known = f"({', '.join(shipped) or 'none'})"
    near = did_you_mean(name, list(by_name))
    raise InputError(f"{name}: no such file, and no shipped {kind} of that name {known}{near}")


def _plain(path: Path) -> Document:
    text = xml_source.read(path)
    xml_source.check(shown(path), text)
    return Document(shown(path), text)
