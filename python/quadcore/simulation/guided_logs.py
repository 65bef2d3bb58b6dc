"""Logs of flights that a batch simulates with controllers."""

from __future__ import annotations

import numpy as np

from ..formats.rows import Topics, split_columns
from .controller_pilot import ControllerPilot
from .log import Log
from .simulation import Simulation
from .trajectory import per_command


class GuidedLogs:
    """Logs of the flights of one vehicle with one pilot, with rows at the same times.

    Parameters
    ----------
    simulation
        Simulation of the vehicle.
    pilot
        Pilot that has the reference.
    """

    def __init__(self, simulation: Simulation, pilot: ControllerPilot) -> None:
        self._pilot = pilot
        self._ignored = simulation.ignored
        self._per_command = per_command(simulation)
        self._wanted = np.empty((0, 0))

    def make(self, table: np.ndarray) -> Log:
        """Make the log of a flight from the rows of its state; the log refers to these rows."""
        topics: Topics = {}
        if self._pilot.columns:
            if len(self._wanted) < len(table):
                self._wanted = self._pilot.sample(table[:, 0])
            wanted = self._wanted[: len(table)]
            followed = np.hstack([wanted, table[:, 1:4] - wanted[:, :3]])
            _, topics = split_columns(self._pilot.columns, followed)
        log = Log(table, ignored=self._ignored, topics=topics)
        log.per_command = self._per_command
        return log
