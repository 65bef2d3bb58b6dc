"""Obstacles of a world in the form that the player draws."""

from __future__ import annotations

from typing import Sequence

import numpy as np

from .._core import World
from ..report.drawn_vehicle import DrawnShape, DrawnWorld
from ..support.rotation import to_matrix

_LENGTHS = {"box": 3, "cylinder": 2, "sphere": 1}


def draw_world(world: World) -> DrawnWorld:
    """Return the ground and the obstacles of a world, except for infinite planes and meshes."""
    shapes = []
    for obstacle in world.obstacles:
        if obstacle.kind not in _LENGTHS:
            continue
        pose = np.eye(4)
        pose[:3, :3] = to_matrix(obstacle.orientation)
        pose[:3, 3] = obstacle.position
        size = tuple(obstacle.size[: _LENGTHS[obstacle.kind]])
        shapes.append(DrawnShape(obstacle.kind, size, pose))
    return DrawnWorld(world.ground_plane, shapes)


def join_worlds(worlds: Sequence[DrawnWorld]) -> DrawnWorld:
    """Return the ground and the obstacles of several worlds, without duplicates."""
    obstacles = {
        (shape.kind, shape.size, shape.pose.tobytes()): shape
        for world in worlds
        for shape in world.obstacles
    }
    return DrawnWorld(any(world.ground for world in worlds), list(obstacles.values()))
