"""Rows of a running flight, for a page that shows it."""

from __future__ import annotations

import math
from typing import List, Optional, Sequence

import numpy as np

from .._core import Model
from ..model.obstacles import draw_world
from ..model.visuals import read_vehicle
from ..report.cameras import CAMERAS
from ..report.page_server import EVENTS, PageServer
from ..report.player import make_live_page
from ..report.player_flight import list_columns
from .log import Log
from .simulation import Simulation
from .trajectory import find_speed_limit

_RATE = 60.0  # maximum number of rows per simulated second


class LiveView:
    """Recorder that sends the rows of a flight to a page on this machine.

    Parameters
    ----------
    simulation : Simulation
        Vehicle and world to draw.
    columns : sequence of str
        Names of the columns, as returned by `flight.list_columns`.
    model : Model, optional
        Model to draw (default: that of the simulation).
    log_every : int
        Steps between two rows.
    every : int, optional
        Number of rows per sent row (default: such that 60 rows per simulated second are sent).
    camera : str
        Initial camera.
    """

    wrenches = False

    def __init__(
        self,
        simulation: Simulation,
        columns: Sequence[str],
        model: Optional[Model] = None,
        log_every: int = 1,
        every: Optional[int] = None,
        camera: str = CAMERAS[0],
    ) -> None:
        self._columns = list(columns)
        self._every = every or max(1, round(1 / (_RATE * simulation.dt * log_every)))
        self._seen = 0
        self._last: Optional[np.ndarray] = None  # a row that was not sent yet
        vehicle = read_vehicle(model or simulation.model)
        empty = Log.of_rows(np.zeros((0, len(self._columns))), self._columns, {})
        self.page = PageServer(
            make_live_page(
                vehicle.name,
                empty,
                vehicle,
                draw_world(simulation.world),
                EVENTS,
                find_speed_limit(simulation.rotors),
                camera,
            )
        )

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Send every `every`-th row of a piece."""
        picked = table[-self._seen % self._every :: self._every]
        self._seen += len(table)
        if len(picked):
            self.page.append(make_rows(picked, self._columns))
        if len(table):
            self._last = table[-1:].copy() if (self._seen - 1) % self._every else None

    def close(self) -> None:
        """Send the last row and the end of the flight."""
        if self._last is not None:
            self.page.append(make_rows(self._last, self._columns))
        self.page.end()


def make_rows(table: np.ndarray, columns: Sequence[str]) -> List[List[Optional[float]]]:
    """Convert rows of a log to the columns of the page; values that are not finite become None."""
    shown = list_columns(Log.of_rows(table, columns, {}))
    rows = np.hstack([values for values, _ in shown.values()]).tolist()
    return [[value if math.isfinite(value) else None for value in row] for row in rows]
