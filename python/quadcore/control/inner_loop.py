"""From attitudes and rates, at which many laws end, down to the rotors."""

from __future__ import annotations

import math
from numbers import Real
from typing import TYPE_CHECKING, Any, Dict, NamedTuple, Optional, Sequence, Union

import numpy as np

from .. import _core
from ..support.arguments import brief
from ..support.parameters import docstring, values

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack

    from .keywords import InnerLoopGains

_ROUNDNESS = 1e-3
"""By which the length of a quaternion may differ from 1."""


class AttitudeThrust(NamedTuple):
    """An attitude to be held, and the thrust of all rotors: what a controller may return.

    Attributes
    ----------
    orientation : array_like (4,)
        Of the frame in the world, unit quaternion x, y, z, w.
    thrust : float
        Along z of the frame, N.
    """

    orientation: npt.ArrayLike
    thrust: float


class RatesThrust(NamedTuple):
    """An angular velocity to be held, and the thrust of all rotors: what a controller may return.

    Attributes
    ----------
    angular_velocity : array_like (3,)
        Of the frame, its own axes, rad/s.
    thrust : float
        Along z of the frame, N.
    """

    angular_velocity: npt.ArrayLike
    thrust: float


class InnerLoop:
    """Flies an attitude or rates with a thrust."""

    def __init__(
        self,
        spins: Sequence[float] = (),
        belief: Optional[_core.Simulation] = None,
        **parameters: Unpack[InnerLoopGains],
    ) -> None:
        self.spins = list(spins)
        self.belief = belief
        self.parameters = values("inner loop", parameters)
        self._loop: Optional[_core.InnerLoop] = None

    def leave(self) -> None:
        """Begin anew with the next call: other commands come between."""
        self._loop = None

    def speeds(
        self,
        simulation: _core.Simulation,
        period: float,
        state: Any,
        wanted: Union[AttitudeThrust, RatesThrust],
    ) -> np.ndarray:
        """Give the speeds of the rotors until the next call.

        Parameters
        ----------
        simulation : Simulation
            Says what flies.
        period : float
            Since the last call and until the next, s.
        state : Odometry
            What the odometry says.
        wanted : AttitudeThrust or RatesThrust
            What is to be flown.

        Returns
        -------
        ndarray (n,)
            rad/s, signed, as `Simulation.command` takes them.

        Raises
        ------
        InputError
            Something wanted that is no attitude, rate or thrust, or a vehicle that cannot be
            flown.
        """
        target, thrust = _checked(wanted)
        if self._loop is None:
            vehicle = simulation if self.belief is None else self.belief
            self._loop = _core.InnerLoop(vehicle, simulation, self.parameters, self.spins)
        if isinstance(wanted, AttitudeThrust):
            return self._loop.attitude(period, state, target, thrust)
        return self._loop.rates(period, state, target, thrust)

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_loop": None}  # made anew by the next call

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"quadcore.InnerLoop({inside})"


_COMMON = """\
spins : sequence of float
    1 or -1 for each rotor; without, neighbours around the vehicle turn against each other.
belief : Simulation, optional
    A vehicle to take for the one that is flown."""

InnerLoop.__doc__ = docstring(
    "flies an attitude or rates with a thrust, as the laws on rotations do inside",
    _core.inner_loop(),
    _COMMON,
)


def _checked(wanted: Union[AttitudeThrust, RatesThrust]) -> Any:
    """Give target and thrust; raises `InputError` if they are none."""
    name, count = type(wanted)._fields[0], 4 if isinstance(wanted, AttitudeThrust) else 3
    who = f"{type(wanted).__name__}: its"
    try:
        target = np.asarray(wanted[0], dtype=float)
    except (TypeError, ValueError) as error:
        raise _core.InputError(f"{who} {name}: {error}") from None
    if target.shape != (count,) or not np.isfinite(target).all():
        raise _core.InputError(f"{who} {name} is {brief(wanted[0])}; give {count} finite numbers")
    if count == 4:
        length = float(np.linalg.norm(target))
        if abs(length - 1) > _ROUNDNESS:
            raise _core.InputError(f"{who} {name} has length {length:g}; give a unit quaternion")
        target = target / length
    if not (isinstance(wanted.thrust, Real) and math.isfinite(wanted.thrust)):
        raise _core.InputError(f"{who} thrust is {brief(wanted.thrust)}; give N")
    return target, float(wanted.thrust)
