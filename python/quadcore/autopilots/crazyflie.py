"""Bridge to the Crazyflie firmware, which runs in this process through its Python bindings."""

from __future__ import annotations

import functools
import importlib.util
import struct
import sys
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence

import numpy as np

from .._core import InputError, parse_number
from ..control.vehicle import Vehicle
from ..support.output_files import printable_name
from ..support.parameters import suggest
from ..support.rotation import to_roll_pitch_yaw
from .autopilot import Autopilot
from .readings import Readings
from .rotor_map import Place
from .session import Link, describe_session

_MODULE = "cffirmware"
_FULL = 65535.0  # UINT16_MAX; value of a motor at full thrust
_G = 9.80665  # m/s^2
_QUESTION = struct.Struct("<30f")
_ANSWER = struct.Struct("<4H")


class Setpoint(NamedTuple):
    """Set-point of the firmware's commander in world axes."""

    position: Sequence[float]
    """Position, m."""
    velocity: Sequence[float]
    """Velocity, m/s."""
    acceleration: Sequence[float]
    """Acceleration, m/s^2."""
    yaw: float
    """Yaw, rad."""
    yaw_rate: float
    """Yaw rate, rad/s."""


class Crazyflie(Autopilot):
    """Controller that calls Mellinger's controller of the Crazyflie firmware.

    The firmware receives the true state instead of the estimate of its Kalman filter. Its power
    distribution and its limits determine the thrusts of the motors.

    Parameters
    ----------
    program : str
        Path of the firmware's bindings, ``build/cffirmware.py`` after ``make bindings_python``.
    parameters : mapping of str to str, default {}
        Fields of the firmware's ``controllerMellinger_t``, such as ``kp_xy``. Default: the gains of
        the firmware, and the mass and massThrust of the vehicle.
    motor_curve, default "thrust"
        As for `Autopilot`. The firmware compensates the battery voltage, so its outputs are
        proportional to thrust.
    rotors, imu, hold, where
        As for `Autopilot`.
    """

    # src/modules/src/power_distribution_quadrotor.c, powerDistributionForceTorque
    layout = (Place(1, -1, 1), Place(-1, -1, -1), Place(-1, 1, 1), Place(1, 1, -1))
    rate = 1000.0  # RATE_MAIN_LOOP; the firmware divides this rate for its loops
    pilot_rate = 1000.0

    def __init__(
        self,
        program: str,
        parameters: Optional[Mapping[str, str]] = None,
        motor_curve: Any = "thrust",
        where: Optional[Mapping[str, str]] = None,
        **others: Any,
    ) -> None:
        super().__init__(motor_curve=motor_curve, where=where, **others)
        self._program = Path(program)
        self._parameters = dict(parameters or {})
        self._settings = {"motor_curve": motor_curve, **others}
        self._link: Optional[Link] = None

    def start(self, vehicle: Vehicle) -> None:
        """Load the firmware, and set its parameters."""
        self._link = self.session
        if self.session is None:
            hover = self.curve.find_outputs(np.abs(vehicle.hover_speed))
            weight = -vehicle.mass * float(vehicle.gravity[2])
            values = {
                "mass": str(vehicle.mass),
                "massThrust": str(_FULL * float(np.mean(hover)) / weight),
                **self._parameters,
            }
            bindings = load_bindings(self._program)
            firmware = Firmware(bindings, self._read_parameters(values))
            about = describe_session("crazyflie", _find_library(bindings), self._settings, values)
            self._link = self.record_link(firmware, about)
        else:
            self.session.rewind()

    def tick(self, readings: Readings, sticks: Setpoint) -> Sequence[float]:
        """Pass state and set-point to the firmware, and return the thrusts of the motors."""
        assert self._link is not None
        question = _QUESTION.pack(
            *convert_readings(readings),
            *(*sticks.position, *sticks.velocity, *sticks.acceleration),
            *np.degrees([sticks.yaw, sticks.yaw_rate]).tolist(),
        )
        answer = self._link.ask(question, 0, lambda reason: self.fail(readings.time, reason))
        return [ratio / _FULL for ratio in _ANSWER.unpack(answer)]

    def pilot(self, t: float, state: Any, reference: Any) -> Setpoint:
        """Return the reference as a set-point."""
        if reference is None:
            raise InputError("An autopilot needs a reference. Add --reference hover.")
        return Setpoint(
            np.asarray(reference.position).tolist(),
            np.asarray(reference.velocity).tolist(),
            np.asarray(reference.acceleration).tolist(),
            reference.yaw,
            reference.yaw_rate,
        )

    def _read_parameters(self, values: Mapping[str, str]) -> Dict[str, float]:
        read = {}
        for name, text in values.items():
            number = parse_number(text)
            if number is None:
                raise InputError(
                    f"{self._where.get('parameters', '')}{name} is {text}. Write a number."
                )
            read[name] = float(number)
        return read


def convert_readings(readings: Readings) -> List[float]:
    """Convert the state and the readings to the format of the firmware.

    The axes are those of `Readings`. Pitch is negated in the attitude but not in the quaternion
    (``state_t``, src/modules/interface/stabilizer_types.h).

    Returns
    -------
    list of 19 floats
        Position (m), velocity (m/s), quaternion x, y, z, w, attitude roll, pitch, yaw (deg),
        angular velocity (deg/s), specific force (g).
    """
    roll, pitch, yaw = np.degrees(to_roll_pitch_yaw(readings.orientation)).tolist()
    return [
        *readings.position.tolist(),
        *readings.linear_velocity.tolist(),
        *readings.orientation.tolist(),
        *(roll, -pitch, yaw),
        *np.degrees(readings.angular_velocity).tolist(),
        *(readings.specific_force / _G).tolist(),
    ]


class Firmware:
    """Mellinger's controller of the firmware; requests and answers are bytes, as for a program.

    Parameters
    ----------
    bindings : module
        Bindings of the firmware.
    parameters : mapping of str to float
        Fields of ``controllerMellinger_t``.

    Raises
    ------
    InputError
        If a field does not exist.
    """

    def __init__(self, bindings: Any, parameters: Mapping[str, float]) -> None:
        self._bindings = bindings
        self._controller = controller = bindings.controllerMellinger_t()
        bindings.controllerMellingerInit(controller)
        fields = [name for name in dir(controller) if isinstance(getattr(controller, name), float)]
        for name, value in parameters.items():
            if name not in fields:
                raise InputError(
                    f"parameters: controllerMellinger_t has no '{name}'.{suggest(name, fields)} "
                    f"Use some of {', '.join(fields)}."
                )
            setattr(controller, name, value)
        self._state, self._sensors = bindings.state_t(), bindings.sensorData_t()
        self._setpoint, self._control = bindings.setpoint_t(), bindings.control_t()
        mode = self._setpoint.mode
        mode.x = mode.y = mode.z = mode.yaw = bindings.modeAbs
        self._thrusts = bindings.motors_thrust_uncapped_t()
        self._ratios = bindings.motors_thrust_pwm_t()
        self._step = 0

    def send(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> None:
        """Do nothing, because the firmware reads no packets without an answer."""

    def ask(self, packet: bytes, port: int, fail: Callable[[str], Exception]) -> bytes:
        """Run controller and power distribution once, and return the ratios of the motors."""
        numbers = iter(_QUESTION.unpack(packet))
        state, sensors, setpoint = self._state, self._sensors, self._setpoint
        for vector, names in (
            (state.position, "xyz"),
            (state.velocity, "xyz"),
            (state.attitudeQuaternion, "xyzw"),
            (state.attitude, ("roll", "pitch", "yaw")),
            (sensors.gyro, "xyz"),
            (sensors.acc, "xyz"),
            (setpoint.position, "xyz"),
            (setpoint.velocity, "xyz"),
            (setpoint.acceleration, "xyz"),
            (setpoint.attitude, ("yaw",)),
            (setpoint.attitudeRate, ("yaw",)),
        ):
            for name in names:
                setattr(vector, name, next(numbers))
        self._bindings.controllerMellinger(
            self._controller, self._control, setpoint, sensors, state, self._step
        )
        self._step += 1
        self._bindings.powerDistribution(self._control, self._thrusts)
        self._bindings.powerDistributionCap(self._thrusts, self._ratios)
        motors = self._ratios.motors
        return _ANSWER.pack(motors.m1, motors.m2, motors.m3, motors.m4)


@functools.lru_cache(maxsize=None)
def load_bindings(path: Path) -> Any:
    """Load the bindings of the firmware from a file.

    Raises
    ------
    InputError
        If the bindings cannot be loaded, or other bindings were loaded before.
    """
    file = printable_name(path)
    spec = importlib.util.spec_from_file_location(_MODULE, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(path.parent))
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise InputError(
            f"{file}: cannot be loaded: {error}. Run make bindings_python with this Python."
        ) from error
    finally:
        sys.path.remove(str(path.parent))
    library = _find_library(module)
    if library.parent != path.parent:
        raise InputError(f"{file}: {library} is already loaded. Use one build at a time.")
    return module


def _find_library(module: Any) -> Path:
    """Return the compiled part of the bindings, or the file of a module without one."""
    return Path(getattr(module, f"_{_MODULE}", module).__file__)
