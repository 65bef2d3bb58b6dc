"""Distances between the vehicles of a fleet."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Sequence, Tuple

import numpy as np

from .._core import Model, find_distance
from ..formats.rows import Recorder
from .clearance import TOUCHING, Encounter


class FleetClearance:
    """Distances between the collision shapes of different vehicles.

    A shape on a rotor counts as the cylinder that it sweeps. Collisions between two rows are not
    detected.

    Parameters
    ----------
    models : mapping of str to Model
        Model of each vehicle by name.
    """

    def __init__(self, models: Mapping[str, Model]) -> None:
        self._models = dict(models)
        self._pieces: Dict[str, List[np.ndarray]] = {name: [] for name in models}
        self._touching: Dict[Tuple[str, str], bool] = {}
        self.minimum = dict.fromkeys(models, math.inf)
        """Minimum over all rows of each vehicle, m; infinite without other vehicles or shapes."""
        self.nearest: Dict[str, Encounter] = {}
        """Row with the minimum distance of each vehicle, and the other vehicle."""
        self.collisions: Dict[str, List[Encounter]] = {name: [] for name in models}
        """First row of each collision of each vehicle, and the other vehicle."""

    def recorder(self, name: str) -> Recorder:
        """Return the recorder for the rows of a vehicle."""
        return _VehicleRows(self, name)

    def receive(self, name: str, table: np.ndarray) -> None:
        """Store the rows of a vehicle until the rows of all vehicles are available."""
        self._pieces[name].append(table[:, :8].copy())
        if any(len(pieces) < len(self._pieces[name]) for pieces in self._pieces.values()):
            return
        rows = {of: pieces.pop(0) for of, pieces in self._pieces.items()}
        count = min(len(table) for table in rows.values())
        names = list(rows)
        for i, one in enumerate(names):
            for other in names[i + 1 :]:
                self._meet(one, other, rows[one][:count], rows[other][:count])

    def summarize(self, name: str) -> Dict[str, Any]:
        """Return the results of a vehicle as plain values; empty without other vehicles."""
        if name not in self.nearest:
            return {}
        return {
            "vehicle_clearance": self.minimum[name],
            "nearest_vehicle": self.nearest[name]._asdict(),
            "vehicle_collisions": [each._asdict() for each in self.collisions[name]],
        }

    def _meet(self, one: str, other: str, own: np.ndarray, others: np.ndarray) -> None:
        if not len(own):
            return
        known = max(self.minimum[one], self.minimum[other])
        distances = find_distance(
            self._models[one], self._models[other], own[:, 1:], others[:, 1:], known, TOUCHING
        )
        touches = distances < TOUCHING
        before = self._touching.get((one, other), False)
        begins = np.flatnonzero(touches & ~np.concatenate([[before], touches[:-1]]))
        self._touching[one, other] = bool(touches[-1])
        lowest = int(distances.argmin())
        for name, rows, against in ((one, own, other), (other, others, one)):
            if distances[lowest] < self.minimum[name]:
                self.minimum[name] = float(distances[lowest])
                self.nearest[name] = _describe(rows[lowest], against)
            self.collisions[name] += [_describe(rows[row], against) for row in begins]


class _VehicleRows:
    """Recorder for the rows of one vehicle."""

    wrenches = False

    def __init__(self, clearance: FleetClearance, name: str) -> None:
        self._clearance, self._name = clearance, name

    def receive(self, table: np.ndarray, _: np.ndarray) -> None:
        """Pass the rows on."""
        self._clearance.receive(self._name, table)

    def close(self) -> None:
        """Do nothing, because no file is open."""


def _describe(row: Sequence[float], other: str) -> Encounter:
    time, x, y, z = (float(value) for value in row[:4])
    return Encounter(time, (x, y, z), other)
