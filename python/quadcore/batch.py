"""Many vehicles, stepped together."""

from __future__ import annotations

from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Any,
    Dict,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    Union,
)
from warnings import warn

import numpy as np

from . import _core
from ._core import InputError
from .description import read_both
from .given import Value, text_of, whole
from .overrides import check_names, with_links, without_xacro
from .warning import QuadcoreWarning

if TYPE_CHECKING:
    import numpy.typing as npt


class BatchState(NamedTuple):
    """The states of the vehicles of a batch, a row for each.

    Attributes
    ----------
    position : ndarray (n, 3)
        Frame origins in the world, m.
    orientation : ndarray (n, 4)
        Of the frames in the world, unit quaternions x, y, z, w.
    linear_velocity : ndarray (n, 3)
        Of the frame origins, world axes, m/s.
    angular_velocity : ndarray (n, 3)
        Of the frames, body axes, rad/s.
    rotor_velocity : ndarray (n, rotors)
        Joint velocities as the engine has them, rad/s.
    rotor_angle : ndarray (n, rotors)
        Joint angles in (-pi, pi], rad.
    """

    position: np.ndarray
    orientation: np.ndarray
    linear_velocity: np.ndarray
    angular_velocity: np.ndarray
    rotor_velocity: np.ndarray
    rotor_angle: np.ndarray

    @classmethod
    def of(cls, rows: np.ndarray) -> BatchState:
        """Name the columns of rows as `BatchSimulation.read_state` writes them."""
        rotors = (rows.shape[1] - 13) // 2
        ends = np.cumsum([3, 4, 3, 3, rotors])
        return cls(*np.split(rows, ends, axis=1))


class BatchSimulation(_core.Batch):
    """Many vehicles of one model, each in a world of its own, stepped together.

    Each moves, to the last bit, as a `Simulation` of it does, however many others and threads there
    are. In the engines "eigen" and "gazebo11" several vehicles share each instruction, as long as
    motors and force laws are all that acts; others, and those in "ode", are stepped one by one.

    Parameters
    ----------
    model, engine, world, dt, xacro_args, ignore
        As of `Simulation`; the engine is "eigen" unless another is named.
    n : int
        Vehicles.
    parameters : mapping of str to value or array (n,), optional
        As of `Simulation`; an array has one for each vehicle.
    spawn : array_like (n, 6), (n, 3), (6,) or (3,)
        x, y, z (m), and roll, pitch, yaw (rad), of each vehicle or of all.
    seed : int or array_like (n,)
        Of the noise of each vehicle; a number is that of the first, the next has the next.
    threads : int, optional
        That step; None: one for each processor.

    Attributes
    ----------
    time : ndarray (n,)
        Of each vehicle, s.
    dt : float
        Length of a step, s.
    command_width : int
        Numbers of a vehicle's command.

    Raises
    ------
    InputError
        The model, world or an argument is at fault; the message carries FILE:LINE.

    Warns
    -----
    QuadcoreWarning
        What was said of the first vehicle as it was made; `warnings(i)` has what was said of any.
    """

    def __init__(
        self,
        model: Union[str, Path, _core.Model] = "quadrotor",
        n: int = 1,
        engine: str = "eigen",
        parameters: Optional[Mapping[str, Union[Value, np.ndarray]]] = None,
        spawn: npt.ArrayLike = (0, 0, 10),
        seed: Union[int, npt.ArrayLike] = 0,
        threads: Optional[int] = None,
        world: Union[str, Path, _core.World, None] = None,
        dt: Optional[float] = None,
        xacro_args: Optional[Mapping[str, object]] = None,
        ignore: Sequence[str] = (),
    ) -> None:
        self.n = whole(n, "n")
        if self.n < 1:
            raise InputError("n is 0; give the number of vehicles")
        given = parameters or {}
        arguments, others = without_xacro(given, xacro_args)
        model, self.world = read_both(model, world, arguments, ignore)
        check_names(model, given)
        built: List[Tuple[_core.Model, Dict[str, str]]] = []
        before: Dict[str, str] = {}
        for values in self._of_each(others):
            built.append(built[-1] if built and values == before else with_links(model, values))
            before = values
        super().__init__(
            [model for model, _ in built],
            self.world,
            engine,
            dt,
            [tags for _, tags in built],
            self._poses(spawn),
            self._seeds(seed),
            0 if threads is None else whole(threads, "threads"),
        )
        for warning in self.warnings(0):
            warn(warning, QuadcoreWarning, stacklevel=2)

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
            `out` is no such array of float64, row behind row.
        """
        shape = (self.n, self.state_width)
        if out is None:
            out = np.empty(shape)
        is_fit = isinstance(out, np.ndarray) and out.dtype == np.float64 and out.shape == shape
        if not (is_fit and out.flags.c_contiguous and out.flags.writeable):
            raise InputError(f"out is no writable, contiguous array of {shape} float64; give one")
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
        given = np.ascontiguousarray(rows, dtype=float)
        if given.shape != (self.n, self.state_width):
            raise InputError(
                f"states are an array of shape {given.shape}; give {(self.n, self.state_width)}"
            )
        self._take_state(given)

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
        super().step(commands, whole(steps, "steps"))

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
        """
        chosen = np.ones(self.n, bool) if mask is None else np.asarray(mask)
        if chosen.shape != (self.n,) or chosen.dtype != bool:
            raise InputError(f"mask is no array of {self.n} booleans; give one")
        super().reset(chosen, None if seed is None else self._seeds(seed))

    def __repr__(self) -> str:
        failed = sum(map(bool, self.failures))
        return f"<BatchSimulation of {self.n} vehicles, {failed} failed, steps of {self.dt:g} s>"

    def _of_each(self, parameters: Mapping[str, Any]) -> List[Dict[str, str]]:
        """Write out the parameters of each vehicle."""
        common, own = {}, {}
        for key, value in parameters.items():
            if isinstance(value, np.ndarray) and value.ndim > 0:
                if len(value) != self.n:
                    raise InputError(
                        f"set {key}: {len(value)} values for {self.n} vehicles; give one for each, "
                        "or one number"
                    )
                own[key] = value
            else:
                common[key] = text_of(value)
        return [
            {**common, **{key: text_of(values[i]) for key, values in own.items()}}
            for i in range(self.n)
        ]

    def _poses(self, spawn: npt.ArrayLike) -> np.ndarray:
        try:
            given = np.atleast_2d(np.asarray(spawn, dtype=float))
        except (TypeError, ValueError):
            given = np.empty((0, 0))
        if given.shape not in {(rows, width) for rows in (1, self.n) for width in (3, 6)}:
            raise InputError(
                f"spawn holds no poses of {self.n} vehicles; give x, y, z[, roll, pitch, yaw] in m "
                "and rad, for each or once for all"
            )
        poses = np.zeros((self.n, 6))
        poses[:, : given.shape[1]] = given
        return poses

    def _seeds(self, seed: Union[int, npt.ArrayLike]) -> np.ndarray:
        if isinstance(seed, (int, np.integer)):
            first = whole(seed)
            return np.array([(first + i) % 2**64 for i in range(self.n)], np.uint64)
        seeds = np.asarray(seed)
        if seeds.shape != (self.n,):
            raise InputError(f"seed holds no {self.n} whole numbers; give one for each, or one")
        if seeds.dtype == np.uint64:
            return seeds
        return np.array([whole(number) for number in seeds], np.uint64)
