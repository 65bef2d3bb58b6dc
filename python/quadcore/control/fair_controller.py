"""User-defined controllers with a view of the vehicle instead of the simulation."""

from __future__ import annotations

from typing import Any

from .built_in import BuiltInController
from .plugin_controller import PluginController
from .vehicle import Vehicle
from .wrapped_controller import WrappedController

PRIVILEGED = " (privileged)"
"""Suffix of the label of a controller that has access to the whole simulation."""


class FairController(WrappedController):
    """Wrap a user-defined controller, and forward its attributes.

    `reset` passes a `Vehicle` to the controller. The odometry gives access only to the topics of
    sensors.
    """

    reads_sensors_only = True

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self._controller, name, value)

    def reset(self, simulation: Any) -> None:
        """Reset the controller with a view of the vehicle."""
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation if isinstance(simulation, Vehicle) else Vehicle(simulation))


def restrict(controller: Any) -> Any:
    """Return a controller that has access only to a view of the vehicle.

    Built-in controllers need no restriction. Plugin controllers cannot be restricted; see
    `PRIVILEGED`.
    """
    if isinstance(controller, (BuiltInController, PluginController)):
        return controller
    return FairController(controller)


def find_sensors(controller: Any, simulation: Any) -> Any:
    """Return the object with the topics of a controller; a `Vehicle` has only sensor topics."""
    return Vehicle(simulation) if getattr(controller, "reads_sensors_only", False) else simulation
