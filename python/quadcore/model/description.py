"""Reading models and worlds from files or built-in names."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Mapping, Optional, Sequence, Tuple, Union

from .. import _core
from .._core import Document, InputError, Model, World
from ..support.arguments import LIST, NAME, OPTIONS, PLACE, check, or_none, read_once
from ..support.import_lock import LOCK
from ..support.input_files import check_regular, is_file
from ..support.output_files import printable_name
from ..support.parameters import suggest
from . import resources, xml_source
from .earth import check_location, place_world

_XACRO = (".xacro", ".gazebo")
"""Suffixes of xacro files; RotorS uses the second one."""


def read_model(
    model: Union[str, Path] = "quadrotor",
    xacro_args: Optional[Mapping[str, object]] = None,
    ignore: Sequence[str] = (),
) -> Model:
    """Read a model once for any number of simulations.

    The result contains the text of the model but no path, so it can be pickled.

    Parameters
    ----------
    model : str or path, default "quadrotor"
        URDF or xacro file, or name of a built-in model.
    xacro_args : mapping of str to value, optional
        Arguments of a xacro model.
    ignore : sequence of str, default ()
        As for `Simulation`. A name that does not occur causes an error when the model is simulated.

    Returns
    -------
    Model
        Model to pass to `Simulation`.

    Raises
    ------
    InputError
        If the model is invalid; the message begins with ``FILE:LINE``.
    """
    check({"model": model, "xacro_args": xacro_args}, {"model": NAME})
    arguments = {name: str(value) for name, value in (xacro_args or {}).items()}
    return _core.read_model(
        load_description(str(model), arguments), check_names_argument("ignore", ignore)
    )


def read_world(
    world: Union[str, Path, None] = None,
    ignore: Sequence[str] = (),
    at: Optional[Sequence[float]] = None,
) -> World:
    """Read a world once for any number of simulations.

    Parameters
    ----------
    world : str or path, optional
        World file, or name of a built-in world. Default: empty.world.
    ignore : sequence of str, default ()
        As for `read_model`.
    at : sequence of 2 or 3 numbers, optional
        Latitude and longitude of the world's origin, deg, and altitude above sea level, m (default
        0). They define the gravity (WGS 84), the magnetic field (World Magnetic Model) and the
        origin of GPS receivers. Default: the values of the world.

    Returns
    -------
    World
        World to pass to `Simulation`.

    Raises
    ------
    InputError
        If the world is invalid; the message begins with ``FILE:LINE``.
    """
    check({"world": world, "at": at}, {**OPTIONS, "at": or_none(PLACE)})
    document = load_world(None if world is None else str(world))
    read = _core.read_world(document, check_names_argument("ignore", ignore))
    return read if at is None else place_world(read, check_location(at))


def read_world_once(
    world: Union[str, Path, World, None],
    ignore: Sequence[str],
    at: Optional[Sequence[float]],
) -> World:
    """Read a world as `read_world` does, unless it is already read."""
    if not isinstance(world, World):
        return read_world(world, ignore, at)
    if at is not None:
        raise InputError("at: the world has already been read. Give it to read_world.")
    return world


def read_both(
    model: Union[str, Path, Model],
    world: Union[str, Path, World, None],
    xacro_args: Optional[Mapping[str, object]],
    ignore: Sequence[str],
    at: Optional[Sequence[float]] = None,
) -> Tuple[Model, World]:
    """Read a model and a world, unless they are already read.

    Raises
    ------
    InputError
        If the model or the world is invalid, or a name to ignore occurs in neither.
    """
    names = check_names_argument("ignore", ignore)
    if not isinstance(model, Model):
        model = read_model(model, xacro_args, names)
    elif xacro_args:
        raise InputError("xacro_args: the model has already been read. Give them to read_model.")
    world = read_world_once(world, names, at)
    _core.check_ignored(names, [model.ignored_elements, world.ignored_elements])
    return model, world


def check_names_argument(argument: str, names: Sequence[str]) -> list[str]:
    """Return the names in an argument as a list; the argument can be an iterator."""
    names = read_once(names)
    check({argument: names}, {argument: LIST})
    return list(map(str, names))


def load_description(model: str, xacro_args: Mapping[str, str]) -> Document:
    """Read the text of a model; a xacro file is expanded.

    Parameters
    ----------
    model
        URDF file, xacro file (``.xacro`` or ``.gazebo``), or name of a built-in model.
    xacro_args
        Arguments of the xacro file, by name.

    Raises
    ------
    InputError
        If the model does not exist, the XML or xacro is invalid, or the file lacks an argument.
    """
    path = _find("model", model, "urdf")
    if path.suffix not in _XACRO:
        if xacro_args:
            raise InputError(
                f"{path}: takes no xacro arguments, as it is not a .xacro file. Leave them out."
            )
        return _plain(path)
    # xacro is imported only for models that need it.
    with LOCK:
        from .xacro_expansion import expand

    lines = expand(str(path), xacro_args)
    return Document(
        printable_name(path),
        "\n".join(text for text, _ in lines),
        [(printable_name(place.file), place.line) for _, place in lines],
    )


def list_xacro_arguments(model: Union[str, Path], given: Mapping[str, object]) -> Dict[str, str]:
    """Return the given or default value of each argument of a xacro file.

    Any other file has no arguments.

    Raises
    ------
    InputError
        As for `load_description`.
    """
    path = _find("model", str(model), "urdf")
    if path.suffix not in _XACRO:
        return {}
    with LOCK:
        from .xacro_expansion import list_arguments

    return list_arguments(str(path), {name: str(value) for name, value in given.items()})


def load_world(world: str | None) -> Document:
    """Read the text of a world file or a built-in world; None selects ``"empty"``.

    Raises
    ------
    InputError
        If the world does not exist, or the XML is malformed.
    """
    path = _find("world", "empty" if world is None else world, "worlds")
    return _plain(path, Document.largest_world)


def _find(kind: str, name: str, folder: str) -> Path:
    path = Path(name)
    if is_file(path):
        return path
    shipped = resources.list_shipped(folder)
    by_name = {**shipped, **{file.name: file for file in shipped.values()}}
    if name in by_name:
        return by_name[name]
    if path.is_dir():
        raise InputError(f"{name}: is a folder. Name the {kind} file in it.")
    if path.exists():
        check_regular(path)
    near, known = suggest(name, list(by_name)), ", ".join(shipped) or "none"
    raise InputError(
        f"{name}: neither a file nor a built-in {kind}.{near} Name a file, or one of {known}."
    )


def _plain(path: Path, largest: int = Document.largest) -> Document:
    text = xml_source.read(path, largest)
    xml_source.check(printable_name(path), text)
    return Document(printable_name(path), text)
