"""Distances between a vehicle and the obstacles of its world during a flight."""

from __future__ import annotations

import math
from typing import Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from .._core import Model, World, find_clearance

TOUCHING = 1e-4
"""Distance from an obstacle below which a row counts as a collision, m."""


class Encounter(NamedTuple):
    """Time and position of a row, and the nearest obstacle."""

    time: float
    """Time, s."""
    position: Tuple[float, float, float]
    """Position of the frame in world axes, m."""
    obstacle: str
    """Model name of the obstacle."""

    def __str__(self) -> str:
        x, y, z = self.position
        place = f"x = {x:.4g} m, y = {y:.4g} m, z = {z:.4g} m"
        return f"{self.obstacle} at t = {self.time:.6g} s, {place}"


class Clearance:
    """Recorder of the distance between the vehicle's collision shapes and the obstacles.

    A shape on a rotor counts as the cylinder that it sweeps. The ground plane is not an obstacle.
    Collisions between two rows are not detected.

    Parameters
    ----------
    model, world : Model, World
        Vehicle, and world with the obstacles.
    """

    wrenches = False

    def __init__(self, model: Model, world: World) -> None:
        self._model, self._world = model, world
        self._obstacles = world.obstacles
        self._touches = False
        self.minimum = math.nan
        """Minimum over all rows, m; NaN without obstacles."""
        self.nearest: Optional[Encounter] = None
        """Row with the minimum distance."""
        self.collisions: List[Encounter] = []
        """First row of each collision."""

    def receive(self, table: np.ndarray, _: np.ndarray) -> None:
        """Update the results with new rows."""
        if not self._obstacles or not len(table):
            return
        distances, nearest = find_clearance(self._model, self._world, table[:, 1:8])

        def describe(row: int) -> Encounter:
            x, y, z = (float(value) for value in table[row, 1:4])
            return Encounter(float(table[row, 0]), (x, y, z), self._obstacles[nearest[row]].model)

        lowest = int(distances.argmin())
        if not distances[lowest] >= self.minimum:
            self.minimum, self.nearest = float(distances[lowest]), describe(lowest)
        touches = distances < TOUCHING
        begins = touches & ~np.concatenate([[self._touches], touches[:-1]])
        self.collisions += [describe(int(row)) for row in np.flatnonzero(begins)]
        self._touches = bool(touches[-1])

    def close(self) -> None:
        """Do nothing, because no file is open."""

    def measures(self) -> Dict[str, float]:
        """Return the metrics ``clearance`` and ``collisions``; NaN without obstacles."""
        count = float(len(self.collisions)) if self._obstacles else math.nan
        return {"clearance": self.minimum, "collisions": count}
