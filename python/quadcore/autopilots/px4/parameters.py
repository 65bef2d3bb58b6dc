"""Parameters of PX4, which are set over MAVLink before the flight and read back."""

from __future__ import annotations

import math
import struct
from typing import Any, Dict, Mapping

import numpy as np

from ..._core import InputError, parse_number
from ...control.vehicle import Vehicle
from ..motor_curve import CurveLike, MotorCurve

DEFAULTS = {
    "COM_RCL_EXCEPT": "4",  # allows set-points without a radio
    "NAV_DLL_ACT": "0",  # allows flights without a ground station
    "COM_DISARM_PRFLT": "-1",  # stays armed until the flight begins
    "COM_OBL_ACT": "0",
}
"""Parameters on which the bridge relies."""

_INTEGER = 6  # MAV_PARAM_TYPE_INT32
_REAL = 9  # MAV_PARAM_TYPE_REAL32
_HOVER, _CURVE = "MPC_THR_HOVER", "THR_MDL_FAC"


def fit_parameters(vehicle: Vehicle, curve: MotorCurve, kind: CurveLike) -> Dict[str, str]:
    """Return the parameters that depend on the vehicle: hover thrust and thrust curve.

    Parameters
    ----------
    vehicle
        Vehicle to control.
    curve
        Motor curve of the vehicle.
    kind
        Curve as defined in the stack file.
    """
    output = float(np.mean(curve.find_outputs(np.abs(vehicle.hover_speed))))
    is_quadratic = kind != "thrust"
    # THR_MDL_FAC 1: thrust = output^2, which the mixer of PX4 inverts
    hover = output * output if is_quadratic else output
    return {_HOVER: f"{hover:.6g}", _CURVE: "1" if is_quadratic else "0"}


class ParameterWriter:
    """Sets parameters one after another, repeating each until PX4 returns the desired value.

    Parameters
    ----------
    mavlink : module
        Dialect of pymavlink.
    parameters : mapping of str to str
        Desired values by name.
    where : str
        Location ``FILE:LINE: `` of the parameters, for messages.
    """

    def __init__(self, mavlink: Any, parameters: Mapping[str, str], where: str) -> None:
        self._mavlink, self._where = mavlink, where
        self._missing = {name: self._read(name, text) for name, text in parameters.items()}
        self._types: Dict[str, int] = {}

    @property
    def is_done(self) -> bool:
        """Whether PX4 has all desired values."""
        return not self._missing

    def find_question(self, target: int) -> Any:
        """Return the message that requests or sets the next parameter of a system."""
        name = next(iter(self._missing))
        encoded = name.encode()
        if name not in self._types:
            return self._mavlink.MAVLink_param_request_read_message(target, 1, encoded, -1)
        value, kind = self._missing[name], self._types[name]
        if kind == _INTEGER:  # PX4 expects the bits of an integer as a float
            value = struct.unpack("<f", struct.pack("<i", int(value)))[0]
        return self._mavlink.MAVLink_param_set_message(target, 1, encoded, value, kind)

    def take(self, message: Any) -> None:
        """Process a PARAM_VALUE message."""
        name, kind, value = message.param_id, message.param_type, message.param_value
        if name not in self._missing:
            return
        if kind == _INTEGER:
            value = struct.unpack("<i", struct.pack("<f", value))[0]
        elif kind != _REAL:
            raise InputError(f"{self._where}parameter {name} of PX4 has an unknown type {kind}.")
        self._types[name] = kind
        if math.isclose(value, self._missing[name], rel_tol=1e-6):
            del self._missing[name]

    def describe_missing(self) -> str:
        """Return the error message for parameters that PX4 has not accepted."""
        names = ", ".join(f"{name} = {value:g}" for name, value in self._missing.items())
        return f"{self._where}PX4 has not accepted {names}. Correct the names and the values."

    def _read(self, name: str, text: str) -> float:
        value = parse_number(text)
        if value is None or len(name) > 16:
            raise InputError(
                f"{self._where}parameter {name}: {text} is no parameter of PX4. Write a number."
            )
        return float(value)
