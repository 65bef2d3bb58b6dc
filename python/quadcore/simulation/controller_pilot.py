"""Pilot that calls a controller."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Callable, Iterator, Optional, Tuple, Union

import numpy as np

from .. import _core
from .._core import FlightError, InputError, QuadcoreError
from ..control import controllers, references
from ..control.built_in import BuiltInController
from ..control.compiled_controller import CompiledController, find_compiled
from ..control.controller import SENSED, ControllerLike, check_callable
from ..control.estimate_errors import EstimateErrors
from ..control.fair_controller import find_sensors
from ..control.inner_loop import SET_POINTS, InnerLoop
from ..control.keywords import ReferenceName
from ..control.own_columns import OwnColumns
from ..control.plugin_controller import PluginController
from ..control.rate_and_delay import DELAY, RATE, check_rate_or_delay
from ..control.reference_ahead import add_future
from ..control.vectorized import CommandAll, command_one, is_vectorized
from ..support.arguments import shorten
from ..support.user_code import describe_error
from .reference_pilot import PluginPilot, ReferencePilot

Command = Callable[[float, _core.Odometry], Any]
"""Function of time (s) and odometry that returns rotor speeds (rad/s)."""


class ControllerPilot(ReferencePilot):
    """Pilot (see `flight.fly`) that calls a controller with odometry and reference.

    Attributes
    ----------
    columns : sequence of str
        Names of the log columns of the reference and of the controller's `log`.
    is_vectorized : bool
        Whether the controller commands several vehicles at once.

    Raises
    ------
    InputError
        If the controller, its rate or the reference is invalid, or the model has no odometry.
    """

    def __init__(
        self,
        controller: ControllerLike,
        simulation: _core.Simulation,
        reference: Union[references.ReferenceLike, ReferenceName, None] = None,
        timed: bool = False,
    ) -> None:
        if isinstance(controller, str):
            controller = controllers.parse(controller, simulation.model.name)
        elif not isinstance(controller, BuiltInController):
            check_callable(controller)
        super().__init__(simulation, reference)
        self.is_vectorized = is_vectorized(controller)
        self.rate = check_rate_or_delay("controller", "rate", getattr(controller, "rate", RATE))
        self.delay = check_rate_or_delay("controller", "delay", getattr(controller, "delay", DELAY))
        inner_loop = getattr(controller, "inner_loop", None)
        if not (inner_loop is None or isinstance(inner_loop, InnerLoop)):
            raise InputError(
                f"controller: its inner_loop is {shorten(inner_loop)}. Give a quadcore.InnerLoop."
            )
        self._inner_loop = InnerLoop() if inner_loop is None else inner_loop
        self._own_columns = OwnColumns(controller)
        self.columns = (*self.columns, *self._own_columns.columns)
        self._estimate_errors: Optional[EstimateErrors] = None
        self._controller: Any = controller
        self._timed = timed
        self._loop: Optional[_core.ControlLoop] = None
        self._reported = 0  # saturated calls of a built-in controller that Python calls
        self._limits = simulation._command_limits
        sensed = simulation.topics.get(SENSED)
        if sensed is None or sensed.kind != "odometry":
            raise InputError(
                f"controller: no plugin publishes odometry on topic '{SENSED}'. "
                "Add libodometry_plugin.so."
            )

    @property
    def updates(self) -> int:
        """Number of controller calls."""
        return 0 if self._loop is None else self._loop.calls

    @property
    def saturated(self) -> int:
        """Number of calls with a command that the rotors could not follow.

        Built-in controllers report this number. A call of any other controller counts if a speed
        reaches the limit of its motor.
        """
        return self._reported + (0 if self._loop is None else self._loop.saturated)

    @property
    def summary(self) -> str:
        """Text that the controller reports about its last flight; "" for most controllers."""
        return str(getattr(self._controller, "summary", ""))

    @property
    def program(self) -> str:
        """External program that acted as the controller; "" for any other controller."""
        return str(getattr(self._controller, "program_summary", ""))

    @property
    def variation(self) -> Tuple[np.ndarray, np.ndarray]:
        """Total variation over all steps of joint velocities (rotors,) and commands (n,), rad/s."""
        if self._loop is None:
            return np.empty(0), np.empty(0)
        return self._loop.rate_variation, self._loop.command_variation

    @property
    def seconds(self) -> np.ndarray:
        """Duration of each call, s; empty unless calls are timed."""
        return np.empty(0) if self._loop is None else self._loop.seconds

    @property
    def estimate_errors(self) -> Optional[np.ndarray]:
        """Estimation errors of the controller (`EstimateErrors`); None without `note_estimates`."""
        return None if self._estimate_errors is None else self._estimate_errors.rows

    def note_estimates(self) -> None:
        """From now on, compare the controller's estimate with the true state at each call."""
        if not self.is_vectorized:
            self._estimate_errors = EstimateErrors(self._controller)

    @property
    def is_built_in(self) -> bool:
        """Whether controller and reference are both built in."""
        is_shape = isinstance(self._reference, references.Shape)
        return is_shape and isinstance(self._controller, BuiltInController)

    @property
    def built_in(self) -> Tuple[_core.Controller, _core.ReferenceShape]:
        """Built-in controller (after its reset) and built-in reference as objects of the core."""
        assert isinstance(self._reference, references.Shape)
        return self._controller.core, self._reference.shape

    def reset(self, simulation: _core.Simulation) -> None:
        """Reset the controller."""
        self._inner_loop.leave()
        self._own_columns.clear()
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation)

    def close(self) -> None:
        """Call the `close` method of the controller, if it has one."""
        close = getattr(self._controller, "close", None)
        if close is not None:
            close()

    def begin(self, simulation: Any, flight: _core.Flight) -> Callable[[int], int]:
        """Return the function that advances a flight; see `Pilot.begin`.

        A built-in controller with a built-in reference runs in the core, without the interpreter.
        """
        loop = self._loop = _core.ControlLoop(flight, self.rate, self.delay, self._timed)
        if self.is_built_in:
            core, shape = self.built_in
            return lambda steps: loop.follow(steps, core, SENSED, shape)
        call, limits = self._function(simulation), self._limits
        compiled, wanted = self._find_compiled(), self._reference
        if compiled is not None and isinstance(wanted, references.Shape):
            address, data, shape = compiled.address, compiled.data, wanted.shape
            return lambda steps: loop.control_compiled(steps, address, data, limits, SENSED, shape)
        sensors = find_sensors(self._controller, simulation)
        if isinstance(self._controller, BuiltInController):
            call, limits = self._count_reported(call), np.full(len(limits), np.inf)
        return lambda steps: loop.control(steps, call, limits, SENSED, sensors)

    def _find_compiled(self) -> Optional[CompiledController]:
        """Return the compiled controller; None if Python must record values after each call."""
        if self._own_columns.columns or self._estimate_errors is not None:
            return None
        return find_compiled(self._controller)

    def _count_reported(self, call: Command) -> Command:
        """Count the saturated calls that a built-in controller reports when Python calls it."""

        def count(t: float, state: _core.Odometry) -> Any:
            speeds = call(t, state)
            self._reported += self._controller.saturated
            return speeds

        return count

    def _function(self, simulation: Any) -> Command:
        """Make the function that calls the controller and, for set-points, its inner loop."""
        controller, inner_loop = self._controller, self._inner_loop
        period = max(1 / self.rate, simulation.dt)  # at most one call per step
        reference = None if self._reference is None else add_future(self._reference)
        width = len(self._limits)

        def call_vectorized(t: float, state: _core.Odometry) -> Any:
            wanted = None if reference is None else reference(t)
            return command_one(controller, t, state, wanted, width)

        def call(t: float, state: _core.Odometry) -> Any:
            speeds = controller(t, state, None if reference is None else reference(t))
            if isinstance(speeds, SET_POINTS):
                return inner_loop.speeds(simulation, period, state, speeds)
            inner_loop.leave()
            return speeds

        return self._add_notes(call_vectorized if self.is_vectorized else call, simulation)

    def _add_notes(self, call: Command, simulation: Any) -> Command:
        """Record the controller's columns and estimation errors after each call, if required."""
        columns, errors = self._own_columns, self._estimate_errors
        if not columns.columns and errors is None:
            return call

        def call_and_note(t: float, state: _core.Odometry) -> Any:
            speeds = call(t, state)
            if columns.columns:
                columns.note(t)
            if errors is not None:
                errors.note(simulation.state)
            return speeds

        return call_and_note

    def command_all(self, n: int) -> CommandAll:
        """Return the function with which a vectorized controller commands n vehicles."""
        given = self._reference
        reference = given.shape.at if isinstance(given, references.Shape) else given
        return CommandAll(self._controller, reference, n, self._limits)

    def fill_columns(self, table: np.ndarray) -> None:
        """Fill the columns of the reference and of the controller in rows of a log."""
        super().fill_columns(table)
        count = len(self._own_columns.columns)
        if count:
            table[:, -count:] = self._own_columns.sample(table[:, 0])


def make_pilot(
    controller: ControllerLike,
    simulation: _core.Simulation,
    reference: Union[references.ReferenceLike, ReferenceName, None] = None,
    timed: bool = False,
) -> Union[ControllerPilot, PluginPilot]:
    """Make the pilot of a controller; the errors are those of `ControllerPilot`."""
    if isinstance(controller, PluginController):
        return PluginPilot(controller, simulation, reference)
    return ControllerPilot(controller, simulation, reference, timed)


@contextmanager
def convert_controller_errors(simulation: _core.Simulation) -> Iterator[None]:
    """Convert an error of a controller to a `FlightError` with a one-line message.

    Raises
    ------
    FlightError
        If the block raises an error that is not a quadcore error, or an `InputError` during the
        flight.
    """
    begin = simulation.time
    try:
        yield
    except InputError as error:
        # An error without a time is not caused by the flight, but for example by a full disk.
        if simulation.time > begin and hasattr(error, "time"):
            raise _make_failure(simulation, str(error)) from error
        raise
    except (QuadcoreError, MemoryError, KeyboardInterrupt):
        raise
    except BaseException as error:  # includes SystemExit: it ends the flight, not the program
        raise _make_failure(simulation, f"controller: {describe_error(error)}") from error


def _make_failure(simulation: _core.Simulation, reason: str) -> FlightError:
    failure = FlightError(f"the flight failed at t = {simulation.time:f} s: {reason}")
    failure.time = simulation.time
    return failure
