"""Inner loop: rotor speeds from a thrust and an attitude, angular velocity or torque."""

from __future__ import annotations

import math
from numbers import Real
from typing import TYPE_CHECKING, Any, Dict, NamedTuple, Optional, Sequence, Union

import numpy as np

from .. import _core
from ..support.arguments import shorten
from ..support.parameters import check_values, write_docstring
from .vehicle import unwrap

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack

    from .keywords import InnerLoopGains

_ROUNDNESS = 1e-3
"""Accepted deviation of the norm of a quaternion from 1."""


class AttitudeThrust(NamedTuple):
    """Attitude and thrust, which a controller can return instead of rotor speeds.

    Attributes
    ----------
    orientation : array_like (4,)
        Desired orientation of the frame in the world, unit quaternion x, y, z, w.
    thrust : float
        Desired total thrust of the rotors along z of the frame, N.
    """

    orientation: npt.ArrayLike
    thrust: float


class RatesThrust(NamedTuple):
    """Angular velocity and thrust, which a controller can return instead of rotor speeds.

    Attributes
    ----------
    angular_velocity : array_like (3,)
        Desired angular velocity of the frame, body axes, rad/s.
    thrust : float
        Desired total thrust of the rotors along z of the frame, N.
    """

    angular_velocity: npt.ArrayLike
    thrust: float


class WrenchThrust(NamedTuple):
    """Torque and thrust, which a controller can return instead of rotor speeds.

    The control allocation converts them to rotor speeds; see `Vehicle.allocation`. If the request
    is infeasible, roll and pitch have priority, then the thrust, then yaw.

    Attributes
    ----------
    torque : array_like (3,)
        Desired total torque of the rotors about the centre of mass, body axes, N m.
    thrust : float
        Desired total thrust of the rotors along z of the frame, N.
    """

    torque: npt.ArrayLike
    thrust: float


SetPoint = Union[AttitudeThrust, RatesThrust, WrenchThrust]
"""Set-points that an inner loop converts to rotor speeds."""
SET_POINTS = (AttitudeThrust, RatesThrust, WrenchThrust)


class InnerLoop:
    """Compute rotor speeds from a thrust and an attitude, angular velocity or torque."""

    def __init__(
        self,
        spins: Sequence[float] = (),
        belief: Optional[_core.Simulation] = None,
        **parameters: Unpack[InnerLoopGains],
    ) -> None:
        self.spins = list(spins)
        self.belief = belief
        self.parameters = check_values("inner loop", parameters)
        self._loop: Optional[_core.InnerLoop] = None

    def leave(self) -> None:
        """Reset at the next call, because the controller returned another kind of command."""
        self._loop = None

    def speeds(
        self,
        simulation: _core.Simulation,
        period: float,
        state: Any,
        wanted: SetPoint,
    ) -> np.ndarray:
        """Return the rotor speeds that hold until the next call.

        Parameters
        ----------
        simulation : Simulation or Vehicle
            Simulation to command, or its view.
        period : float
            Time between two calls, s.
        state : Odometry
            Latest odometry message.
        wanted : AttitudeThrust, RatesThrust or WrenchThrust
            Set-point.

        Returns
        -------
        ndarray (n,)
            Signed rotor speeds as for `Simulation.command`, rad/s.

        Raises
        ------
        InputError
            If the set-point is invalid, or the inner loop does not support the vehicle.
        """
        target, thrust = _check_target(wanted)
        if self._loop is None:
            simulation = unwrap(simulation)
            vehicle = simulation if self.belief is None else unwrap(self.belief)
            self._loop = _core.InnerLoop(vehicle, simulation, self.parameters, self.spins)
        if isinstance(wanted, AttitudeThrust):
            return self._loop.attitude(period, state, target, thrust)
        if isinstance(wanted, WrenchThrust):
            return self._loop.wrench(period, state, target, thrust)
        return self._loop.rates(period, state, target, thrust)

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_loop": None}  # the next call makes a new one

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"quadcore.InnerLoop({inside})"


_COMMON = """\
spins : sequence of float
    Direction of each rotor, 1 or -1. Default: neighbouring rotors turn in opposite directions.
belief : Simulation, optional
    Vehicle that the inner loop is designed for. Default: the simulated vehicle."""

InnerLoop.__doc__ = write_docstring(
    "compute rotor speeds from an attitude, angular velocity or torque and a thrust",
    _core.inner_loop(),
    _COMMON,
)


def _check_target(wanted: SetPoint) -> Any:
    """Return target and thrust; raise `InputError` if they are invalid."""
    name, count = type(wanted)._fields[0], 4 if isinstance(wanted, AttitudeThrust) else 3
    who = f"{type(wanted).__name__}: its"
    try:
        target = np.asarray(wanted[0], dtype=float)
    except (TypeError, ValueError) as error:
        raise _core.InputError(f"{who} {name}: {error}") from None
    if target.shape != (count,) or not np.isfinite(target).all():
        raise _core.InputError(
            f"{who} {name} is {shorten(wanted[0])}. Give {count} finite numbers."
        )
    if count == 4:
        length = float(np.linalg.norm(target))
        if abs(length - 1) > _ROUNDNESS:
            raise _core.InputError(f"{who} {name} has length {length:g}. Give a unit quaternion.")
        target = target / length
    if not (isinstance(wanted.thrust, Real) and math.isfinite(wanted.thrust)):
        raise _core.InputError(f"{who} thrust is {shorten(wanted.thrust)}. Give a force in N.")
    return target, float(wanted.thrust)
