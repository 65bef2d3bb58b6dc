"""What flies a simulation in closed loop."""

from __future__ import annotations

import inspect
import math
from contextlib import contextmanager, suppress
from typing import Any, Callable, Iterator, Protocol, Union

import numpy as np

from .. import _core
from .._core import FlightError, InputError, QuadcoreError, odometry_parts
from ..control import laws, references
from ..control.inner_loop import AttitudeThrust, InnerLoop, RatesThrust
from ..control.timing import DELAY, RATE, checked
from ..support.arguments import brief
from ..support.user_code import told
from .flight import Pilot

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
    inner_loop : InnerLoop
        Flies the `AttitudeThrust` and `RatesThrust` that it returns; one with the defaults without
        the attribute.
    """

    def reset(self, simulation: Any) -> None:
        """Begin anew.

        Parameters
        ----------
        simulation : Simulation
            Which flies; called with it before the first step of each run.
        """

    def __call__(self, t: float, state: Odometry, reference: Any) -> Any:
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

    def __init__(self, simulation: _core.Simulation) -> None:
        self.topic = simulation.topic
        message = simulation.topic(_SENSED)
        self.time = message["stamp"]
        for part, fields in _PARTS:
            setattr(self, part, np.array([message[field] for field in fields]))


_PARTS = [entry for entry in odometry_parts() if entry[0] in Odometry.__slots__]


class Guided(Pilot):
    """The pilot (see `flight.fly`) that asks a controller, and tells it what the odometry says.

    Attributes
    ----------
    columns : sequence of str
        Names of what a log holds of the reference besides the state.
    updates : int
        How often the controller was asked.
    saturated : int
        How often the rotors could not do what it wanted: a law of quadcore knows; of another it is
        counted when a speed reaches the motors' limit.
    limit : float
        Of the motors' commands, rad/s; infinite without one.

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
            controller = laws.parse(controller, simulation.model.name)
        if isinstance(reference, str):
            reference = references.parse(reference)
        if isinstance(reference, references.Shape):
            reference = reference.on(simulation)
        if reference is not None and not callable(reference):
            raise InputError(
                f"reference is {brief(reference)}; give one of quadcore.references, or a function "
                "that is called as reference(t)"
            )
        check_callable(controller)
        self.rate = checked("controller", "rate", getattr(controller, "rate", RATE))
        self.delay = checked("controller", "delay", getattr(controller, "delay", DELAY))
        inner_loop = getattr(controller, "inner_loop", None)
        if not (inner_loop is None or isinstance(inner_loop, InnerLoop)):
            raise InputError(
                f"controller: its inner_loop is {brief(inner_loop)}; give a quadcore.InnerLoop"
            )
        self._inner_loop = InnerLoop() if inner_loop is None else inner_loop
        self.columns = _COLUMNS if reference is not None else ()
        self.updates = self.saturated = 0
        self._controller: Any = controller
        self._reference = reference
        self.limit = _fastest(simulation)
        sensed = simulation.topics.get(_SENSED)
        if sensed is None or sensed.kind != "odometry":
            raise InputError(
                f"controller: no plugin publishes odometry on topic '{_SENSED}'; "
                "add libodometry_plugin.so"
            )

    def reset(self, simulation: _core.Simulation) -> None:
        """Let the controller begin anew."""
        self._inner_loop.leave()
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation)

    def speeds(self, simulation: _core.Simulation) -> Any:
        """Ask the controller."""
        self.updates += 1
        law, reference = self._controller, self._reference
        if isinstance(law, laws.Law):
            if isinstance(reference, references.Shape):
                speeds = law.at(simulation, _SENSED, reference.shape)
            else:
                speeds = law(simulation.time, Odometry(simulation), self._wanted(simulation))
            self.saturated += law.saturated
            return speeds
        state = Odometry(simulation)
        speeds = law(simulation.time, state, self._wanted(simulation))
        if isinstance(speeds, (AttitudeThrust, RatesThrust)):
            period = max(1 / self.rate, simulation.dt)  # called once a step at most
            speeds = self._inner_loop.speeds(simulation, period, state, speeds)
        else:
            self._inner_loop.leave()
        if self.limit < math.inf:
            with suppress(TypeError, ValueError):  # what is no command is told when it is given
                self.saturated += bool(np.any(np.abs(np.asarray(speeds, float)) >= self.limit))
        return speeds

    def beside(self, table: np.ndarray) -> np.ndarray:
        """Add what `columns` names to rows of the state."""
        if self._reference is None:
            return table
        wanted = references.places(self._reference, table[:, 0])
        return np.hstack([table, wanted, table[:, 1:4] - wanted[:, :3]])

    def _wanted(self, simulation: _core.Simulation) -> Any:
        return None if self._reference is None else self._reference(simulation.time)


_COLUMNS = (
    *(f"reference.{name}" for name in ("x", "y", "z", "yaw")),
    *(f"error.{name}" for name in ("x", "y", "z")),
)


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


def give(controller: Any, name: str, value: float) -> None:
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
    elif isinstance(controller, laws.Law):
        controller.parameters[name] = value
    else:
        raise InputError(f"controller.{name}: only laws of quadcore have parameters")


@contextmanager
def faults_told(simulation: _core.Simulation) -> Iterator[None]:
    """Make of what a controller raises a flight that failed, told in one line.

    Raises
    ------
    FlightError
        In the place of anything that is no error of quadcore's, and of bad input with which a
        flight ended that had begun.
    """
    begin = simulation.time
    try:
        yield
    except InputError as error:
        # Without a time it is not what flies that is at fault: a full disk, say.
        if simulation.time > begin and hasattr(error, "time"):
            raise _failure(simulation, str(error)) from error
        raise
    except (QuadcoreError, MemoryError, KeyboardInterrupt):
        raise
    except BaseException as error:  # SystemExit, too: a controller ends its flight, not the program
        raise _failure(simulation, f"controller: {told(error)}") from error


def _failure(simulation: _core.Simulation, reason: str) -> FlightError:
    failure = FlightError(f"the flight failed at t = {simulation.time:f} s: {reason}")
    failure.time = simulation.time
    return failure


def _fastest(simulation: _core.Simulation) -> float:
    """Speed at which the motors' commands saturate, rad/s; infinite without a limit."""
    limits = [
        float(tag.value)
        for plugin in simulation.plugins
        for tag in plugin.parameters
        if tag.name == "maxVelocity" and tag.value != "none"
    ]
    return min(limits, default=math.inf)
