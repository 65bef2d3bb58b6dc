"""Bridge to Betaflight's SITL program."""

from __future__ import annotations

import math
import socket
from pathlib import Path
from typing import Any, Callable, Dict, Mapping, Optional, Sequence

import numpy as np

from ..._core import FlightError, InputError
from ...control.vehicle import Vehicle
from ...model.earth import find_location
from ..arming import ArmingWatch
from ..exchange import Exchange, check_free, find_free_port
from ..program import Program
from ..program_autopilot import ProgramAutopilot, fly_reference
from ..readings import Readings
from ..rotor_map import Place
from ..session import Link, describe_session
from ..sticks import StickPilot, Sticks
from ..strict import StrictExchange, describe_preload
from . import frames
from .msp import Msp
from .packets import RAW_PORT, Ports, pack_radio, pack_state, read_motors
from .parameters import COMMANDS, DEFAULTS, IDLE, MAX_ANGLE, MAX_YAW_RATE, write_parameters

_ARM = 1.5  # s; time of arming before the flight
_LOGGED = ("roll", "pitch", "yaw", "throttle", "arming_switch", "armed")
_STILL = (0.0, 0.0, 0.0, 0.0)

OwnPilot = Callable[[float, Any, Any], Sticks]


class Betaflight(ProgramAutopilot):
    """Controller that runs an unmodified Betaflight SITL program.

    Parameters
    ----------
    program : str
        Path of Betaflight's program.
    arguments : sequence of str, default ()
        Arguments of the program. In plain lockstep, ``{motors}``, ``{state}``, ``{radio}`` and
        ``{msp}`` are replaced by free ports. Without them, Betaflight uses its fixed ports, so only
        one flight can run at a time.
    parameters : mapping of str to str, default {}
        Parameters of Betaflight by name. They are set before the flight and read back.
    commands : sequence of str, default ()
        Additional lines for Betaflight's command line, such as ``aux 2 ...``.
    pilot : callable, optional
        Function ``pilot(t, state, reference)`` that returns `Sticks`. Default: a pilot that follows
        the reference in level mode.
    hold : float, default 8
        Duration of the phase before the flight, s. Betaflight arms 1.5 s before its end.
    lockstep : {"strict", "plain"}, default "strict"
        "strict" preloads a library that controls the clock of the program. Flights are then
        bit-identical, and several can run at once. "plain" exchanges packets with a program that
        has its own clock.
    motor_curve, rotors, imu, where
        As for `Autopilot`.
    """

    # motors 1 to 4 of the mixer QUADX, src/main/flight/mixer_init.c
    layout = (Place(-1, -1, -1), Place(1, -1, 1), Place(-1, 1, 1), Place(1, 1, -1))

    def __init__(
        self,
        program: str,
        arguments: Sequence[str] = (),
        parameters: Optional[Mapping[str, str]] = None,
        commands: Sequence[str] = (),
        pilot: Optional[OwnPilot] = None,
        hold: float = 8.0,
        lockstep: str = "strict",
        where: Optional[Mapping[str, str]] = None,
        **others: Any,
    ) -> None:
        parameters = {**DEFAULTS, **(parameters or {})}
        super().__init__([program, *arguments], parameters, hold, where, **others)
        self._lines = [*COMMANDS, *commands]
        self._own_pilot = pilot
        self._flight_exchange: Optional[Link] = None
        self.log.update(dict.fromkeys(_LOGGED, math.nan))
        self._pilot: Optional[StickPilot] = None
        self._is_strict = lockstep == "strict"
        if lockstep not in ("strict", "plain"):
            raise InputError(
                f"{self._where.get('lockstep', '')}lockstep is {lockstep}. Use strict or plain."
            )
        self._check_hold("Betaflight", _ARM)

    def start(self, vehicle: Vehicle) -> None:
        """Write the parameters, and start the program."""
        self._location = find_location(vehicle.world)
        self._pilot = StickPilot(
            vehicle,
            self.curve,
            1 / self.pilot_rate,
            math.radians(MAX_ANGLE),
            math.radians(MAX_YAW_RATE),
            IDLE,
        )
        if self.session is not None:
            self.ports = Ports()
            self.session.rewind()
            self._flight_exchange = self.session
        else:
            self._program = Program()
            (self._start_strict if self._is_strict else self._start_plain)(self._program)
            assert self._exchange is not None
            self._flight_exchange = self.record_link(self._exchange, self._describe_session())
        self._first: Optional[np.ndarray] = None
        self._sticks: Optional[Sticks] = None
        self._watch = ArmingWatch(self.fail, self._quote_messages)

    def tick(self, readings: Readings, sticks: Sticks) -> Sequence[float]:
        """Send the radio channels and the state, and wait for the outputs."""
        exchange = self._exchange if readings.time < 0 else self._flight_exchange
        assert exchange is not None
        if self._first is None:
            self._first = readings.position
        time = readings.time + self.hold

        def fail(reason: str) -> FlightError:
            return self.fail(readings.time, reason)

        if sticks is not self._sticks:
            self._sticks = sticks
            exchange.send(pack_radio(time, sticks), self.ports.radio, fail)
        fields = frames.convert_readings(readings, self._first, self._location)
        answer = exchange.ask(pack_state(time, fields), self.ports.state, fail)
        if not answer and self._is_strict and readings.time < 0:  # the program is still starting
            return _STILL
        outputs, problem = read_motors(answer)
        if outputs is None:
            raise fail(problem)
        is_armed = max(outputs) > IDLE / 2
        self.log.update(zip(_LOGGED, map(float, (*sticks, is_armed))))
        self._watch.check(readings.time, sticks.is_armed, is_armed)
        return [max(0.0, min(1.0, output)) for output in outputs]

    def pilot(self, t: float, state: Any, reference: Any) -> Sticks:
        """Arm before the flight, and follow the reference in flight."""
        assert self._pilot is not None
        if t < -_ARM:
            return Sticks()
        if t < 0:  # without throttle, the integrators of a tilted autopilot stay 0
            return Sticks(is_armed=True)
        if self._own_pilot is not None:
            return self._own_pilot(t, state, reference)
        return fly_reference(self._pilot, state, reference)

    def ask(self, tick: Callable[[], object]) -> Msp:
        """Connect to Betaflight's MSP port."""
        return Msp(self.ports.msp, tick)

    def _start_strict(self, program: Program) -> None:
        """Start the program with a clock that quadcore controls, and with its own ports."""
        self._exchange = exchange = StrictExchange(program, self.period)
        self.ports = _find_free_ports()
        replaced = {**dict(zip(Ports(), self.ports)), RAW_PORT: 0}
        self._write_parameters(self._command, describe_preload(replaced))
        program.start(self._command, *exchange.describe_environment(replaced, Ports().motors))
        exchange.begin(lambda reason: self.fail(-self.hold, reason))

    def _start_plain(self, program: Program) -> None:
        text = " ".join(self._command)
        if any(f"{{{name}}}" in text for name in Ports._fields):
            self._exchange = Exchange(program, 0)
            self.ports = _find_free_ports()._replace(motors=self._exchange.port)
        else:
            self.ports = Ports()
            self._exchange = Exchange(program, self.ports.motors)
            for port in (self.ports.state, self.ports.radio):
                check_free(socket.SOCK_DGRAM, port)
            check_free(socket.SOCK_STREAM, self.ports.msp)
        command = self._fill_in(self.ports._asdict())
        self._write_parameters(command, {})
        program.start(command, {})

    def _write_parameters(self, command: Sequence[str], environment: Mapping[str, str]) -> None:
        assert self._program is not None
        given = self._parameters, self._lines, self._where
        write_parameters(self._program, command, environment, *given)

    def _describe_session(self) -> Dict[str, Any]:
        if self._own_pilot is not None and self.record is not None:
            raise InputError(
                "--record: a flight with your own pilot cannot be recorded. Leave out --record."
            )
        program = Path(self._command[0])
        return describe_session("betaflight", program, self._settings, self._parameters)


def _find_free_ports() -> Ports:
    udp, tcp = socket.SOCK_DGRAM, socket.SOCK_STREAM
    return Ports(0, find_free_port(udp), find_free_port(udp), find_free_port(tcp))
