"""The public class `BatchSimulation`."""

from __future__ import annotations

from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Iterable,
    List,
    Mapping,
    Optional,
    Sequence,
    Union,
)

import numpy as np

from .. import _core
from .._core import InputError
from ..support.arguments import shorten
from ..support.values import SPAWN, Value, check_poses, check_seeds, check_whole
from ..support.warning import warn
from .batch_guides import ControllerOfAll, ReferenceOfAll, follow, make_guides
from .batch_state import BatchState as BatchState
from .batch_vehicles import check_vehicle_count, explain_refusal, read_vehicles
from .engines import EngineName, check_engine_and_step
from .flight import check_log_every, check_log_length, count_steps
from .log import Log

if TYPE_CHECKING:
    import numpy.typing as npt


class BatchSimulation(_core.Batch):
    """Simulate many vehicles of one model, each in its own world.

    Each vehicle moves bit-identically to a separate `Simulation`, for any number of vehicles and
    threads. The engines "eigen" and "gazebo11" step several vehicles per instruction if only motors
    and force models act on them. All other vehicles are stepped one by one.

    Parameters
    ----------
    model, world, dt, ignore
        As for `Simulation`.
    n : int, default 1
        Number of vehicles.
    engine : {"gazebo11", "ode", "eigen"}, default "eigen"
        Physics engine.
    parameters : mapping of str to value or array (n,), optional
        As for `Simulation`. An array contains one value per vehicle; for a tag with k numbers, its
        shape is (n, k). ``xacro.ARG`` also accepts arrays.
    xacro_args : mapping of str to value or array (n,), optional
        Arguments of a xacro model, equivalent to ``xacro.ARG``.
    spawn : array_like (n, 6), (n, 3), (6,) or (3,), default (0, 0, 10)
        x, y, z (m) and roll, pitch, yaw (rad) of each vehicle, or of all vehicles.
    seed : int or array_like (n,), default 0
        Seed of each vehicle. An int is the seed of the first vehicle, and the following ones count
        up from it.
    threads : int, optional
        Number of threads. Default: one per processor.

    Attributes
    ----------
    n : int
        Number of vehicles.
    time : ndarray (n,)
        Time of each vehicle, s.
    dt : float
        Step, s.
    command_width : int
        Number of values in the command of a vehicle.

    Raises
    ------
    InputError
        If the model, the world or an argument is invalid. The message begins with ``FILE:LINE`` if
        a file causes the error.

    Warns
    -----
    QuadcoreWarning
        If valid input for the first vehicle is suspicious; `warnings(i)` lists the messages of any
        vehicle.
    """

    def __init__(
        self,
        model: Union[str, Path, _core.Model] = "quadrotor",
        n: int = 1,
        engine: EngineName = "eigen",
        parameters: Optional[Mapping[str, Union[Value, np.ndarray]]] = None,
        spawn: npt.ArrayLike = SPAWN,
        seed: Union[int, npt.ArrayLike] = 0,
        threads: Optional[int] = None,
        world: Union[str, Path, _core.World, None] = None,
        dt: Optional[float] = None,
        xacro_args: Optional[Mapping[str, object]] = None,
        ignore: Sequence[str] = (),
    ) -> None:
        n = check_vehicle_count(n)
        engine, dt = check_engine_and_step(engine, dt)
        try:
            self._vehicles = read_vehicles(n, model, world, parameters, xacro_args, ignore)
            self.world = self._vehicles.world
            self._engine = engine
            super().__init__(
                self._vehicles.models,
                self.world,
                engine,
                dt,
                self._vehicles.tags,
                check_poses(spawn, n),
                check_seeds(seed, n),
                0 if threads is None else check_whole(threads, "threads", bits=31),
            )
        except InputError as error:
            raise explain_refusal(error, (parameters, xacro_args), n) from error.__cause__
        for warning in self.warnings(0):
            warn(warning)

    @property
    def state(self) -> BatchState:
        """Copy of the current states; a failed vehicle keeps the state in which it failed."""
        return BatchState.of(self.read_state())

    def read_state(self, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Return the current states as one array.

        Parameters
        ----------
        out : ndarray (n, 13 + 2 rotors), optional
            Array to write to. Default: a new array.

        Returns
        -------
        ndarray (n, 13 + 2 rotors)
            `out`, with the columns in the order of `BatchState`.

        Raises
        ------
        InputError
            If `out` is not a writable, contiguous float64 array of this shape.
        """
        if out is None:
            out = np.empty((self.n, self.state_width))
        self._write_state(out)
        return out

    def set_state(self, rows: npt.ArrayLike) -> None:
        """Set the states of all vehicles, and reset their times to 0.

        The commands do not change. Failed vehicles are active again.

        Parameters
        ----------
        rows : array_like (n, 13 + 2 rotors)
            States in the format of `read_state`.

        Raises
        ------
        InputError
            If the shape is wrong, a number is not finite, or a quaternion is zero. Nothing changes
            in this case.
        """
        self._take_state(rows)

    def step(self, commands: Optional[npt.ArrayLike] = None, steps: int = 1) -> None:
        """Advance all vehicles that have not failed.

        Parameters
        ----------
        commands : array_like (n, rotors), optional
            Signed rotor speeds before the division by sim_slow, rad/s, held over these steps.
            Default: the current commands.
        steps : int, default 1
            Number of steps.

        Raises
        ------
        InputError
            If the commands have a wrong shape or are not finite, or if a plugin commands the
            vehicles. Nothing moves in this case.
        """
        super().step(commands, check_whole(steps, "steps", bits=63))

    def run(
        self,
        duration: float,
        commands: Optional[npt.ArrayLike] = None,
        log: Sequence[int] = (),
        log_every: int = 1,
        *,
        controller: Optional[ControllerOfAll] = None,
        reference: ReferenceOfAll = None,
    ) -> List[Log]:
        """Simulate all vehicles for a duration, and log some of them.

        Parameters
        ----------
        duration : float
            Duration, s. Only steps that end within it are simulated.
        commands : array_like (n, rotors), optional
            As for `step`.
        log : sequence of int, default ()
            Indices of the vehicles to log, starting at 0.
        log_every : int, default 1
            Steps between logged rows.
        controller : name, object, or sequence of n of these, optional
            Controller of all vehicles or of each vehicle, instead of `commands`. Either built-in
            controllers, as for `Simulation.run`, or a controller with ``vectorized = True`` for
            equal vehicles. The vehicles must be at time 0; see `reset`.
        reference : name, object, or sequence of n of these, optional
            Reference of all vehicles or of each vehicle, as for `Simulation.run`. Built-in
            controllers require built-in references.

        Returns
        -------
        list of Log
            One log for each vehicle in `log`, bit-identical to that of `Simulation.run`. The log of
            a failed vehicle ends before the failure.

        Raises
        ------
        InputError
            If an argument is invalid, or a vehicle with a controller is not in its initial state.
            Nothing moves in this case.
        FlightError
            If a vectorized controller returns a command that is not finite.
        """
        if commands is not None and controller is not None:
            raise InputError("a batch takes commands or a controller. Give one of them.")
        if reference is not None and controller is None:
            raise InputError("a reference needs a controller that follows it. Give one.")
        if not isinstance(log, Iterable):
            raise InputError(f"log is {shorten(log)}. Give a list of vehicle numbers.")
        chosen = [check_whole(vehicle, "log") for vehicle in log]
        for vehicle in chosen:
            if vehicle >= self.n:
                raise InputError(f"log names vehicle {vehicle}. Use 0 to {self.n - 1}.")
        total = count_steps(duration, self.dt)
        log_every = check_log_every(log_every)
        if chosen and total:  # without steps, the log is the present row
            check_log_length(duration, self.dt, log_every)
        if controller is not None:
            guides = make_guides(self._vehicles, self._engine, self.dt, controller, reference)
            tables = follow(self, guides, total, chosen, log_every)
            return [guides[i].logs.make(table) for i, table in zip(chosen, tables)]
        self.step(commands, 0)
        logged = [[row] for row in self._rows_now(chosen)]
        times = total // log_every if chosen else 0
        for _ in range(times):
            super().step(None, log_every)
            for rows, row, failed in zip(logged, self._rows_now(chosen), self.failed[chosen]):
                if not failed:
                    rows.append(row)
        super().step(None, total - log_every * times)
        return [Log(np.array(rows), {}) for rows in logged]

    def _rows_now(self, chosen: Sequence[int]) -> np.ndarray:
        """Return the current rows of the log, without joint angles."""
        *logged, _ = BatchState.of(self.read_state()[chosen])
        return np.column_stack([self.time[chosen], *logged])

    @property
    def failed(self) -> np.ndarray:
        """Whether each vehicle has failed since its last reset; bool, shape (n,)."""
        return np.array([bool(why) for why in self.failures])

    def reset(
        self,
        mask: Optional[npt.ArrayLike] = None,
        seed: Union[int, npt.ArrayLike, None] = None,
    ) -> None:
        """Return vehicles to their initial states, bit-identically.

        Parameters
        ----------
        mask : array_like (n,) of bool, optional
            Vehicles to reset. Default: all.
        seed : int or array_like (n,), optional
            New seeds, as for the constructor. Default: the current seeds.

        Raises
        ------
        InputError
            If an array has a wrong shape or type. Nothing changes in this case.
        """
        chosen = np.ones(self.n, bool) if mask is None else mask
        super().reset(chosen, None if seed is None else check_seeds(seed, self.n))

    def __repr__(self) -> str:
        failed = sum(map(bool, self.failures))
        return f"<BatchSimulation of {self.n} vehicles, {failed} failed, steps of {self.dt:g} s>"
