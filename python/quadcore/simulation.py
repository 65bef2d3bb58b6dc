"""The simulation as Python drives it."""

from __future__ import annotations

from operator import attrgetter
from pathlib import Path
from typing import Mapping, Optional, Sequence, Union
from warnings import warn

import numpy as np

from . import _core
from .description import load_description, load_world
from .flight import Progress, Rows, fly
from .log import Log
from .state import LiveState
from .warning import QuadcoreWarning

Number = Union[float, str]
Value = Union[float, str, bool, Sequence[str]]


class Simulation(_core.Simulation):
    """One vehicle in one world, stepped from outside.

    Parameters
    ----------
    model : str, path or Model
        URDF or xacro file, the name of a shipped model ("quadrotor"), or a model already read.
    engine : str
        "gazebo11" (the default: the model as published), "ode" or "eigen"; `quadcore.engines()`
        says what each is.
    world : str, path or World, optional
        World file, the name of a shipped one, or a world already read; None is empty.world.
    dt : float, optional
        Step in s; None takes the world's max_step_size.
    seed : int
        Of all noise. The same seed gives the same bytes.
    parameters : mapping of str to number, str or bool, optional
        "PLUGIN.TAG" -> value; wins over the URDF.
    xacro_args : mapping of str to value, optional
        Arguments of a xacro model.
    spawn : sequence of 3 or 6 numbers
        x, y, z (m) and roll, pitch, yaw (rad) of the frame link in the world.
    ignore : sequence of str
        What to leave out of model and world because quadcore does not know it: names or file names
        of plugins, names of elements, uris or names of a world's models. `ignored` keeps it.

    Raises
    ------
    InputError
        The model, world or an argument is at fault; the message carries FILE:LINE.

    Warns
    -----
    QuadcoreWarning
        What is allowed but was perhaps not meant; `warnings` keeps it.
    """

    def __init__(
        self,
        model: Union[str, Path, _core.Model] = "quadrotor",
        engine: str = "gazebo11",
        world: Union[str, Path, _core.World, None] = None,
        dt: Optional[float] = None,
        seed: int = 0,
        parameters: Optional[Mapping[str, Value]] = None,
        xacro_args: Optional[Mapping[str, object]] = None,
        spawn: Sequence[Number] = (0, 0, 10),
        ignore: Sequence[str] = (),
    ) -> None:
        names = names_to_ignore(ignore)
        if not isinstance(model, _core.Model):
            arguments = {name: str(value) for name, value in (xacro_args or {}).items()}
            model = _core.read_model(load_description(str(model), arguments), names)
        elif xacro_args:
            raise _core.InputError("xacro_args: the model is read already; give them to its reader")
        if not isinstance(world, _core.World):
            world = _core.read_world(load_world(None if world is None else str(world)), names)
        _core.check_ignored(names, [model.passed_over, world.passed_over])
        self.world = world
        super().__init__(
            model=model,
            world=self.world,
            engine=engine,
            dt=dt,
            seed=_whole(seed),
            parameters={key: text_of(value) for key, value in (parameters or {}).items()},
            spawn=_pose(spawn),
        )
        self._live = LiveState(self)
        for warning in self.warnings:
            warn(warning, QuadcoreWarning, stacklevel=2)

    # attrgetter, not a function: reading the state is part of every step of a Python loop.
    state: LiveState = property(  # type: ignore[assignment]
        attrgetter("_live"),
        doc="The state now, as live read-only views; `state.copy()` is free.",
    )

    def reset(self, seed: Optional[int] = None) -> None:
        """Go back to the moment of construction, bit for bit.

        Parameters
        ----------
        seed : int, optional
            As if the simulation had been made with it; None keeps the one it has.
        """
        super().reset(None if seed is None else _whole(seed))

    def run(
        self,
        duration: float,
        commands: Union[np.ndarray, str, Path, None] = None,
        log_every: int = 1,
        progress: Optional[Progress] = None,
        wrenches: bool = True,
    ) -> Log:
        """Fly for a while and log it.

        Parameters
        ----------
        duration : float
            s; the last step is the last that ends within it.
        commands : ndarray (rows, 1 + n), or path of a .csv or .mat file, optional
            Open loop: columns t, w1..wn, signed rad/s; each row holds until the next. None keeps
            the present command.
        log_every : int
            Steps between logged rows.
        progress : callable, optional
            Called as progress(steps_done, steps_total) every few hundredths of a second.
        wrenches : bool
            Whether to log them, which takes most of the memory of a log.

        Returns
        -------
        Log
            Begins with the present state.

        Raises
        ------
        InputError
            An argument is at fault; nothing was flown.
        FlightError
            The flight failed. Its attribute `log` is the log so far, as it is of the
            KeyboardInterrupt that ends a run, and of the MemoryError when a log has no more room.
        """
        rows = Rows(self)
        try:
            fly(self, duration, commands, log_every, rows.receive, wrenches, progress)
        except (_core.QuadcoreError, KeyboardInterrupt, MemoryError) as error:
            error.log = rows.log()  # type: ignore[union-attr]
            raise
        return rows.log()


def names_to_ignore(ignore: Sequence[str]) -> list[str]:
    """Check names given as `ignore`."""
    if isinstance(ignore, str) or not all(isinstance(name, str) for name in ignore):
        raise _core.InputError(f"ignore is {ignore!r}; give a list of names")
    return list(ignore)


def _whole(seed: object) -> int:
    if not isinstance(seed, (int, np.integer)) or not 0 <= seed < 2**64:
        raise _core.InputError(f"seed is {seed!r}; give a whole number from 0 to 2^64 - 1")
    return int(seed)


def text_of(value: Union[Value, Path]) -> str:
    """Write a parameter's value as a URDF would."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return " ".join(value)
    return str(value)


def _pose(spawn: Sequence[Number]) -> Sequence[float]:
    try:
        pose = [_number(value) for value in spawn]
    except (TypeError, ValueError):
        pose = []
    if len(pose) not in (3, 6):
        raise _core.InputError(f"spawn is {spawn!r}; give x, y, z[, roll, pitch, yaw] in m and rad")
    return pose + [0.0] * (6 - len(pose))


def _number(value: Number) -> float:
    if not isinstance(value, str):
        return float(value)
    number = _core.parse_number(value)
    if number is None:
        raise ValueError(value)
    return number
