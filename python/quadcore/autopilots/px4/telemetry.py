"""Messages in which PX4 reports its mode, its estimates and texts."""

from __future__ import annotations

import collections
import math
from typing import Any, Deque, Dict

import numpy as np

from ..axes import turn_heading
from .set_points import OFFBOARD

_AUTOPILOT = 1  # component of the flight controller
_KEPT = 5  # number of texts that are kept

COLUMNS = ("mode", *(f"estimate_{name}" for name in ("x", "y", "z", "roll", "pitch", "yaw")))
"""Columns of the log."""


class Telemetry:
    """Latest messages of PX4.

    Attributes
    ----------
    mode : int
        Main mode of PX4; see `set_points.OFFBOARD`.
    texts : sequence of str
        Last texts, such as the reasons why PX4 does not arm.
    columns : dict of str to float
        Values of `COLUMNS`: the mode, and the estimates of PX4. These are the position in the world
        (m), and roll, pitch and yaw (rad) of forward, left, up axes in east, north, up axes.
    """

    def __init__(self) -> None:
        self.mode = 0
        self.texts: Deque[str] = collections.deque(maxlen=_KEPT)
        self.columns: Dict[str, float] = dict.fromkeys(COLUMNS, math.nan)

    def restart(self) -> None:
        """Discard the estimates, so that a flight does not depend on the phase before it."""
        self.columns = dict.fromkeys(COLUMNS, math.nan)
        self._set(mode=OFFBOARD)  # mode at the start of the flight

    def take(self, message: Any, origin: np.ndarray) -> None:
        """Process a message.

        Parameters
        ----------
        message
            Message of pymavlink.
        origin : ndarray (3,)
            Position at which PX4 started its estimator, world axes, m.
        """
        kind = message.get_type()
        if kind == "HEARTBEAT" and message.get_srcComponent() == _AUTOPILOT:
            self.mode = message.custom_mode >> 16 & 0xFF
            self._set(mode=self.mode)
        elif kind == "STATUSTEXT":
            self.texts.append("".join(c for c in message.text if c.isprintable()).strip())
        elif kind == "LOCAL_POSITION_NED":
            x, y, z = (origin + np.array([message.y, message.x, -message.z])).tolist()
            self._set(estimate_x=x, estimate_y=y, estimate_z=z)
        elif kind == "ATTITUDE":
            self._set(
                estimate_roll=message.roll,
                estimate_pitch=-message.pitch,
                estimate_yaw=turn_heading(message.yaw),
            )

    def _set(self, **values: float) -> None:
        self.columns.update(values)
