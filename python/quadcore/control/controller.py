"""Interface of controllers."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Protocol, Union

from .._core import InputError, Odometry
from ..support.arguments import shorten
from .built_in import BuiltInController
from .compiled_controller import is_compiled
from .inner_loop import SetPoint
from .keywords import ControllerName
from .user_parameters import set_attribute

if TYPE_CHECKING:
    import numpy.typing as npt


SENSED = "odom"
"""Topic of the odometry that controllers receive."""


class ControllerFunction(Protocol):
    """A controller that is a function."""

    def __call__(
        self, t: float, state: Odometry, reference: Any, /
    ) -> Union[npt.ArrayLike, SetPoint]:
        """Return the rotor speeds, as `Controller` does."""


class Controller(Protocol):
    """Interface of controllers; a function ``controller(t, state, reference)`` suffices.

    `reset`, `close` and all attributes are optional.

    Attributes
    ----------
    rate : float, default 500
        Calls per simulated second, 1/s; at most one call per step.
    fixed_rate : bool, default False
        Whether `rate` must not change. Set it for a controller that counts its calls as time, such
        as an autopilot in another process.
    delay : float, default 0
        Time from a call until its command reaches the motors, s, rounded up to whole steps. The
        command of the first call acts at once.
    log : dict of str to float, optional
        Columns of the log: each value after each call. The names must not change in a flight.
    inner_loop : InnerLoop, optional
        Converts a returned `AttitudeThrust`, `RatesThrust` or `WrenchThrust` to rotor speeds.
        Default: an inner loop with default gains.
    """

    def reset(self, simulation: Any, /) -> None:
        """Prepare for a run; called before its first step.

        Parameters
        ----------
        simulation : Simulation or Vehicle
            Simulation that the controller is to command. In a study, a view of the vehicle: its
            parameters and sensors.
        """

    def close(self) -> None:
        """End a run: stop processes, close sockets, remove temporary files.

        Called once after every `reset`, however the run ends: also after an error, an interrupt or
        the time limit of a study. It should return within 5 s.
        """

    def __call__(
        self, t: float, state: Odometry, reference: Any, /
    ) -> Union[npt.ArrayLike, SetPoint]:
        """Return the command until the next call.

        A controller may read the simulation and publish on topics. It must not step, move or
        command the simulation.

        Parameters
        ----------
        t : float
            Simulation time, s.
        state : Odometry
            Latest odometry message.
        reference : Reference or None
            Value of the reference at `t`; `reference.at(times)` gives it at other times. None if
            the run has no reference.

        Returns
        -------
        array_like (n,), AttitudeThrust, RatesThrust or WrenchThrust
            Signed rotor speeds as for `Simulation.command`, rad/s; or a set point for the inner
            loop.
        """


ControllerLike = Union[Controller, ControllerFunction, ControllerName]
"""A controller as `Simulation.run` accepts it, for type checkers."""


def check_callable(controller: Any) -> None:
    """Raise `InputError` unless an object can be called as a controller."""
    form = "controller(t, state, reference)"
    if not callable(controller):
        raise InputError(
            f"controller is {shorten(controller)}. Give a function or an object that is called "
            f"as {form}."
        )
    if is_compiled(controller):
        raise InputError(
            "controller is a compiled function. Give quadcore.CompiledController(function)."
        )
    if inspect.isclass(controller):
        name = controller.__name__
        raise InputError(f"controller is the class {name}. Give an instance: {name}().")
    try:
        signature = inspect.signature(controller)
    except (TypeError, ValueError):  # compiled functions may have no signature
        return
    try:
        signature.bind(0.0, None, None)
    except TypeError as error:
        raise InputError(f"controller: cannot be called as {form}: {error}") from None


def has_fixed_rate(controller: Any) -> bool:
    """Whether a controller declares that its rate must not change."""
    return bool(getattr(controller, "fixed_rate", False))


def set_parameter(controller: Any, name: str, value: float) -> None:
    """Set the rate, the delay or a parameter of a controller.

    The parameters of a user-defined controller are its public attributes that are numbers.

    Raises
    ------
    InputError
        If the controller does not have the attribute.
    """
    if name == "rate" and has_fixed_rate(controller):
        if value == controller.rate:
            return
        raise InputError(
            f"controller: its rate is fixed at {controller.rate:g} 1/s. Do not set another."
        )
    if name in ("rate", "delay"):
        try:
            setattr(controller, name, value)
        except (AttributeError, TypeError) as error:
            raise InputError(f"controller: its {name} cannot be set: {error}") from None
    elif isinstance(controller, BuiltInController):
        controller.parameters[name] = value
    else:
        set_attribute("the controller", controller, name, value)
