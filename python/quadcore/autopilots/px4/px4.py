"""Bridge to PX4's SITL program.

The bridge follows the source of PX4, commit 34160bb6,
``src/modules/simulator/simulator_mavlink.cpp``. PX4 takes its time from HIL_SENSOR, and answers
each HIL_SENSOR with HIL_ACTUATOR_CONTROLS.
"""

from __future__ import annotations

import importlib
import math
from pathlib import Path
from typing import Any, Callable, Mapping, NamedTuple, Optional, Sequence

import numpy as np

from ..._core import FlightError, InputError
from ...control.vehicle import Vehicle
from ...model.earth import find_location, find_magnetic_field
from ...support.optional_packages import require_package
from ..arming import ArmingWatch
from ..program import Program
from ..program_autopilot import ProgramAutopilot
from ..readings import Readings
from ..rotor_map import Place
from ..session import Link, describe_session
from .link import Px4Link
from .parameters import DEFAULTS, ParameterWriter, fit_parameters
from .sensors import SensorPackets
from .set_points import OFFBOARD, SetPoints
from .telemetry import COLUMNS, Telemetry

ARGUMENTS = ("-d", "{etc}", "-s", "etc/init.d-posix/rcS", "-i", "{instance}")
"""Default arguments of the program."""

_ENVIRONMENT = {"PX4_SIM_MODEL": "iris"}
_START = 1_000_000  # us; time of PX4 at the first tick
_ARM = 5.0  # s; time of arming before the flight
_SHORTEST = 8.0  # s; minimum `hold`, because PX4 aligns its estimator in about 7 s
_QUESTION, _GPS, _AIR = 25, 25, 5  # ticks between packets
_SYSTEM = 255  # MAVLink system number of quadcore
_ARMED = 128  # flag in the mode of HIL_ACTUATOR_CONTROLS


class Target(NamedTuple):
    """Target for PX4 to follow."""

    reference: Any
    """Value of the reference; None before the flight."""


class PX4(ProgramAutopilot):
    """Controller that runs a PX4 SITL program in offboard mode.

    Parameters
    ----------
    program : str
        Path of PX4's program, ``build/px4_sitl_default/bin/px4``.
    arguments : sequence of str, default `ARGUMENTS`
        Arguments of the program. ``{etc}`` is replaced by the folder ``etc`` of the build, and
        ``{instance}`` by a free instance number.
    parameters : mapping of str to str, default {}
        Parameters of PX4 by name. They are set before the flight and read back.
    hold : float, default 20
        Duration of the phase before the flight, s. PX4 arms 5 s before its end.
    motor_curve, rotors, imu, where
        As for `Autopilot`.
    """

    # src/lib/mixer/MultirotorMixer, geometries quad_x and quad_wide
    layout = (
        Place(1, -1, 1),
        Place(-1, 1, 1),
        Place(1, 1, -1),
        Place(-1, -1, -1),
    )
    rate = 250.0
    pilot_rate = 50.0

    def __init__(
        self,
        program: str,
        arguments: Sequence[str] = ARGUMENTS,
        parameters: Optional[Mapping[str, str]] = None,
        hold: float = 20.0,
        where: Optional[Mapping[str, str]] = None,
        **others: Any,
    ) -> None:
        super().__init__([program, *arguments], parameters or {}, hold, where, **others)
        self.log.update(dict.fromkeys(("armed", *COLUMNS), math.nan))
        self._check_hold("PX4", _SHORTEST)

    def start(self, vehicle: Vehicle) -> None:
        """Start the program, and wait until it connects."""
        with require_package("PX4", "pymavlink", "px4"):
            mavlink: Any = importlib.import_module("pymavlink.dialects.v20.common")
        self._mavlink = mavlink
        self._mav = mavlink.MAVLink(None, _SYSTEM, mavlink.MAV_COMP_ID_ONBOARD_COMPUTER)
        self._mav.robust_parsing = True
        location = find_location(vehicle.world)
        self._packets = SensorPackets(mavlink, find_magnetic_field(location), location)
        self._telemetry = Telemetry()
        self._watch = ArmingWatch(self.fail, self._quote_messages)
        fitted = fit_parameters(vehicle, self.curve, self.motor_curve)
        parameters = {**DEFAULTS, **fitted, **self._parameters}
        self._writer = ParameterWriter(mavlink, parameters, self._where.get("parameters", ""))
        self._set_points: Optional[SetPoints] = None
        self._outputs: Sequence[float] = [0.0] * len(self.layout)
        self._count, self._target, self._sent = 0, 1, None
        self._is_armed = self._is_flying = False
        if self.session is not None:
            self.session.rewind()
            self._flight_link: Link = self.session
            return
        self._program = Program()
        self._exchange = link = Px4Link(self._program)
        self._target = link.instance + 1
        etc = Path(self._command[0]).resolve().parents[1] / "etc"
        command = self._fill_in({"etc": etc, "instance": link.instance})
        self._program.start(command, _ENVIRONMENT)
        link.accept(lambda reason: self.fail(-self.hold, reason))
        about = describe_session("px4", Path(self._command[0]), self._settings, parameters)
        self._flight_link = self.record_link(link, about)

    def tick(self, readings: Readings, sticks: Any) -> Sequence[float]:
        """Send sensor data and the set-point, and wait for the motors."""
        time = readings.time
        link = self._exchange if time < 0 else self._flight_link
        assert link is not None

        def fail(reason: str) -> FlightError:
            return self.fail(time, reason)

        if self._set_points is None:
            self._set_points = SetPoints(self._mavlink, self._target, readings)
        if time >= 0 and not self._is_flying:
            self._is_flying, self._count = True, 0
            self._packets.restart()
            self._telemetry.restart()
        stamp = _START + round((time + self.hold) * 1e6)
        if sticks is not self._sent:
            self._sent = sticks
            self._send(link, self._set_points.follow(stamp // 1000, sticks.reference), fail)
        if time < 0 and self._count % _QUESTION == 0:
            self._prepare(link, time, self._set_points, fail)
        packet = self._packets.read_sensor(stamp, readings, self._count % _AIR == 0).pack(self._mav)
        if self._count % _GPS == 0:
            packet += self._packets.read_gps(stamp, readings).pack(self._mav)
        self._count += 1
        for message in self._mav.parse_buffer(link.ask(packet, 0, fail)) or ():
            self._take(message, self._set_points.origin, fail)
        self.log.update(armed=float(self._is_armed), **self._telemetry.columns)
        self._watch.check(time, True, self._is_armed)
        return self._outputs

    def pilot(self, t: float, state: Any, reference: Any) -> Target:
        """Return the reference for PX4 to follow."""
        if t >= 0 and reference is None:
            raise InputError("PX4 needs a reference. Add --reference hover.")
        return Target(reference)

    def _prepare(
        self, link: Link, time: float, set_points: SetPoints, fail: Callable[[str], FlightError]
    ) -> None:
        """Set parameters, select the offboard mode and arm, one step at a time."""
        if not self._writer.is_done:
            if time >= -_ARM:
                raise InputError(self._writer.describe_missing())
            self._send(link, self._writer.find_question(self._target), fail)
        elif time >= -_ARM and self._telemetry.mode != OFFBOARD:
            self._send(link, set_points.choose_offboard(), fail)
        elif time >= -_ARM and not self._is_armed:
            self._send(link, set_points.arm(), fail)

    def _take(self, message: Any, origin: np.ndarray, fail: Callable[[str], FlightError]) -> None:
        kind = message.get_type()
        if kind == "HIL_ACTUATOR_CONTROLS":
            self._is_armed = bool(message.mode & _ARMED)
            self._outputs = [
                min(max(control, 0.0), 1.0) for control in message.controls[: len(self.layout)]
            ]
        elif kind == "PARAM_VALUE":
            self._writer.take(message)
        elif kind == "BAD_DATA":
            raise fail(f"the autopilot has sent bytes that are not MAVLink: {message.reason}")
        else:
            self._telemetry.take(message, origin)

    def _send(self, link: Link, message: Any, fail: Callable[[str], FlightError]) -> None:
        link.send(message.pack(self._mav), 0, fail)

    def _quote_messages(self) -> str:
        if not self._telemetry.texts:
            return super()._quote_messages()
        return f"Its last messages: {' | '.join(self._telemetry.texts)}"
