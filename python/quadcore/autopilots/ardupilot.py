"""Bridge to ArduPilot's SITL program by its JSON interface.

The bridge follows the source of ArduPilot, commit 0394cbc. It has not been tested with the program.

- ``libraries/SITL/SIM_JSON.h:47``: packet of the servos; ``:114``: keys of the state
- ``libraries/SITL/SIM_JSON.cpp:101`` sends the servos; ``:129`` reads the state. It searches for
  keys without a JSON parser, so a bracket must directly follow each colon
- ``libraries/AP_RCProtocol/AP_RCProtocol_UDP.cpp``, commit 04c3451: the 16 radio channels

Body axes are forward, right, down; world axes are north, east, down.
"""

from __future__ import annotations

import json
import math
import socket
import struct
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

from .._core import FlightError
from ..control.vehicle import Vehicle
from .arming import ArmingWatch
from .axes import turn_body_vector, turn_orientation, turn_world_vector
from .exchange import Exchange, find_free_port
from .program import Program
from .program_autopilot import ProgramAutopilot, fly_reference
from .readings import Readings
from .rotor_map import Place
from .session import Link, describe_session
from .sticks import StickPilot, Sticks

_SERVOS = struct.Struct("<HHI16H")
_MAGIC = 18458
_RADIO = struct.Struct("<16H")
_LOW, _SPAN = 1000, 1000  # us; pulse widths of the outputs 0 to 1
_IDLE = 0.05  # half of MOT_SPIN_ARM; a larger output means that the autopilot is armed
_ARM = 3.0  # s before the flight
_MAX_ANGLE, _MAX_YAW_RATE = math.radians(45), math.radians(200)  # at full stick deflection
_PARAMETERS = "quadcore.parm"

ARGUMENTS = (
    *("--model", "JSON:127.0.0.1", "--sim-port-out", "{motors}", "--rc-in-port", "{radio}"),
    *("--serial0", "tcp:0", "--defaults", _PARAMETERS),
)
"""Default arguments of the program."""

DEFAULTS = {
    "FRAME_CLASS": "1",
    "FRAME_TYPE": "1",
    "FLTMODE_CH": "0",  # keeps the initial mode, which is self-levelling
    "RC5_OPTION": "153",  # arming switch
    "ANGLE_MAX": "4500",
}
"""Parameters on which the bridge relies."""


class ArduPilot(ProgramAutopilot):
    """Controller that runs an ArduPilot SITL program (``arducopter``) with the sticks of a radio.

    Parameters
    ----------
    program : str
        Path of ArduPilot's program.
    arguments : sequence of str, default `ARGUMENTS`
        Arguments of the program. ``{motors}`` and ``{radio}`` are replaced by free ports.
    parameters : mapping of str to str, default {}
        Parameters of ArduPilot by name. They are passed as defaults and are not read back.
    hold : float, default 30
        Duration of the phase before the flight, s, during which the estimator settles.
    motor_curve, rotors, imu, where
        As for `Autopilot`.
    """

    # libraries/AP_Motors, frame class QUAD, type X
    layout = (Place(1, -1, 1), Place(-1, 1, 1), Place(1, 1, -1), Place(-1, -1, -1))

    def __init__(
        self,
        program: str,
        arguments: Sequence[str] = ARGUMENTS,
        parameters: Optional[Mapping[str, str]] = None,
        hold: float = 30.0,
        where: Optional[Mapping[str, str]] = None,
        **others: Any,
    ) -> None:
        parameters = {**DEFAULTS, **(parameters or {})}
        super().__init__([program, *arguments], parameters, hold, where, **others)
        self.log["armed"] = math.nan
        self._check_hold("ArduPilot", _ARM)

    def start(self, vehicle: Vehicle) -> None:
        """Start the program, and wait for its first packet."""
        self._pilot = StickPilot(
            vehicle, self.curve, 1 / self.pilot_rate, _MAX_ANGLE, _MAX_YAW_RATE, 0.0
        )
        self._watch = ArmingWatch(self.fail, self._quote_messages)
        self._sticks: Optional[Sticks] = None
        self._count = -1
        self._ports = {"state": 0, "radio": 0}
        if self.session is not None:
            self.session.rewind()
            self._flight_link: Link = self.session
            return
        self._program = Program()
        self._exchange = Exchange(self._program, 0)
        self._ports["radio"] = find_free_port(socket.SOCK_DGRAM)
        given = {"motors": self._exchange.port, "radio": self._ports["radio"]}
        lines = [f"{name} {value}\n" for name, value in self._parameters.items()]
        (self._program.folder / _PARAMETERS).write_text("".join(lines))
        self._program.start(self._fill_in(given), {})
        self._ports["state"] = self._exchange.wait_for_sender(
            lambda reason: self.fail(-self.hold, reason)
        )
        about = describe_session(
            "ardupilot", Path(self._command[0]), self._settings, self._parameters
        )
        self._flight_link = self.record_link(self._exchange, about)

    def tick(self, readings: Readings, sticks: Sticks) -> Sequence[float]:
        """Send the radio channels and the state, and wait for the servos."""
        link = self._exchange if readings.time < 0 else self._flight_link
        assert link is not None

        def fail(reason: str) -> FlightError:
            return self.fail(readings.time, reason)

        if sticks is not self._sticks:
            self._sticks = sticks
            link.send(pack_radio(sticks), self._ports["radio"], fail)
        packet = pack_state(readings.time + self.hold, readings)
        outputs, count, problem = read_servos(link.ask(packet, self._ports["state"], fail))
        if outputs is None:
            raise fail(problem)
        if count < self._count:
            raise fail(f"the autopilot has restarted. {self._quote_messages()}")
        self._count = count
        is_armed = max(outputs[: len(self.layout)]) > _IDLE
        self.log["armed"] = float(is_armed)
        self._watch.check(readings.time, sticks.is_armed, is_armed)
        return outputs[: len(self.layout)]

    def pilot(self, t: float, state: Any, reference: Any) -> Sticks:
        """Arm before the flight, and follow the reference in flight."""
        if t < 0:
            return Sticks(is_armed=t >= -_ARM)
        return fly_reference(self._pilot, state, reference)


def convert_readings(readings: Readings) -> Dict[str, List[float]]:
    """Return the readings in the axes of ArduPilot.

    Returns
    -------
    dict of str to list of float
        ``gyro`` (rad/s) and ``accel_body`` (m/s^2) are in forward, right, down axes. ``position``
        (m) and ``velocity`` (m/s) are in north, east, down axes. ``quaternion`` (w, x, y, z)
        transforms from the former axes to the latter.
    """
    return {
        "gyro": turn_body_vector(readings.angular_velocity),
        "accel_body": turn_body_vector(readings.specific_force),
        "position": turn_world_vector(readings.position),
        "velocity": turn_world_vector(readings.linear_velocity),
        "quaternion": turn_orientation(readings.orientation),
    }


def pack_state(time: float, readings: Readings) -> bytes:
    """Pack a time (s) and the readings as a line of JSON that ArduPilot's parser accepts."""
    values = convert_readings(readings)
    imu = {name: values.pop(name) for name in ("gyro", "accel_body")}
    state = {"timestamp": time, "imu": imu, **values, "no_time_sync": 1}
    return f"\n{json.dumps(state, separators=(',', ':'))}\n".encode()


def pack_radio(sticks: Sticks) -> bytes:
    """Pack the channels roll, pitch, throttle, yaw and arming switch; the rest are ignored."""
    levels = (sticks.roll, sticks.pitch, 2 * sticks.throttle - 1, sticks.yaw)
    channels = [1500 + round(500 * level) for level in levels]
    return _RADIO.pack(*channels, 2000 if sticks.is_armed else 1000, *[0] * 11)


def read_servos(packet: bytes) -> Tuple[Optional[Sequence[float]], int, str]:
    """Return the outputs and the count of a packet, or None and the error."""
    if len(packet) != _SERVOS.size:
        problem = f"a packet of servos has {len(packet)} bytes instead of {_SERVOS.size}"
        return None, 0, problem
    magic, _, count, *pulses = _SERVOS.unpack(packet)
    if magic != _MAGIC:
        return None, 0, f"a packet of servos begins with {magic} instead of {_MAGIC}"
    return [min(max((pulse - _LOW) / _SPAN, 0.0), 1.0) for pulse in pulses], count, ""
