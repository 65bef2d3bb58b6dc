"""Built-in controllers."""

from __future__ import annotations

import math
from typing import Any, Dict, Optional, Sequence

import numpy as np

from .. import _core
from ..support.parameters import check_values
from .rate_and_delay import DELAY, RATE, check_rate_or_delay
from .vehicle import unwrap


class BuiltInController:
    """Built-in controller with its parameters.

    Its model of the vehicle is that of the simulated vehicle, or of `belief`. Parameters named
    ``believed_...`` scale this model.

    Attributes
    ----------
    name : str
        Name of the controller.
    parameters : dict of str to float
        Parameters that differ from the defaults.
    rate : float
        Calls per simulated second, 1/s.
    delay : float
        Actuation delay: time from a call until its command reaches the motors, s.
    spins : list of float
        Direction of each rotor, 1 or -1. If it is empty, neighbouring rotors turn in opposite
        directions.
    belief : Simulation, optional
        Vehicle for which the controller is designed. Default: the simulated vehicle.
    """

    def __init__(
        self,
        name: str,
        rate: float = RATE,
        delay: float = DELAY,
        spins: Sequence[float] = (),
        belief: Optional[_core.Simulation] = None,
        **parameters: Any,
    ) -> None:
        self.name = name
        self.rate = rate
        self.delay = delay
        self.spins = list(spins)
        self.belief = belief
        self.parameters = check_values(f"controller '{name}'", parameters)
        self._controller: Optional[_core.Controller] = None
        self._period = math.nan

    def reset(self, simulation: _core.Simulation) -> None:
        """Prepare for a run.

        Parameters
        ----------
        simulation : Simulation or Vehicle
            Simulation to command, or its view.

        Raises
        ------
        InputError
            If the controller does not support the vehicle, or its rate is out of range.
        """
        simulation = unwrap(simulation)
        vehicle = simulation if self.belief is None else unwrap(self.belief)
        self._controller = _core.Controller(
            self.name, vehicle, simulation, self.parameters, self.spins
        )
        rate = check_rate_or_delay(f"controller '{self.name}'", "rate", self.rate)
        self._period = max(1 / rate, simulation.dt)  # at most one call per step

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Return the signed rotor speeds, rad/s; see `Controller`."""
        if reference is None:
            raise _core.InputError(
                f"controller '{self.name}' has no reference to follow. Give one."
            )
        return self.core.command(self._period, state, reference)

    @property
    def core(self) -> _core.Controller:
        """Controller object of the core, which `reset` makes."""
        if self._controller is None:
            raise _core.InputError(f"controller '{self.name}' is not ready. Call its reset().")
        return self._controller

    @property
    def saturated(self) -> bool:
        """Whether the last command reached a limit of the rotors."""
        return self._controller is not None and bool(self._controller.saturated)

    def copy(self) -> BuiltInController:
        """Return an equal controller in its initial state."""
        same = BuiltInController(self.name, self.rate, self.delay, self.spins, self.belief)
        same.parameters.update(self.parameters)  # the core already checked the names
        return same

    def to_dict(self) -> Dict[str, Any]:
        """Return the attributes by name."""
        if self.belief is not None:
            raise _core.InputError(
                f"controller '{self.name}' with its own belief cannot be written. "
                "Remove the belief."
            )
        return {n: v for n, v in self.__dict__.items() if not n.startswith("_")}

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_controller": None}  # reset() makes a new one

    def __repr__(self) -> str:
        inside = "".join(f", {name}={value:g}" for name, value in self.parameters.items())
        return f"quadcore.controllers.{self.name}(rate={self.rate:g}{inside})"
