"""Mathematical model as an engine that controllers can command."""

from __future__ import annotations

from pathlib import Path
from typing import Any, List, Mapping

import numpy as np

from ..._core import InputError
from ...simulation.simulation import Simulation
from ...simulation.state import State, make_state
from .. import LAGRANGE
from .model import THESIS, MathematicalModel, Terms
from .vehicle import Vehicle, find_air_plugin, list_command_order

_UNFELT = ("libwind_plugin.so", "libpayload_plugin.so", "libfault_plugin.so")
"""Plugins that change forces of other plugins but have no effect on the mathematical model."""


class Plant(Simulation):
    """`Simulation` with the equations of motion of chapter 2.

    Plugins receive commands and publish measurements as in any engine, with their rates and noise.
    Their forces do not act. Instead, the forces of the mathematical model act, with the values of
    the plugin tags.

    Parameters
    ----------
    terms : Terms
        Terms to add to those of the thesis.
    **options
        As for `Simulation`, except for `engine`.

    Raises
    ------
    InputError
        If chapter 2 has no equations for the vehicle or the world.
    """

    def __init__(self, terms: Terms = THESIS, **options: Any) -> None:
        super().__init__(**options, engine="eigen")
        check(self)
        self._move_by(_Motion(MathematicalModel(Vehicle.of(self), terms), list_command_order(self)))

    @property
    def engine(self) -> str:
        """Name of the engine."""
        return LAGRANGE

    @property
    def wrench_terms(self) -> List[str]:
        """Empty list, because the model has no wrenches of plugins."""
        return []

    @property
    def method(self) -> str:
        """Description of the integration method."""
        return "Euler-Lagrange equation (2.38), classical Runge-Kutta of fourth order"


class _Motion:
    """Step of the model from one state of the frame link to the next."""

    def __init__(self, model: MathematicalModel, order: Any) -> None:
        self._model, self._order = model, order
        self._fastest = model.vehicle.fastest

    def __call__(self, dt: float, command: np.ndarray, members: Mapping[str, Any]) -> State:
        state = make_state(members)
        joints = state.rotor_velocity.copy()
        state.rotor_velocity = joints[self._order]
        speeds = np.clip(command, -self._fastest, self._fastest)
        after = self._model.step(dt, speeds, state)
        joints[self._order] = after.rotor_velocity
        turned = state.rotor_angle + dt * joints
        after.rotor_velocity = joints
        after.rotor_angle = np.remainder(turned + np.pi, 2 * np.pi) - np.pi
        return after


def check(simulation: Simulation) -> None:
    """Raise `InputError` if a force acts on the vehicle that chapter 2 does not model."""
    world = simulation.world
    if world.ground_plane or world.obstacles or world.free_bodies:
        solid = "a ground plane" if world.ground_plane else "obstacles or free bodies"
        raise InputError(
            f"engine {LAGRANGE}: the mathematical model has no contact, but the world has {solid}. "
            "Use a world without one, such as empty."
        )
    air = find_air_plugin(simulation)
    for plugin in simulation.plugins:
        if plugin.wrenches and plugin.name != air.name:
            raise InputError(
                f"engine {LAGRANGE}: plugin '{plugin.name}' exerts {', '.join(plugin.wrenches)}, "
                "which the mathematical model does not have. Remove it, or use another engine."
            )
        if Path(plugin.filename).name in _UNFELT:
            raise InputError(
                f"engine {LAGRANGE}: plugin '{plugin.name}' ({plugin.filename}) has no effect "
                "on the mathematical model. Remove it, or use another engine."
            )
