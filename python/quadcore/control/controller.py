"""What a controller of a flight is: a law of quadcore or an object of the user's."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Callable, Dict, Protocol, Union

import numpy as np

from .. import _core
from .._core import InputError, odometry_parts
from ..support.arguments import brief
from .built_in import BuiltInController
from .inner_loop import AttitudeThrust, RatesThrust
from .keywords import ControllerName

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..support.values import FloatArray

SENSED = "odom"
"""Topic on which the odometry stands."""


class ControllerFunction(Protocol):
    """A controller that is a function."""

    def __call__(
        self, t: float, state: Odometry, reference: Any, /
    ) -> Union[npt.ArrayLike, AttitudeThrust, RatesThrust]:
        """Return the rotor speeds, as `Controller` does."""


class Controller(Protocol):
    """A law. A function ``law(t, state, reference)`` will do; the other members are optional.

    Attributes
    ----------
    rate : float
        Calls per simulated second, at most one per step; 500 without the attribute.
    delay : float
        From a call to the first step whose motors know of it, s, rounded up to whole steps; 0
        without the attribute. The first call of a run acts at once, for nothing precedes it.
    inner_loop : InnerLoop
        Flies the `AttitudeThrust` and `RatesThrust` that it returns; one with the defaults without
        the attribute.
    """

    def reset(self, simulation: Any, /) -> None:
        """Begin anew.

        Parameters
        ----------
        simulation : Simulation
            Which flies; called with it before the first step of each run.
        """

    def __call__(
        self, t: float, state: Odometry, reference: Any, /
    ) -> Union[npt.ArrayLike, AttitudeThrust, RatesThrust]:
        """Give the speeds for the steps until the next call.

        It may read the simulation that flies, and publish; to move or command it is refused.

        Parameters
        ----------
        t : float
            Time of the simulation, s.
        state : Odometry
            What the odometry said last.
        reference
            What the run's reference says at that time, with attributes position, velocity,
            acceleration, jerk, snap, yaw, yaw_rate, yaw_acceleration; None without one.

        Returns
        -------
        array_like, shape (n,), or AttitudeThrust, or RatesThrust
            Rotor speeds, rad/s, signed, as `Simulation.command` takes them; or what an inner loop
            is to make of them.
        """


ControllerLike = Union[Controller, ControllerFunction, ControllerName]
"""A controller as `Simulation.run` accepts it, for type checkers."""


class Odometry:
    """What the odometry plugin said, with the noise that its tags ask for.

    Parameters
    ----------
    simulation : Simulation
        Whose odometry it is.

    Attributes
    ----------
    time : float
        Of the message, s.
    position : ndarray (3,)
        Frame origin in the world, m.
    orientation : ndarray (4,)
        Of the frame in the world, unit quaternion x, y, z, w.
    linear_velocity : ndarray (3,)
        Of the frame origin, m/s; in the axes that the plugin's `twistFrame` names.
    angular_velocity : ndarray (3,)
        Of the frame, body axes, rad/s.
    topic : callable
        ``topic(name)`` is what stands on another topic of the flight, as `Simulation.topic` has
        it: what other sensors say.
    """

    __slots__ = (
        "angular_velocity",
        "linear_velocity",
        "orientation",
        "position",
        "time",
        "topic",
    )

    time: float
    position: FloatArray
    orientation: FloatArray
    linear_velocity: FloatArray
    angular_velocity: FloatArray
    topic: Callable[[str], Dict[str, float]]

    def __init__(self, simulation: _core.Simulation) -> None:
        self.topic = simulation.topic
        message = simulation.topic(SENSED)
        self.time = message["stamp"]
        for part, fields in _PARTS:
            setattr(self, part, np.array([message[field] for field in fields]))


_PARTS = [entry for entry in odometry_parts() if entry[0] in Odometry.__slots__]


def check_callable(controller: Any) -> None:
    """Raise `InputError` unless a controller can be called as one."""
    form = "controller(t, state, reference)"
    if not callable(controller):
        raise InputError(
            f"controller is {brief(controller)}; give a function, or an object, that is called as "
            f"{form}"
        )
    if inspect.isclass(controller):
        name = controller.__name__
        raise InputError(f"controller is the class {name}; give an instance: {name}()")
    try:
        signature = inspect.signature(controller)
    except (TypeError, ValueError):  # of a compiled one nobody can tell
        return
    try:
        signature.bind(0.0, None, None)
    except TypeError as error:
        raise InputError(f"controller: cannot be called as {form}: {error}") from None


def set_parameter(controller: Any, name: str, value: float) -> None:
    """Give a controller another `rate` or `delay`, or a law of quadcore another parameter.

    Raises
    ------
    InputError
        It cannot have one.
    """
    if name in ("rate", "delay"):
        try:
            setattr(controller, name, value)
        except (AttributeError, TypeError) as error:
            raise InputError(f"controller: its {name} cannot be set: {error}") from None
    elif isinstance(controller, BuiltInController):
        controller.parameters[name] = value
    else:
        raise InputError(f"controller.{name}: only laws of quadcore have parameters")
