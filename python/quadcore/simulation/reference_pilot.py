"""Pilots that follow a reference, including pilots of plugin controllers."""

from __future__ import annotations

import math
from typing import Any, Callable, Optional, Sequence, Tuple, Union

import numpy as np

from .. import _core
from .._core import InputError
from ..control import references
from ..control.keywords import ReferenceName
from ..control.plugin_controller import PluginController
from ..control.reference_ahead import list_fields
from ..support.arguments import shorten
from .flight import Pilot

TOPIC = "reference"


class ReferencePilot(Pilot):
    """Pilot (see `flight.fly`) that adds the reference and the tracking error to the log.

    Attributes
    ----------
    columns : sequence of str
        Names of the log columns of the reference and of the error.
    """

    def __init__(
        self,
        simulation: _core.Simulation,
        reference: Union[references.ReferenceLike, ReferenceName, None],
    ) -> None:
        if isinstance(reference, str):
            reference = references.parse(reference)
        if isinstance(reference, references.Shape):
            reference = reference.on(simulation)
        if reference is not None and not callable(reference):
            raise InputError(
                f"reference is {shorten(reference)}. Give one of quadcore.references, or a "
                "function that is called as reference(t)."
            )
        self.columns = _COLUMNS if reference is not None else ()
        self._reference = reference

    def fill_columns(self, table: np.ndarray) -> None:
        """Fill the columns of the reference, which come first among those of the pilot."""
        if self._reference is None:
            return
        wanted = self.sample(table[:, 0])
        own = table[:, -len(self.columns) :]
        own[:, :4] = wanted
        for axis in range(3):  # NumPy is slower on rows of three numbers than on columns
            np.subtract(table[:, 1 + axis], wanted[:, axis], out=own[:, 4 + axis])

    def sample(self, times: np.ndarray) -> np.ndarray:
        """Return the position (m) and yaw (rad) of the reference at some times, shape (n, 4)."""
        assert self._reference is not None
        return references.sample_positions(self._reference, times)


_COLUMNS = (
    *(f"reference.{name}" for name in ("x", "y", "z", "yaw")),
    *(f"error.{name}" for name in ("x", "y", "z")),
)


class PluginPilot(ReferencePilot):
    """Pilot of a vehicle with a controller plugin, which publishes the reference at each step.

    The calls of the plugin are unknown, so rate, delay and the number of saturated calls are NaN.
    """

    rate = delay = saturated = math.nan
    updates = 0
    is_vectorized = False
    summary = program = ""
    variation: Optional[Tuple[np.ndarray, np.ndarray]] = None
    seconds: Sequence[float] = ()
    estimate_errors: Optional[np.ndarray] = None

    def note_estimates(self) -> None:
        """Do nothing, because the estimates of a plugin are unknown."""

    def __init__(
        self,
        controller: PluginController,
        simulation: _core.Simulation,
        reference: Union[references.ReferenceLike, ReferenceName, None],
    ) -> None:
        super().__init__(simulation, reference)
        topics = simulation.topics
        if "vel_cmd" not in topics or topics["vel_cmd"].writer is None:
            controller(0.0, None, None)
        topic = topics.get(TOPIC)
        if topic is None or topic.kind != "reference":
            raise InputError(
                f"controller '{controller.file}': it reads no reference from topic '{TOPIC}'. "
                "Let it read one."
            )

    def begin(self, simulation: Any, flight: _core.Flight) -> Callable[[int], int]:
        """Return the function that publishes the reference and advances a flight."""
        reference: Any = self._reference

        def advance(steps: int) -> int:
            if simulation.in_fleet:
                steps = 1
            for _ in range(steps):
                if reference is not None:
                    simulation.publish(TOPIC, list_fields(reference(simulation.time)))
                flight.advance(1)
            return steps

        return advance
