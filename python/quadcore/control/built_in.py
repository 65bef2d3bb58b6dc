"""A control law of quadcore, as `Simulation.run` flies it."""

from __future__ import annotations

import math
from typing import Any, Dict, Optional, Sequence

import numpy as np

from .. import _core
from ..support.parameters import values
from .rate_and_delay import DELAY, RATE, check_rate_or_delay


class BuiltInController:
    """A law of quadcore with its parameters; what it believes of the vehicle it takes from it.

    Attributes
    ----------
    name : str
        Of the law.
    parameters : dict of str to float
        That were given.
    rate : float
        Calls per simulated second.
    delay : float
        Time after which a command reaches the motors, s.
    spins : list of float
        1 or -1 for each rotor; empty: neighbours around the vehicle turn against each other.
    belief : Simulation, optional
        What is flown, as the law believes; None: what is flown. Parameters named ``believed_...``
        make it wrong.
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
        self.parameters = values(f"law '{name}'", parameters)
        self._controller: Optional[_core.Controller] = None
        self._period = math.nan

    def reset(self, simulation: _core.Simulation) -> None:
        """Begin anew, on what is to be flown.

        Parameters
        ----------
        simulation : Simulation
            Says what the law believes of the vehicle, unless `belief` does.

        Raises
        ------
        InputError
            A vehicle that the law cannot fly, or a rate that is none.
        """
        vehicle = simulation if self.belief is None else self.belief
        self._controller = _core.Controller(
            self.name, vehicle, simulation, self.parameters, self.spins
        )
        rate = check_rate_or_delay(f"law '{self.name}'", "rate", self.rate)
        self._period = max(1 / rate, simulation.dt)  # called once a step at most

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Give the speeds of the rotors, rad/s."""
        controller = self._begun()
        if reference is None:
            raise _core.InputError(f"law '{self.name}' has no reference to follow; give one")
        return controller.command(self._period, state, reference)

    def at(self, simulation: _core.Simulation, sensed: str, shape: _core.ReferenceShape) -> Any:
        """Give the speeds that a call would, for what the simulation knows now.

        Parameters
        ----------
        simulation : Simulation
            Which flies.
        sensed : str
            Topic on which the odometry stands.
        shape : ReferenceShape
            Where to fly: `Shape.shape`.

        Returns
        -------
        ndarray (n,)
            rad/s, signed.
        """
        return self._begun().command_at(self._period, simulation, sensed, shape)

    def _begun(self) -> _core.Controller:
        if self._controller is None:
            raise _core.InputError(f"law '{self.name}' flies nothing yet; call its reset()")
        return self._controller

    @property
    def saturated(self) -> bool:
        """Whether the rotors could not do what was asked of them last."""
        return self._controller is not None and bool(self._controller.saturated)

    def copy(self) -> BuiltInController:
        """Make the same law, as it is before it flies."""
        same = BuiltInController(self.name, self.rate, self.delay, self.spins, self.belief)
        same.parameters.update(self.parameters)  # whose names the core checks
        return same

    def told(self) -> Dict[str, Any]:
        """Say what it is, in plain values."""
        if self.belief is not None:
            raise _core.InputError(f"law '{self.name}' with a belief of its own cannot be told")
        return {n: v for n, v in self.__dict__.items() if not n.startswith("_")}

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_controller": None}  # made anew by reset()

    def __repr__(self) -> str:
        inside = "".join(f", {name}={value:g}" for name, value in self.parameters.items())
        return f"quadcore.controllers.{self.name}(rate={self.rate:g}{inside})"
