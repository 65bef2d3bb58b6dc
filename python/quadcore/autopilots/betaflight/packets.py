"""Packets of Betaflight's SITL (`target/SITL/target.h`): little-endian structures."""

from __future__ import annotations

import math
import struct
from typing import NamedTuple, Optional, Sequence, Tuple

from ..sticks import Sticks

_STATE = struct.Struct("<18d")  # fdm_packet
_RADIO = struct.Struct("<d16H")  # rc_packet
_MOTORS = struct.Struct("<4f")  # servo_packet

RAW_PORT = 9001
"""UDP port to which the autopilot sends pulse widths; quadcore does not use them."""

_CENTRE, _HALF = 1500, 500  # us


class Ports(NamedTuple):
    """Ports on 127.0.0.1."""

    motors: int = 9002
    """UDP port to which the autopilot sends the outputs."""
    state: int = 9003
    """UDP port on which the autopilot receives the state."""
    radio: int = 9004
    """UDP port on which the autopilot receives the radio channels."""
    msp: int = 5761
    """TCP port on which the autopilot answers questions."""


def pack_state(time: float, fields: Sequence[float]) -> bytes:
    """Pack the time (s) and the fields of `frames.convert_readings`."""
    return _STATE.pack(time, *fields)


def pack_radio(time: float, sticks: Sticks) -> bytes:
    """Pack a time (s) and the channels: roll, pitch, throttle, yaw, arming switch, level mode."""
    levels = (sticks.roll, sticks.pitch, 2 * sticks.throttle - 1, sticks.yaw)
    channels = [_CENTRE + round(_HALF * level) for level in levels]
    switches = [_CENTRE + _HALF * (1 if is_on else -1) for is_on in (sticks.is_armed, True)]
    rest = [_CENTRE - _HALF] * (16 - len(channels) - len(switches))
    return _RADIO.pack(time, *channels, *switches, *rest)


def read_motors(packet: bytes) -> Tuple[Optional[Tuple[float, ...]], str]:
    """Return the outputs in a packet, or None and the error."""
    if len(packet) != _MOTORS.size:
        return None, f"a packet of motors has {len(packet)} bytes instead of {_MOTORS.size}"
    outputs = _MOTORS.unpack(packet)
    if min(outputs) >= -0.01 and max(outputs) <= 1.01 and not math.isnan(sum(outputs)):
        return outputs, ""
    if not all(map(math.isfinite, outputs)):
        return None, "a packet of motors contains a number that is not finite"
    return None, f"a packet of motors contains outputs outside 0 to 1: {outputs}"
