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
"""Topic of the odometry that is passed to controllers."""


class ControllerFunction(Protocol):
    """Interface of a controller that is a function."""

    def __call__(
        self, t: float, state: Odometry, reference: Any, /
    ) -> Union[npt.ArrayLike, SetPoint]:
        """Return the command, as for `Controller`."""


class Controller(Protocol):
    """Interface of controllers; a function ``controller(t, state, reference)`` is sufficient.

    `reset`, `close` and all attributes are optional.

    Attributes
    ----------
    rate : float, default 500
        Calls per simulated second, 1/s. There is at most one call per step.
    fixed_rate : bool, default False
        Whether `rate` must not change. Set it for a controller that measures time by counting its
        calls, such as an autopilot in another process.
    delay : float, default 0
        Actuation delay: time from a call until its command reaches the motors, s, rounded up to
        whole steps. The command of the first call acts at once.
    log : dict of str to float, optional
        Columns of the log, with their values after each call. The names must not change during a
        flight.
    inner_loop : InnerLoop, optional
        Inner loop that converts a returned `AttitudeThrust`, `RatesThrust` or `WrenchThrust` to
        rotor speeds. Default: an inner loop with default gains.
    """

    def reset(self, simulation: Any, /) -> None:
        """Prepare for a run; the simulation calls this method before the first step.

        Parameters
        ----------
        simulation : Simulation or Vehicle
            Simulation to command. In a study, this is a view of the vehicle with its parameters and
            sensors.
        """

    def close(self) -> None:
        """End a run: stop processes, close sockets, and remove temporary files.

        The simulation calls this method once after every `reset`, even after an error, an interrupt
        or the time limit of a study. It should return within 5 s.
        """

    def __call__(
        self, t: float, state: Odometry, reference: Any, /
    ) -> Union[npt.ArrayLike, SetPoint]:
        """Return the command that holds until the next call.

        A controller may read the simulation and publish on topics. It must not step, move or
        command the simulation.

        Parameters
        ----------
        t : float
            Simulation time, s.
        state : Odometry
            Latest odometry message.
        reference : Reference or None
            Value of the reference at time `t`; `reference.at(times)` returns it at other times.
            None if the run has no reference.

        Returns
        -------
        array_like (n,), AttitudeThrust, RatesThrust or WrenchThrust
            Signed rotor speeds as for `Simulation.command`, rad/s; or a set-point for the inner
            loop.
        """


ControllerLike = Union[Controller, ControllerFunction, ControllerName]
"""Types of controllers that `Simulation.run` accepts, for type checkers."""


def check_callable(controller: Any) -> None:
    """Raise `InputError` if an object cannot be called as a controller."""
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

    The parameters of a user-defined controller are its public numeric attributes.

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
