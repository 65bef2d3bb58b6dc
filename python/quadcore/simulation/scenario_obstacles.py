"""Obstacles that a scenario adds to the world."""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence

import yaml

from .._core import InputError, World, read_world
from ..model.world_text import change_world_text
from ..support.parameters import suggest
from ..support.yaml_nodes import find_line, read_numbers, read_pairs

KINDS = {
    "box": "<size>{0} {1} {2}</size>",
    "cylinder": "<radius>{0}</radius><length>{1}</length>",
    "sphere": "<radius>{0}</radius>",
}
"""SDF geometries by the key of the obstacle in a scenario."""

_FORM = "obstacles as a list of {KIND: SIZES, at: [X, Y, Z]}"


class PlacedObstacle(NamedTuple):
    """Static obstacle."""

    name: str
    """Name of the obstacle's model."""
    kind: str
    """One of `KINDS`."""
    sizes: Sequence[str]
    """Dimensions, m: x, y, z of a box, radius and length of a cylinder, or radius of a sphere."""
    pose: Sequence[str]
    """Position in the world (m), then roll, pitch and yaw (rad)."""
    line: int

    def write(self) -> str:
        """Return the obstacle as an SDF model in one line."""
        from xml.sax.saxutils import quoteattr  # imports urllib.request, which is slow

        geometry = KINDS[self.kind].format(*self.sizes)
        return (
            f"<model name={quoteattr(self.name)}><static>1</static><pose>{' '.join(self.pose)}"
            f'</pose><link name="link"><collision name="collision"><geometry><{self.kind}>'
            f"{geometry}</{self.kind}></geometry></collision></link></model>"
        )


def read_obstacles(file: str, node: yaml.Node) -> Sequence[PlacedObstacle]:
    """Read the obstacles of a scenario.

    Parameters
    ----------
    file
        Name of the scenario file in messages.
    node
        YAML node with the list of obstacles.

    Raises
    ------
    InputError
        If an obstacle is invalid; the message begins with ``FILE:LINE``.
    """
    if not isinstance(node, yaml.SequenceNode):
        raise InputError(f"{file}:{find_line(node)}: write {_FORM}")
    obstacles: List[PlacedObstacle] = []
    for item in node.value:
        obstacle = _read_obstacle(file, item, len(obstacles) + 1)
        for other in obstacles:
            if other.name == obstacle.name:
                raise InputError(
                    f"{file}:{obstacle.line}: a second obstacle '{obstacle.name}', the first in "
                    f"line {other.line}. Give it another name."
                )
        obstacles.append(obstacle)
    return obstacles


def add_obstacles(world: World, obstacles: Sequence[PlacedObstacle], file: str) -> World:
    """Return the world with additional obstacles.

    Raises
    ------
    InputError
        If the world has a model with the same name, or the size of an obstacle is invalid. The
        message begins with ``FILE:LINE``.
    """
    if not obstacles:
        return world
    names = _find_models(world.document.text)
    for obstacle in obstacles:
        if obstacle.name in names:
            raise InputError(
                f"{file}:{obstacle.line}: the world already has a model '{obstacle.name}'. Give "
                "the obstacle another name."
            )
    added = [(obstacle.write(), (file, obstacle.line)) for obstacle in obstacles]
    changed = change_world_text(world.document, (), added)
    return read_world(changed, list(world.ignored_elements.ignored))


def _read_obstacle(file: str, node: yaml.Node, number: int) -> PlacedObstacle:
    given = {key.value: (key, value) for key, value in read_pairs(file, node, _FORM)}
    line = find_line(node)
    where = f"{file}:{line}"
    named = [name for name in given if name in KINDS]
    if len(named) != 1:
        raise InputError(f"{where}: an obstacle has one shape. Write one of {', '.join(KINDS)}.")
    (kind,) = named
    known = [kind, "at", "rpy", "name"]
    for key, (node_of_key, _) in given.items():
        if key not in known:
            raise InputError(
                f"{file}:{find_line(node_of_key)}: an obstacle has no '{key}'."
                f"{suggest(key, known)} Write {', '.join(known)}."
            )
    if "at" not in given:
        raise InputError(f"{where}: the obstacle lacks 'at'. Write it.")
    values: Dict[str, List[str]] = {
        key: read_numbers(file, key, given[key][1], count).split()
        for key, count in ((kind, KINDS[kind].count("{")), ("at", 3), ("rpy", 3))
        if key in given
    }
    name = f"obstacle {number}"
    if "name" in given:
        name = read_numbers(file, "name", given["name"][1], 0)
    pose = [*values["at"], *values.get("rpy", ["0", "0", "0"])]
    return PlacedObstacle(name, kind, values[kind], pose, line)


def _find_models(text: str) -> List[str]:
    """Return the names of the models in a world."""
    from xml.etree import ElementTree  # its import takes 6 ms

    return [model.get("name", "") for model in ElementTree.fromstring(text).iter("model")]
