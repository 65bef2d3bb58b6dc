"""Pilot that calls a controller."""

from __future__ import annotations

from contextlib import contextmanager, suppress
from typing import Any, Iterator, Union

import numpy as np

from .. import _core
from .._core import FlightError, InputError, QuadcoreError
from ..control import controllers, references
from ..control.built_in import BuiltInController
from ..control.controller import SENSED, ControllerLike, Odometry, check_callable
from ..control.inner_loop import AttitudeThrust, InnerLoop, RatesThrust
from ..control.keywords import ReferenceName
from ..control.rate_and_delay import DELAY, RATE, check_rate_or_delay
from ..support.arguments import shorten
from ..support.user_code import describe_error
from .flight import Pilot


class ControllerPilot(Pilot):
    """Pilot (see `flight.fly`) that calls a controller with odometry and reference.

    Attributes
    ----------
    columns : sequence of str
        Names of the columns that the log has for the reference.
    updates : int
        Number of calls of the controller.
    saturated : int
        Number of calls with commands at the limits of the rotors. Built-in controllers report
        this; for others a call counts if a speed reaches the limit of its motor.

    Raises
    ------
    InputError
        If controller, rate or reference is not valid, or the model has no odometry.
    """

    def __init__(
        self,
        controller: ControllerLike,
        simulation: _core.Simulation,
        reference: Union[references.ReferenceLike, ReferenceName, None] = None,
    ) -> None:
        if isinstance(controller, str):
            controller = controllers.parse(controller, simulation.model.name)
        if isinstance(reference, str):
            reference = references.parse(reference)
        if isinstance(reference, references.Shape):
            reference = reference.on(simulation)
        if reference is not None and not callable(reference):
            raise InputError(
                f"reference is {shorten(reference)}. Give one of quadcore.references, or a "
                "function that is called as reference(t)."
            )
        check_callable(controller)
        self.rate = check_rate_or_delay("controller", "rate", getattr(controller, "rate", RATE))
        self.delay = check_rate_or_delay("controller", "delay", getattr(controller, "delay", DELAY))
        inner_loop = getattr(controller, "inner_loop", None)
        if not (inner_loop is None or isinstance(inner_loop, InnerLoop)):
            raise InputError(
                f"controller: its inner_loop is {shorten(inner_loop)}; give a quadcore.InnerLoop"
            )
        self._inner_loop = InnerLoop() if inner_loop is None else inner_loop
        self.columns = _COLUMNS if reference is not None else ()
        self.updates = self.saturated = 0
        self._controller: Any = controller
        self._reference = reference
        driven = [rotor for rotor in simulation.rotors if rotor.command_index is not None]
        self._places = np.array([rotor.command_index for rotor in driven], dtype=int)
        self._limits = np.array([rotor.max_speed for rotor in driven])
        sensed = simulation.topics.get(SENSED)
        if sensed is None or sensed.kind != "odometry":
            raise InputError(
                f"controller: no plugin publishes odometry on topic '{SENSED}'; "
                "add libodometry_plugin.so"
            )

    def reset(self, simulation: _core.Simulation) -> None:
        """Reset the controller."""
        self._inner_loop.leave()
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation)

    def speeds(self, simulation: _core.Simulation) -> Any:
        """Call the controller."""
        self.updates += 1
        law, reference = self._controller, self._reference
        if isinstance(law, BuiltInController):
            if isinstance(reference, references.Shape):
                speeds = law.at(simulation, SENSED, reference.shape)
            else:
                speeds = law(
                    simulation.time, Odometry(simulation), self._evaluate_reference(simulation)
                )
            self.saturated += law.saturated
            return speeds
        state = Odometry(simulation)
        speeds = law(simulation.time, state, self._evaluate_reference(simulation))
        if isinstance(speeds, (AttitudeThrust, RatesThrust)):
            period = max(1 / self.rate, simulation.dt)  # called once a step at most
            speeds = self._inner_loop.speeds(simulation, period, state, speeds)
        else:
            self._inner_loop.leave()
        with suppress(TypeError, ValueError, IndexError):  # a bad command is refused when given
            sizes = np.abs(np.asarray(speeds, float))[self._places]
            self.saturated += bool(np.any(sizes >= self._limits))
        return speeds

    def add_columns(self, table: np.ndarray) -> np.ndarray:
        """Add the columns of the reference to rows of the state."""
        if self._reference is None:
            return table
        wanted = references.sample_positions(self._reference, table[:, 0])
        return np.hstack([table, wanted, table[:, 1:4] - wanted[:, :3]])

    def _evaluate_reference(self, simulation: _core.Simulation) -> Any:
        return None if self._reference is None else self._reference(simulation.time)


_COLUMNS = (
    *(f"reference.{name}" for name in ("x", "y", "z", "yaw")),
    *(f"error.{name}" for name in ("x", "y", "z")),
)


@contextmanager
def convert_controller_errors(simulation: _core.Simulation) -> Iterator[None]:
    """Convert an error of a controller to a `FlightError` with a message of one line.

    Raises
    ------
    FlightError
        If the block raises an error from outside quadcore, or an `InputError` after the start.
    """
    begin = simulation.time
    try:
        yield
    except InputError as error:
        # Without a time it is not what flies that is at fault: a full disk, say.
        if simulation.time > begin and hasattr(error, "time"):
            raise _make_failure(simulation, str(error)) from error
        raise
    except (QuadcoreError, MemoryError, KeyboardInterrupt):
        raise
    except BaseException as error:  # SystemExit, too: a controller ends its flight, not the program
        raise _make_failure(simulation, f"controller: {describe_error(error)}") from error


def _make_failure(simulation: _core.Simulation, reason: str) -> FlightError:
    failure = FlightError(f"the flight failed at t = {simulation.time:f} s: {reason}")
    failure.time = simulation.time
    return failure
