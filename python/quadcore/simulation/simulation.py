"""The public class `Simulation`."""

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
from ..control.vehicle import Vehicle
from ..model.description import check_names_argument, read_both
from ..model.overrides import apply_link_values, check_names, split_xacro_arguments
from ..support.arguments import PROGRESS, check, or_none, shorten
from ..support.rotation import to_roll_pitch_yaw
from ..support.values import SPAWN, Number, Value, check_pose, check_whole, format_value
from ..support.warning import warn
from .controller_pilot import make_pilot
from .engines import ENGINE, EngineName, check_engine_and_step, find_added_engine
from .flight import Progress, check_run, fly, list_columns
from .log import Log
from .rows import Rows
from .state import LiveState, State

if TYPE_CHECKING:
    import numpy.typing as npt


class Simulation(_core.Simulation):
    """Simulate one vehicle in one world.

    Parameters
    ----------
    model : str, path or Model, default "quadrotor"
        URDF or xacro file, name of a built-in model, or a model returned by `read_model`.
    engine : {"gazebo11", "ode", "eigen"}, default "gazebo11"
        Physics engine; `quadcore.engines()` describes each engine.
    world : str, path or World, optional
        World file, name of a built-in world, or a world returned by `read_world`. Default:
        empty.world.
    dt : float, optional
        Step, s. Default: max_step_size of the world.
    seed : int, default 0
        Seed of all noise. Simulations with the same seed are bit-identical.
    parameters : mapping of str to number, str, bool, path or sequence of those, optional
        Values by "PLUGIN.TAG", which override the URDF. "LINK.mass", "LINK.ixx" ... "LINK.izz",
        "LINK.com_x" ... "LINK.com_z" and "xacro.ARG" are also accepted.
    xacro_args : mapping of str to value, optional
        Arguments of a xacro model.
    spawn : sequence of 3 or 6 numbers, default (0, 0, 10)
        x, y, z (m) and roll, pitch, yaw (rad) of the frame link in the world.
    ignore : sequence of str, default ()
        Unknown parts of the model and the world to ignore: names or file names of plugins, names of
        elements, URIs or names of models in the world. The attribute `ignored` lists them.

    Attributes
    ----------
    world : World
        World in which the vehicle is simulated.
    command_topic : str
        Topic on which `command` publishes.

    Raises
    ------
    InputError
        If the model, the world or an argument is invalid. The message begins with ``FILE:LINE`` if
        a file causes the error.

    Warns
    -----
    QuadcoreWarning
        If valid input is suspicious; `warnings` lists the messages.
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
        arguments, others = split_xacro_arguments(parameters, xacro_args)
        model, self.world = read_both(model, world, arguments, ignore)
        check_names(model, parameters or {})
        model, tags = apply_link_values(
            model, {key: format_value(value) for key, value in others.items()}
        )
        super().__init__(
            model=model,
            world=self.world,
            engine=engine,
            dt=dt,
            seed=check_whole(seed),
            parameters=tags,
            spawn=check_pose(spawn),
        )
        self._live = LiveState(self)
        for warning in self.warnings:
            warn(warning)

    if TYPE_CHECKING:

        @property
        def state(self) -> LiveState:
            """Declare the type for type checkers."""

    else:
        # attrgetter is faster than a function, and every step of a Python loop reads the state.
        state = property(
            attrgetter("_live"),
            doc="Current state, as read-only views that change as the simulation steps.",
        )

    @property
    def hover_speed(self) -> np.ndarray:
        """Signed commands at which the vehicle hovers level, rad/s; shape (n,).

        Neighbouring rotors turn in opposite directions. Rotor faults are not considered. The first
        access evaluates the force models, which takes some milliseconds.

        Raises
        ------
        InputError
            If no plugin drives the rotors, or the rotors cannot lift the vehicle.
        """
        return np.asarray(_core.hover_commands(self, []))

    @property
    def vehicle(self) -> Vehicle:
        """View of the vehicle as arrays, as controllers receive it in studies."""
        return Vehicle(self)

    def set_state(self, state: Union[State, LiveState]) -> None:
        """Move the vehicle into a state; what plugins remember stays.

        Parameters
        ----------
        state : State
            State, as `state.copy()` returns it, or an object with the same members.

        Raises
        ------
        InputError
            If members have other sizes, a number is not finite, a quaternion has no direction, or
            the time is not that of the vehicle's fleet. Nothing changes.
        """
        time = getattr(state, "time", self.time)
        if self.in_fleet and time != self.time:
            raise _core.InputError(
                f"set_state(): the state's time is {shorten(time)}, but its fleet is at "
                f"{self.time:g} s. Set it to the time of the vehicle."
            )
        super().set_state(state)

    def restore(  # type: ignore[override]  # pybind11 2.4 has no keyword-only arguments
        self, snapshot: _core.Snapshot, *, allow: Sequence[str] = ()
    ) -> None:
        """Restore a snapshot bit-identically, including the seed.

        Parameters
        ----------
        snapshot : Snapshot
            Snapshot of this simulation, or of an equal simulation in any process.
        allow : sequence of str, default ()
            Differences to accept: "world", "parameters". This simulation keeps its own values.

        Raises
        ------
        InputError
            If the snapshot belongs to a different simulation or is damaged. The simulation does not
            change in this case.
        """
        super().restore(snapshot, check_names_argument("allow", allow))

    def reset(self, seed: Optional[int] = None) -> None:
        """Return to the initial state, bit-identically.

        Parameters
        ----------
        seed : int, optional
            New seed of all noise. Default: the current seed.
        """
        super().reset(None if seed is None else check_whole(seed))

    def publish(self, topic: str, values: Union[Mapping[str, float], npt.ArrayLike]) -> None:
        """Publish a message to the plugins that read a topic.

        Parameters
        ----------
        topic : str
            Name of a topic that no plugin writes; see `topics`.
        values : mapping of str to number, or sequence of numbers
            One number for each field of the topic, by name or in the order of the fields.

        Raises
        ------
        InputError
            If the topic does not exist or a plugin writes it, if the fields are wrong, if a number
            is not finite, or if a running flight uses the topic. Nothing changes in this case.
        """
        if isinstance(values, Mapping):
            known = self.topics.get(topic)
            values = _order_fields(topic, values, known.fields) if known else []
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
        """Simulate for a duration, and log the states.

        Any exception that ends the run has the attribute `log`, which contains the rows so far.

        Parameters
        ----------
        duration : float
            Duration, s. Only steps that end within it are simulated.
        commands : ndarray (rows, 1 + n), or path of a .csv, .mat or .bag file, optional
            Open-loop commands with columns t, w1..wn: time (s) and signed rotor speeds (rad/s).
            Each row holds until the next one. Default: the current command.
        log_every : int, default 1
            Steps between logged rows.
        progress : callable, optional
            Function called as progress(steps_done, steps_total) every few hundredths of a second.
        wrenches : bool, default False
            Whether to log forces and torques in `Log.wrenches`, which triples the memory use.
        topics : sequence of str, default ()
            Names of topics to log in `Log.topics`.
        controller : name, object or callable, optional
            Controller, instead of `commands`. The name of a built-in controller selects its gains
            for the vehicle, or its default gains. Any other controller is called as controller(t,
            state, reference) and returns n rotor speeds (rad/s); see `Controller`.
            `quadcore.controllers.parse` reads names with parameters.
        reference : name or callable, optional
            Reference trajectory of the controller: the name of a built-in reference, a reference
            from `quadcore.references`, or a function reference(t) that depends only on the
            simulation time (s). The log contains the reference as topic ``reference`` (x, y, z,
            yaw) and the tracking error as topic ``error`` (x, y, z).
        on_reference : bool, default False
            Whether to start in the full state of a vehicle that follows the reference; see
            `quadcore.references.start`. Otherwise the flight starts in the current state.

        Returns
        -------
        Log
            Log of the states; its first row is the current state.

        Raises
        ------
        InputError
            If an argument is invalid; in this case nothing is simulated. Also if a callback, such
            as the controller, moves or commands the vehicle itself, which ends the flight.
        FlightError
            If the flight fails, or the controller returns an invalid command.
        """
        check_source(commands, controller, reference)
        check_start(on_reference, reference)
        names = check_names_argument("topics", topics)
        check({"progress": progress}, {"progress": or_none(PROGRESS)})
        pilot = None if controller is None else make_pilot(controller, self, reference)
        rows = Rows(self, list_columns(self, names, pilot))
        if on_reference:  # after all checks, as it moves the vehicle
            check_run(self, duration, log_every, wrenches)
            self.set_state(find_start(self, controller, reference))
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
        from html import escape  # slow to import

        from ..report.html_table import html_table

        state = self.state
        rows = [
            ("vehicle", f"{self.mass:.6g} kg, {self.rotor_count} rotors"),
            ("engine", f"{self.engine}, steps of {self.dt:g} s"),
            ("plugins", ", ".join(plugin.name for plugin in self.plugins)),
            ("time", f"{self.time:g} s"),
            ("position", f"{_format_values(state.position)} m"),
            (
                "roll, pitch, yaw",
                f"{_format_values(np.degrees(to_roll_pitch_yaw(state.orientation)))} deg",
            ),
            ("velocity", f"{_format_values(state.linear_velocity)} m/s"),
            ("rotors", f"{_format_values(state.rotor_velocity)} rad/s"),
        ]
        return f"<b>{escape(self.model.name)}</b>" + html_table((), rows)


def check_source(commands: object, controller: object, reference: object) -> None:
    """Raise `InputError` if commands, controller and reference of a flight are inconsistent."""
    if commands is not None and controller is not None:
        raise _core.InputError("a flight takes commands or a controller. Give one of them.")
    if reference is not None and controller is None:
        raise _core.InputError("a reference needs a controller that follows it. Give one.")


def check_start(on_reference: bool, *references: object) -> None:
    """Raise `InputError` if vehicles are to start on references, but none of them has one."""
    if on_reference and all(reference is None for reference in references):
        raise _core.InputError("on_reference needs a reference to begin on. Give one.")


def find_start(simulation: Simulation, controller: Any, reference: Any) -> State:
    """Return the state of a vehicle that follows a reference at the current time."""
    if isinstance(reference, str):
        reference = references.parse(reference)
    spins = controller.spins if isinstance(controller, BuiltInController) else ()
    with _core.Run(simulation):
        return references.start(simulation, reference, spins)


def make_simulation(engine: str, **options: Any) -> Simulation:
    """Make a simulation with any engine in `list_engines`; `options` are those of `Simulation`."""
    added = find_added_engine(engine)
    if added is None:
        return Simulation(engine=engine, **options)  # type: ignore[arg-type]
    return added.make(**options)


def _format_values(values: np.ndarray) -> str:
    return ", ".join(f"{round(float(value), 4) + 0.0:g}" for value in values)


def _order_fields(topic: str, values: Mapping[str, float], fields: Sequence[str]) -> list[float]:
    if set(values) != set(fields):
        raise _core.InputError(
            f"publish: topic '{topic}': fields {', '.join(map(str, values)) or 'none'}. "
            f"Give {', '.join(fields)}."
        )
    return [values[field] for field in fields]
