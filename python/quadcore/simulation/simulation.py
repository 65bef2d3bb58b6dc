"""The simulation as Python drives it."""

from __future__ import annotations

from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Union

import numpy as np

from .. import _core
from ..control import references
from ..control.built_in import BuiltInController
from ..control.controller import ControllerLike
from ..control.keywords import ReferenceName
from ..control.references import ReferenceLike
from ..model.description import list_of_names, read_both
from ..model.overrides import check_names, with_links, without_xacro
from ..support.arguments import PROGRESS, check, or_none
from ..support.rotation import roll_pitch_yaw
from ..support.values import SPAWN, Number, Value, pose, text_of, whole
from ..support.warning import warn
from .controller_pilot import Guided
from .engines import ENGINE, EngineName, added_engine, check_engine_and_step
from .flight import Progress, Rows, columns_of, fly
from .log import Log
from .state import LiveState

if TYPE_CHECKING:
    import numpy.typing as npt


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
    parameters : mapping of str to number, str, bool, path or sequence of those, optional
        "PLUGIN.TAG" -> value; wins over the URDF. So do "LINK.mass", "LINK.ixx" ... "LINK.izz" and
        "xacro.ARG", an argument of a xacro model.
    xacro_args : mapping of str to value, optional
        Arguments of a xacro model.
    spawn : sequence of 3 or 6 numbers
        x, y, z (m) and roll, pitch, yaw (rad) of the frame link in the world.
    ignore : sequence of str
        What to leave out of model and world because quadcore does not know it: names or file names
        of plugins, names of elements, uris or names of a world's models. `ignored` keeps it.

    Attributes
    ----------
    world : World
        As it was read.
    command_topic : str
        That `command` publishes on.

    Raises
    ------
    InputError
        The model, world or an argument is at fault; the message carries ``FILE:LINE``.

    Warns
    -----
    QuadcoreWarning
        What is allowed but was perhaps not meant; `warnings` keeps it.
    """

    def __init__(
        self,
        model: Union[str, Path, _core.Model] = "quadrotor",
        engine: EngineName = ENGINE,
        world: Union[str, Path, _core.World, None] = None,
        dt: Optional[float] = None,
        seed: int = 0,
        parameters: Optional[Mapping[str, Value]] = None,
        xacro_args: Optional[Mapping[str, object]] = None,
        spawn: Sequence[Number] = SPAWN,
        ignore: Sequence[str] = (),
    ) -> None:
        engine, dt = check_engine_and_step(engine, dt)
        arguments, others = without_xacro(parameters, xacro_args)
        model, self.world = read_both(model, world, arguments, ignore)
        check_names(model, parameters or {})
        model, tags = with_links(model, {key: text_of(value) for key, value in others.items()})
        super().__init__(
            model=model,
            world=self.world,
            engine=engine,
            dt=dt,
            seed=whole(seed),
            parameters=tags,
            spawn=pose(spawn),
        )
        self._live = LiveState(self)
        for warning in self.warnings:
            warn(warning)

    if TYPE_CHECKING:

        @property
        def state(self) -> LiveState:
            """Declare what type checkers read."""

    else:
        # attrgetter, not a function: reading the state is part of every step of a Python loop.
        state = property(
            attrgetter("_live"),
            doc="The state now, as live read-only views; `state.copy()` is free.",
        )

    @property
    def hover_speed(self) -> np.ndarray:
        """Commands with which the vehicle hovers level, signed, rad/s; shape (n,).

        Neighbours around the vehicle turn against each other; faults of rotors are not
        heeded. Asks the force laws anew, which takes some milliseconds. Raises InputError if
        nothing drives the rotors or they cannot hold it.
        """
        return np.asarray(_core.hover_commands(self, []))

    def restore(  # type: ignore[override]  # pybind11 2.4 has no keyword-only arguments
        self, snapshot: _core.Snapshot, *, allow: Sequence[str] = ()
    ) -> None:
        """Go back to a snapshot, bit for bit, its seed included.

        Parameters
        ----------
        snapshot : Snapshot
            Of this simulation, or of one that is alike, in whatever process.
        allow : sequence of str
            What may differ on purpose: "world", "parameters". This simulation's hold.

        Raises
        ------
        InputError
            It was taken from another simulation, with what differs, or is damaged; nothing has
            changed then.
        """
        super().restore(snapshot, list_of_names("allow", allow))

    def reset(self, seed: Optional[int] = None) -> None:
        """Go back to the moment of construction, bit for bit.

        Parameters
        ----------
        seed : int, optional
            As if the simulation had been made with it; None keeps the one it has.
        """
        super().reset(None if seed is None else whole(seed))

    def publish(self, topic: str, values: Union[Mapping[str, float], npt.ArrayLike]) -> None:
        """Publish a message on a topic that no plugin writes, for the plugins that take it.

        Parameters
        ----------
        topic : str
            One of `topics`.
        values : mapping of str to number, or sequence of numbers
            A number for each field of the topic, by name or in their order.

        Raises
        ------
        InputError
            No such topic, a plugin that writes it, other fields than the topic's, a number that is
            not finite, or the command's topic while a run flies; nothing was changed.
        """
        if isinstance(values, Mapping):
            known = self.topics.get(topic)
            values = _in_order(topic, values, known.fields) if known else []
        super().publish(topic, values)

    def run(
        self,
        duration: float,
        commands: Union[np.ndarray, str, Path, None] = None,
        log_every: int = 1,
        progress: Optional[Progress] = None,
        wrenches: bool = False,
        topics: Sequence[str] = (),
        *,
        controller: Optional[ControllerLike] = None,
        reference: Union[ReferenceLike, ReferenceName, None] = None,
        on_reference: bool = False,
    ) -> Log:
        """Fly for a while and log it.

        Parameters
        ----------
        duration : float
            s; the last step is the last that ends within it.
        commands : ndarray (rows, 1 + n), or path of a .csv, .mat or .bag file, optional
            Open loop: columns t, w1..wn, signed rad/s; each row holds until the next. None keeps
            the present command.
        log_every : int
            Steps between logged rows.
        progress : callable, optional
            Called as progress(steps_done, steps_total) every few hundredths of a second.
        wrenches : bool
            Whether to log them, too, which takes three times the memory: `Log.wrenches`.
        topics : sequence of str
            Names of topics to log, too: `Log.topics`.
        controller : name, object or callable, optional
            Closed loop, instead of `commands`: the name of one of `quadcore.controllers`, with
            the gains that are shipped for the vehicle, if any, or what is called as
            controller(t, state, reference) at its rate and returns n rotor speeds in rad/s; see
            `Controller`.
        reference : name or callable, optional
            Where the controller is to fly: one of `quadcore.references`, or what is called as
            reference(t), t being the time of the simulation in s, and depends on that alone: it is
            asked for the rows of the log, too, which has it as topic ``reference`` (x, y, z, yaw),
            and the position less its own as topic ``error`` (x, y, z).
        on_reference : bool
            Whether the vehicle is first put onto the reference, in the full state of one that
            follows it (`quadcore.references.start`); else the flight begins in the present state.

        Returns
        -------
        Log
            Begins with the present state.

        Raises
        ------
        InputError
            An argument is at fault; nothing was flown. Or what is called back, such as the
            controller, would move the vehicle or command it, which ends the flight.
        FlightError
            The flight failed, or the controller gave no command, be it at its first call. Its
            attribute `log` is the log so far, as it is of whatever else ends a run: the
            KeyboardInterrupt, the MemoryError when a log has no more room, the error that a
            controller raises.
        """
        if commands is not None and controller is not None:
            raise _core.InputError("a flight takes commands or a controller; give one of them")
        if reference is not None and controller is None:
            raise _core.InputError("a reference needs a controller that follows it; give one")
        if on_reference:
            reference = self._put_on(controller, reference)
        names = list_of_names("topics", topics)
        check({"progress": progress}, {"progress": or_none(PROGRESS)})
        pilot = None if controller is None else Guided(controller, self, reference)
        rows = Rows(self, columns_of(self, names, pilot))
        try:
            fly(self, duration, commands, log_every, rows.receive, wrenches, progress, pilot, names)
        except (Exception, KeyboardInterrupt) as error:
            error.log = rows.log()  # type: ignore[union-attr]
            raise
        return rows.log()

    def __repr__(self) -> str:
        return (
            f"<Simulation of '{self.model.name}', {self.engine}, t = {self.time:g} s, "
            f"steps of {self.dt:g} s>"
        )

    def _repr_html_(self) -> str:
        from html import escape  # these are slow to import

        from ..report.html_table import html_table

        state = self.state
        rows = [
            ("vehicle", f"{self.mass:.6g} kg, {self.rotor_count} rotors"),
            ("engine", f"{self.engine}, steps of {self.dt:g} s"),
            ("plugins", ", ".join(plugin.name for plugin in self.plugins)),
            ("time", f"{self.time:g} s"),
            ("position", f"{_in_words(state.position)} m"),
            ("roll, pitch, yaw", f"{_in_words(np.degrees(roll_pitch_yaw(state.orientation)))} deg"),
            ("velocity", f"{_in_words(state.linear_velocity)} m/s"),
            ("rotors", f"{_in_words(state.rotor_velocity)} rad/s"),
        ]
        return f"<b>{escape(self.model.name)}</b>" + html_table((), rows)

    def _put_on(self, controller: Any, reference: Any) -> Any:
        """Put the vehicle onto a reference, and give that."""
        if reference is None:
            raise _core.InputError("on_reference needs a reference to begin on; give one")
        if isinstance(reference, str):
            reference = references.parse(reference)
        spins = controller.spins if isinstance(controller, BuiltInController) else ()
        with _core.Run(self):
            start = references.start(self, reference, spins)
        self.set_state(start)
        return reference


def make_simulation(engine: str, **options: Any) -> Simulation:
    """Make a simulation in any engine of `list_engines`; `options` are those of `Simulation`."""
    added = added_engine(engine)
    if added is None:
        return Simulation(engine=engine, **options)  # type: ignore[arg-type]
    return added.make(**options)


def _in_words(values: np.ndarray) -> str:
    return ", ".join(f"{round(float(value), 4) + 0.0:g}" for value in values)


def _in_order(topic: str, values: Mapping[str, float], fields: Sequence[str]) -> list[float]:
    if set(values) != set(fields):
        raise _core.InputError(
            f"publish: topic '{topic}': fields {', '.join(map(str, values)) or 'none'}; "
            f"give {', '.join(fields)}"
        )
    return [values[field] for field in fields]
