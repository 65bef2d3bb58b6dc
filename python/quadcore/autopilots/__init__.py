"""Bridges to autopilots: external programs that control the vehicle in lockstep.

A stack file (YAML) describes an autopilot; `read_autopilot` makes a controller from it. `Autopilot`
is the base class of bridges to other stacks.
"""

from .ardupilot import ArduPilot
from .autopilot import Autopilot
from .betaflight.betaflight import Betaflight
from .crazyflie import Crazyflie
from .px4.px4 import PX4
from .readings import Readings
from .stacks import read_autopilot
from .sticks import Sticks

__all__ = [
    "PX4",
    "ArduPilot",
    "Autopilot",
    "Betaflight",
    "Crazyflie",
    "Readings",
    "Sticks",
    "read_autopilot",
]
