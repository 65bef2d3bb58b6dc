"""Many vehicles, stepped together."""

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
from ..support.arguments import brief
from ..support.values import SPAWN, Value, poses, seeds, whole
from ..support.warning import warn
from .batch_state import BatchState as BatchState
from .batch_vehicles import refusal, vehicle_count, vehicles
from .engines import EngineName, check_engine_and_step
from .flight import check_logged, steps_within
from .log import Log

if TYPE_CHECKING:
    import numpy.typing as npt


class BatchSimulation(_core.Batch):
    """Many vehicles of one model, each in a world of its own, stepped together.

    Each moves, to the last bit, as a `Simulation` of it does, however many others and threads there
    are. In the engines "eigen" and "gazebo11" several vehicles share each instruction, as long as
    motors and force laws are all that acts; others, and those in "ode", are stepped one by one.

    Parameters
    ----------
    model, engine, world, dt, ignore
        As of `Simulation`; the engine is "eigen" unless another is named.
    n : int
        Vehicles.
    parameters : mapping of str to value or array (n,), optional
        As of `Simulation`; an array has one for each vehicle, which ``xacro.ARG`` takes, too: the
        file is expanded for each value. Of a tag that is a row of k numbers an array is (n, k).
    xacro_args : mapping of str to value or array (n,), optional
        As of `Simulation`; the same as ``xacro.ARG``.
    spawn : array_like (n, 6), (n, 3), (6,) or (3,)
        x, y, z (m), and roll, pitch, yaw (rad), of each vehicle or of all.
    seed : int or array_like (n,)
        Of the noise of each vehicle; a number is that of the first, the next has the next.
    threads : int, optional
        That step; None: one for each processor.

    Attributes
    ----------
    n : int
        Number of vehicles.
    time : ndarray (n,)
        Of each vehicle, s.
    dt : float
        Length of a step, s.
    command_width : int
        Numbers of a vehicle's command.

    Raises
    ------
    InputError
        The model, world or an argument is at fault; the message carries ``FILE:LINE``.

    Warns
    -----
    QuadcoreWarning
        What was said of the first vehicle as it was made; `warnings(i)` has what was said of any.
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
        n = vehicle_count(n)
        engine, dt = check_engine_and_step(engine, dt)
        try:
            models, tags, self.world = vehicles(n, model, world, parameters, xacro_args, ignore)
            super().__init__(
                models,
                self.world,
                engine,
                dt,
                tags,
                poses(spawn, n),
                seeds(seed, n),
                0 if threads is None else whole(threads, "threads", bits=31),
            )
        except InputError as error:
            raise refusal(error, (parameters, xacro_args), n) from error.__cause__
        for warning in self.warnings(0):
            warn(warning)

    @property
    def state(self) -> BatchState:
        """The states now, copied; a failed vehicle's is that in which it failed."""
        return BatchState.of(self.read_state())

    def read_state(self, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Write the states now.

        Parameters
        ----------
        out : ndarray (n, 13 + 2 rotors), optional
            Where to; None makes one.

        Returns
        -------
        ndarray
            `out`: the columns of `BatchState`, one behind another.

        Raises
        ------
        InputError
            If `out` is not a writable, contiguous array of float64 of this shape.
        """
        if out is None:
            out = np.empty((self.n, self.state_width))
        self._write_state(out)
        return out

    def set_state(self, rows: npt.ArrayLike) -> None:
        """Take all vehicles to other states, at time 0; flights that failed go on.

        Parameters
        ----------
        rows : array_like (n, 13 + 2 rotors)
            As `read_state` has them; commands stay as they were.

        Raises
        ------
        InputError
            Another shape, a number that is not finite, or a quaternion that is none; nothing has
            changed then.
        """
        self._take_state(rows)

    def step(self, commands: Optional[npt.ArrayLike] = None, steps: int = 1) -> None:
        """Advance all vehicles that have not failed.

        Parameters
        ----------
        commands : array_like (n, rotors), optional
            Signed rotor speeds before the division by sim_slow, rad/s, held over these steps; None
            keeps the ones before.
        steps : int
            How many.

        Raises
        ------
        InputError
            Commands of another shape, or not finite, or for vehicles that a plugin commands;
            nothing has moved then.
        """
        super().step(commands, whole(steps, "steps", bits=63))

    def run(
        self,
        duration: float,
        commands: Optional[npt.ArrayLike] = None,
        log: Sequence[int] = (),
        log_every: int = 1,
    ) -> List[Log]:
        """Fly all vehicles for a while, and log some of them.

        Parameters
        ----------
        duration : float
            s; the last step is the last that ends within it.
        commands : array_like (n, rotors), optional
            As of `step`.
        log : sequence of int
            Vehicles, counted from 0.
        log_every : int
            Steps between logged rows.

        Returns
        -------
        list of Log
            Of each of these vehicles, the bytes that `Simulation.run` would give. One that fails
            ends with the last row before.

        Raises
        ------
        InputError
            An argument is at fault; nothing has moved then.
        """
        if not isinstance(log, Iterable):
            raise InputError(f"log is {brief(log)}; give a list of numbers of vehicles")
        chosen = [whole(vehicle, "log") for vehicle in log]
        for vehicle in chosen:
            if vehicle >= self.n:
                raise InputError(f"log names vehicle {vehicle}; there are 0 to {self.n - 1}")
        total = steps_within(duration, self.dt)
        if whole(log_every, "log_every") < 1 or chosen:
            check_logged(duration, self.dt, log_every)
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
        """Write rows of a log, which has no angles of the joints."""
        *logged, _ = BatchState.of(self.read_state()[chosen])
        return np.column_stack([self.time[chosen], *logged])

    @property
    def failed(self) -> np.ndarray:
        """Whether each vehicle's flight has failed: (n,) of bool. A reset ends that."""
        return np.array([bool(why) for why in self.failures])

    def reset(
        self,
        mask: Optional[npt.ArrayLike] = None,
        seed: Union[int, npt.ArrayLike, None] = None,
    ) -> None:
        """Take vehicles back to the moment of construction, bit for bit.

        Parameters
        ----------
        mask : array_like (n,) of bool, optional
            Which; None: all.
        seed : int or array_like (n,), optional
            As if they had been made with it; None keeps what they have.

        Raises
        ------
        InputError
            Another shape or kind; nothing has changed then.
        """
        chosen = np.ones(self.n, bool) if mask is None else mask
        super().reset(chosen, None if seed is None else seeds(seed, self.n))

    def __repr__(self) -> str:
        failed = sum(map(bool, self.failures))
        return f"<BatchSimulation of {self.n} vehicles, {failed} failed, steps of {self.dt:g} s>"
