"""The ``<visual>`` elements of a model: shapes, colours and meshes to draw."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np

from .._core import InputError, Model, parse_number
from ..report.drawn_vehicle import DrawnBody, DrawnShape, DrawnVehicle
from ..support.rotation import compose_roll_pitch_yaw
from ..support.warning import warn
from .mesh import read_mesh
from .xml_origins import find_origin, parse

_FIXED = ("fixed", "revolute")  # the reader accepts only revolute joints that cannot turn
_NO_ROTATION = np.zeros(3)


def read_vehicle(model: Model) -> DrawnVehicle:
    """Read the visible shapes of a model.

    Shapes of links on fixed joints belong to the body that carries them, as for `Model.links`. A
    body without a valid visual is drawn as its equivalent inertia box.

    Parameters
    ----------
    model : Model
        Model from `read_model`.

    Returns
    -------
    DrawnVehicle
        Frame and rotors. Visuals that cannot be drawn are skipped with a warning.
    """
    shapes = _read_shapes(model)
    axes = [_NO_ROTATION, *(joint.axis for joint in model.joints)]
    bodies = []
    for link, pose, axis in zip(model.links, model.link_poses, axes):
        drawn = shapes.get(link.name) or [_make_inertia_box(link.inertia_box)]
        bodies.append(DrawnBody(pose, axis, drawn))
    return DrawnVehicle(model.name, bodies)


def _read_shapes(model: Model) -> Dict[str, List[DrawnShape]]:
    """Read the shapes of each body by name."""
    document = model.document
    root = parse(document.name, document.text).documentElement
    assert root is not None
    colours = dict(filter(None, map(_read_named_colour, _list_children(root, "material"))))
    carriers = {}
    for joint in _list_children(root, "joint"):
        if joint.getAttribute("type") in _FIXED:
            child, parent = (_get_child(joint, end) for end in ("child", "parent"))
            if child is not None and parent is not None:
                carriers[child.getAttribute("link")] = (parent.getAttribute("link"), joint)
    shapes: Dict[str, List[DrawnShape]] = {}
    for link in _list_children(root, "link"):
        body, pose = link.getAttribute("name"), np.eye(4)
        while body in carriers:
            body, joint = carriers[body]
            pose = _read_origin(joint) @ pose
        for visual in _list_children(link, "visual"):
            try:
                shape = _read_visual(visual, pose, colours, Path(document.name).parent)
            except InputError as error:
                where = _find_source(model, visual)
                warn(f"{where}: <visual> not drawn: {error}")
            else:
                shapes.setdefault(body, []).append(shape)
    return shapes


def _read_visual(
    visual: Any, pose: np.ndarray, colours: Dict[str, Tuple[float, ...]], folder: Path
) -> DrawnShape:
    geometry = _get_child(visual, "geometry")
    found = [] if geometry is None else list(_list_children(geometry))
    if len(found) != 1:
        raise InputError("it must have exactly one shape. Keep one.")
    (shape,) = found
    placed = pose @ _read_origin(visual)
    material = _get_child(visual, "material")
    colour: Tuple[float, ...] = (0.6, 0.6, 0.6, 1.0)
    if material is not None:
        own = _read_named_colour(material)
        colour = own[1] if own else colours.get(material.getAttribute("name"), colour)
    kind = shape.tagName
    if kind == "box":
        size = _read_numbers(shape, "size", 3)
    elif kind == "cylinder":
        size = (*_read_numbers(shape, "radius", 1), *_read_numbers(shape, "length", 1))
    elif kind == "sphere":
        size = _read_numbers(shape, "radius", 1)
    elif kind == "mesh":
        scale = _read_numbers(shape, "scale", 3) if shape.hasAttribute("scale") else (1.0,) * 3
        vertices, faces = read_mesh(shape.getAttribute("filename"), folder)
        return DrawnShape(kind, scale, placed, colour, vertices, faces)
    else:
        raise InputError(f"'{kind}' is no shape. Use box, cylinder, sphere or mesh.")
    return DrawnShape(kind, size, placed, colour)


def _read_origin(element: Any) -> np.ndarray:
    """Return the pose in the <origin> of an element as a homogeneous matrix, m."""
    pose = np.eye(4)
    origin = _get_child(element, "origin")
    if origin is not None:
        if origin.hasAttribute("xyz"):
            pose[:3, 3] = _read_numbers(origin, "xyz", 3)
        if origin.hasAttribute("rpy"):
            pose[:3, :3] = compose_roll_pitch_yaw(np.array(_read_numbers(origin, "rpy", 3)))
    return pose


def _read_named_colour(material: Any) -> Optional[Tuple[str, Tuple[float, ...]]]:
    """Return the name and colour of a material; None if it has no colour."""
    colour = _get_child(material, "color")
    if colour is None:
        return None
    rgba = np.clip(_read_numbers(colour, "rgba", 4), 0, 1)
    return material.getAttribute("name"), tuple(rgba.tolist())


def _read_numbers(element: Any, attribute: str, count: int) -> Tuple[float, ...]:
    text = element.getAttribute(attribute)
    numbers = [parse_number(word) for word in text.split()]
    if len(numbers) != count or None in numbers:
        raise InputError(f'{attribute}="{text}" does not contain {count} finite numbers.')
    return tuple(float(number) for number in numbers if number is not None)


def _make_inertia_box(corners: np.ndarray) -> DrawnShape:
    """Make a box from its corners; corner i is at the far end of edge k if bit k of i is set."""
    edges = [corners[1 << k] - corners[0] for k in range(3)]
    size = tuple(float(np.linalg.norm(edge)) for edge in edges)
    pose = np.eye(4)
    pose[:3, 3] = corners.mean(axis=0)
    if min(size) > 0:
        pose[:3, :3] = np.column_stack([edge / length for edge, length in zip(edges, size)])
    return DrawnShape("box", size, pose)


def _find_source(model: Model, element: Any) -> str:
    """Return FILE:LINE of an element in its original file."""
    origin = find_origin(element)
    assert origin is not None
    lines = model.document.lines
    if not lines:
        return str(origin)
    file, line = lines[origin.line - 1]
    return f"{file}:{line}"


def _list_children(element: Any, name: str = "") -> Iterator[Any]:
    """Yield all child elements, or only those with a name."""
    for node in element.childNodes:
        if node.nodeType == node.ELEMENT_NODE and name in ("", node.tagName):
            yield node


def _get_child(element: Any, name: str) -> Optional[Any]:
    return next(_list_children(element, name), None)
