"""Base class of bridges to autopilots."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any, Callable, List, Mapping, Optional, Sequence, TypeVar

import numpy as np

from .._core import FlightError, InputError
from ..control.vehicle import Vehicle, unwrap
from .motor_curve import CurveLike, MotorCurve
from .readings import Readings, Sensors, read_held
from .rotor_map import Channel, Place, check_reaction, map_channels
from .session import Link, Recorder, Session

_Autopilot = TypeVar("_Autopilot", bound="Autopilot")

MAX_HOLD = 600.0
"""Maximum duration of the phase before the flight, s."""


class Autopilot:
    """Controller that calls an external program in lockstep.

    A bridge to another stack defines `layout`, `start`, `tick`, `pilot` and `close`. A flight calls
    `start` first. Then it calls `pilot` and `tick` in every tick, both in the phase before the
    flight and in flight. It calls `close` last. In a ``with`` statement, `close` is also called at
    the end of the block.

    In the phase before the flight, the vehicle is held in its initial pose, and t counts from
    ``-hold`` to 0. Autopilots need this time to start, calibrate and arm. The log does not contain
    this phase, and the simulation does not advance.

    Parameters
    ----------
    motor_curve : {"speed", "thrust"} or sequence of pairs, default "speed"
        Rotor speed as a function of the output; see `MotorCurve`.
    rotors : sequence of str, default ()
        Joints of the rotors in the order of the outputs. Default: assigned by position and spin.
    imu : str, default ""
        Topic of the IMU. Default: ideal readings from the state.
    hold : float, default 0
        Duration of the phase before the flight, s, at most `MAX_HOLD`.
    where : mapping of str to str, default {}
        Locations of the values in a stack file, for messages: ``FILE:LINE:`` by name.

    Attributes
    ----------
    rate : float
        Ticks per simulated second, 1/s.
    fixed_rate : bool
        True, because the program measures time by counting ticks.
    channels : sequence of Channel
        Outputs with their rotors, available after the first reset.
    curve : MotorCurve
        Motor curve, available after the first reset.
    period : float
        Time between ticks, s, available after the first reset.
    record : path, optional
        File for the recorded session, which is written at the end of the flight.
    session : Session, optional
        Recorded session that answers instead of the program.
    words : sequence of str
        Command line of the flight, which a recorded session contains.
    log : dict of str to float
        Outputs and other values of the bridge at each tick. The log of a flight contains them under
        the topic ``controller``.
    summary : str
        Description of the answers in the last flight, with their durations.
    program_summary : str
        Name and SHA-256 of the program of the last flight.
    """

    pilot_rate = 100.0
    """Calls of `pilot` per simulated second, 1/s; its result holds until the next call."""

    layout: Sequence[Place] = ()
    """Places of the motors in the order of the outputs."""

    rate: float = 1000.0
    fixed_rate = True
    delay: float = 0.0
    summary = ""
    program_summary = ""

    def __init__(
        self,
        *,
        motor_curve: CurveLike = "speed",
        rotors: Sequence[str] = (),
        imu: str = "",
        hold: float = 0.0,
        where: Optional[Mapping[str, str]] = None,
    ) -> None:
        self.motor_curve, self.rotors, self.imu = motor_curve, tuple(rotors), imu
        self.hold = hold
        self._where = where or {}
        if not 0 <= hold <= MAX_HOLD:
            raise InputError(
                f"{self._where.get('hold', '')}hold is {hold:g}. Use 0 to {MAX_HOLD:g} s."
            )
        self.channels: List[Channel] = []
        self.record: Optional[Path] = None
        self.session: Optional[Session] = None
        self.words: Sequence[str] = ()
        self._recorder: Optional[Recorder] = None
        self._elapsed = self._began = 0.0  # s; simulated and wall-clock time
        self._names = [f"output{i}" for i in range(1, len(self.layout) + 1)]
        self.log = dict.fromkeys(self._names, math.nan)

    def __enter__(self: _Autopilot) -> _Autopilot:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def start(self, vehicle: Vehicle) -> None:
        """Start the program, and connect to it.

        Parameters
        ----------
        vehicle : Vehicle
            Vehicle to control.
        """
        raise NotImplementedError

    def tick(self, readings: Readings, sticks: Any) -> Sequence[float]:
        """Send readings and sticks, wait for the answer, and return the outputs from 0 to 1.

        Parameters
        ----------
        readings : Readings
            Readings of the sensors.
        sticks : object
            Result of `pilot`.
        """
        raise NotImplementedError

    def pilot(self, t: float, state: Any, reference: Any) -> Any:
        """Return the input of the pilot to the autopilot, such as the stick positions.

        Parameters
        ----------
        t : float
            Time, s; negative before the flight.
        state : Odometry or None
            Latest odometry; None before the flight.
        reference : Reference or None
            Value of the reference; None before the flight, or if there is no reference.
        """
        raise NotImplementedError

    def ask(self, tick: Callable[[], object]) -> Any:
        """Open a connection for questions, which `check_autopilot` needs; see `bench.Questions`.

        Parameters
        ----------
        tick : callable
            Function that lets the autopilot compute one period, for stacks that answer in their
            main loop.
        """
        raise InputError("This autopilot answers no questions. Check it in a flight.")

    @property
    def pilot_every(self) -> int:
        """Number of ticks between calls of `pilot`, available after the first reset."""
        return max(1, round(1 / (self.pilot_rate * self.period)))

    def record_link(self, link: Link, about: Mapping[str, Any]) -> Link:
        """Return the link for the flight; it records the session if `record` is set.

        Parameters
        ----------
        link : Link
            Link to the program.
        about : mapping
            Description of the flight; see `describe_session`.
        """
        self.program_summary = f"{about['program']}, SHA-256 {about['sha256'][:12]}"
        if self.record is None:
            return link
        self._recorder = Recorder(link, self.record, {**about, "words": list(self.words)})
        return self._recorder

    def close(self) -> None:
        """Write the recorded session; a subclass also ends the program.

        quadcore calls this method after every flight.
        """
        if self._recorder is not None:
            self._recorder.write()
            self._recorder = None

    def reset(self, simulation: Any) -> None:
        """Start the autopilot, and hold the vehicle until the autopilot is ready."""
        simulation = unwrap(simulation)
        self.prepare(simulation)
        self.start(simulation.vehicle)
        self._sensors = Sensors(simulation, self.imu)
        state = simulation.state.copy()
        held = read_held(0.0, state.orientation, self._sensors.gravity, state.position, np.zeros(3))
        self._ticks = 0
        held_ticks = 0 if self.session is not None else round(self.hold / self.period)
        for k in range(held_ticks, 0, -1):
            self._ask(held._replace(time=-k * self.period), None, None)
        self._begin, self._ticks = simulation.time, 0
        self._elapsed, self._began = 0.0, time.perf_counter()

    def prepare(self, simulation: Any) -> None:
        """Assign the channels to the rotors of a simulation, and read the motor curve.

        Raises
        ------
        InputError
            If the vehicle does not match the autopilot.
        """
        by_command = sorted(
            (rotor for rotor in simulation.rotors if rotor.command_index is not None),
            key=lambda rotor: int(rotor.command_index),
        )
        check_reaction(by_command, simulation.model.name)
        self.channels = map_channels(self.layout, by_command, self.rotors)
        self.period = max(1 / self.rate, float(simulation.dt))
        driven = [channel.rotor for channel in self.channels]
        self.curve = MotorCurve(self.motor_curve, np.array([rotor.max_speed for rotor in driven]))
        self._order = np.array([rotor.command_index for rotor in driven])
        self._signs = np.sign(simulation.hover_speed)[self._order]

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Return the rotor speeds that the autopilot commands, rad/s."""
        self._elapsed = t - self._begin
        outputs = self._ask(self._sensors.read(self._elapsed), state, reference)
        speeds = np.empty(len(self._order))
        speeds[self._order] = self._signs * self.curve.find_speeds(outputs)
        return speeds

    def _ask(self, readings: Readings, state: Any, reference: Any) -> np.ndarray:
        if self._ticks % self.pilot_every == 0:
            self._sticks_held = self.pilot(readings.time, state, reference)
        self._ticks += 1
        outputs = [float(output) for output in self.tick(readings, self._sticks_held)]
        if len(outputs) != len(self.channels) or not all(map(math.isfinite, outputs)):
            raise self.fail(readings.time, f"the autopilot answered with outputs {outputs}")
        self.log.update(zip(self._names, outputs))
        return np.array(outputs)

    def describe_speed(self) -> str:
        """Return the speed of the flight relative to real time, without the phase before it."""
        if self._elapsed == 0:
            return "no flight"
        return f"{self._elapsed / (time.perf_counter() - self._began):.1f} times real time"

    def fail(self, t: float, reason: str) -> FlightError:
        """Make the error that ends a flight at a time (s) with a reason."""
        when = f"at t = {t:f} s" if t >= 0 else f"{-t:.3f} s before the flight"
        error = FlightError(f"the flight failed {when}: {reason}")
        error.time = max(t, 0.0)
        return error
