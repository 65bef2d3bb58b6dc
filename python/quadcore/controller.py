"""What flies a simulation in closed loop."""

from __future__ import annotations

import math
from numbers import Real
from typing import Any, Callable, Protocol, Union

import numpy as np

from . import _core, gains, references
from ._core import InputError, odometry_parts

DEFAULT_RATE = 500.0  # 1/s
_LOWEST_RATE = 1e-6  # 1/s

_SENSED = "odom"


class Controller(Protocol):
    """A law. A function ``law(t, state, reference)`` will do; the other members are optional.

    Attributes
    ----------
    rate : float
        Calls per simulated second, at most one per step; 500 without the attribute.
    delay : float
        From a call to the first step whose motors know of it, s, rounded up to whole steps; 0
        without the attribute. The first call of a run acts at once, for nothing precedes it.
    """

    def reset(self, simulation: Any) -> None:
        """Begin anew: called with the `Simulation` before the first step of a run."""

    def __call__(self, t: float, state: Odometry, reference: Any) -> Any:
        """Give the speeds for the steps until the next call.

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
        array_like, shape (n,)
            Rotor speeds, rad/s, signed, as `Simulation.command` takes them.
        """


class Odometry:
    """What the odometry plugin said, with the noise that its tags ask for.

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
    """

    __slots__ = ("angular_velocity", "linear_velocity", "orientation", "position", "time")

    def __init__(self, simulation: _core.Simulation) -> None:
        message = simulation.topic(_SENSED)
        self.time = message["stamp"]
        for part, fields in _PARTS:
            setattr(self, part, np.array([message[field] for field in fields]))


_PARTS = [entry for entry in odometry_parts() if entry[0] in Odometry.__slots__]


class Guided:
    """The pilot (see `flight.fly`) that asks a controller, and tells it what the odometry says.

    Raises
    ------
    InputError
        No controller, a rate that is none, a reference that is none, or a model without odometry.
    """

    def __init__(
        self,
        controller: Union[Controller, Callable[..., Any], str],
        simulation: _core.Simulation,
        reference: Union[references.ReferenceLike, str, None] = None,
    ) -> None:
        if isinstance(controller, str):
            controller = gains.law_for(controller, simulation.model.name)
        if isinstance(reference, str):
            reference = references.Shape(reference)
        if reference is not None and not callable(reference):
            raise InputError(
                f"reference is {reference!r}; give one of quadcore.references, or a function that "
                "is called as reference(t)"
            )
        if not callable(controller):
            raise InputError(
                f"controller is {controller!r}; give a function, or an object, that is called as "
                "controller(t, state, reference)"
            )
        rate = getattr(controller, "rate", DEFAULT_RATE)
        if not (isinstance(rate, Real) and _LOWEST_RATE <= float(rate) < math.inf):
            least = f"{_LOWEST_RATE:g}"
            raise InputError(f"controller: its rate is {rate!r}; give calls per second, >= {least}")
        delay = getattr(controller, "delay", 0)
        if not (isinstance(delay, Real) and 0 <= float(delay) < math.inf):
            raise InputError(f"controller: its delay is {delay!r}; give seconds, >= 0")
        self.rate = float(rate)
        self.delay = float(delay)
        self._controller = controller
        self._reference = reference
        sensed = simulation.topics.get(_SENSED)
        if sensed is None or sensed.kind != "odometry":
            raise InputError(
                f"controller: no plugin publishes odometry on topic '{_SENSED}'; "
                "add libodometry_plugin.so"
            )

    def reset(self, simulation: _core.Simulation) -> None:
        """Let the controller begin anew."""
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation)

    def speeds(self, simulation: _core.Simulation) -> Any:
        """Ask the controller."""
        wanted = None if self._reference is None else self._reference(simulation.time)
        return self._controller(simulation.time, Odometry(simulation), wanted)
