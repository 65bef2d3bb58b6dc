"""Parameters of Betaflight, which are written to its memory before the flight and read back."""

from __future__ import annotations

import re
from typing import Mapping, Sequence

from ..._core import InputError
from ..program import Program

MAX_ANGLE = 60.0  # deg; at full stick in level mode
MAX_YAW_RATE = 200.0  # deg/s; at full stick
IDLE = 0.055  # output of an armed motor at zero throttle

_RATE = f"{MAX_YAW_RATE / 10:.0f}"

DEFAULTS = {
    "acc_calibration": "0,0,0,1",  # the accelerometer is exact
    "small_angle": "180",  # allows arming in any attitude
    "motor_pwm_protocol": "PWM",
    "motor_idle": f"{IDLE * 10000:.0f}",
    "angle_limit": f"{MAX_ANGLE:.0f}",
    "rates_type": "ACTUAL",
    # Equal centre sensitivity and maximum rate make the sticks linear.
    **{
        f"{axis}_{name}": value
        for axis in ("roll", "pitch", "yaw")
        for name, value in (("rc_rate", _RATE), ("srate", _RATE), ("expo", "0"))
    },
}
"""Parameters on which the stick pilot relies."""

COMMANDS = (
    "aux 0 0 0 1700 2100 0 0",  # the first switch arms
    "aux 1 1 1 1700 2100 0 0",  # the second switch selects the level mode
)

_CONFIG = "quadcore.txt"


def write_parameters(
    program: Program,
    command: Sequence[str],
    environment: Mapping[str, str],
    parameters: Mapping[str, str],
    commands: Sequence[str],
    where: Mapping[str, str],
) -> None:
    """Write parameters to Betaflight's memory in the folder of a program, and check them.

    Parameters
    ----------
    program
        Program that has not started yet.
    command
        Program and arguments.
    environment
        Variables to add to the environment.
    parameters
        Values by name.
    commands
        Additional lines for Betaflight's command line.
    where
        Locations ``FILE:LINE: `` by name, for messages.

    Raises
    ------
    InputError
        If Betaflight rejects a line, or reports another value afterwards.
    """
    at = where.get("parameters", "")
    lines = [f"set {name} = {value}" for name, value in parameters.items()]
    lines += [*commands, *(f"get {name}" for name in parameters), "save"]
    (program.folder / _CONFIG).write_text("\n".join(lines) + "\n")
    output = program.run([*command, "--config", _CONFIG], environment)
    refused = re.search(r"###ERROR[^#]*###", output)
    if refused:
        raise InputError(
            f"{at}Betaflight refused a line: {refused.group().strip('#')}. Correct the parameters."
        )
    for name, value in parameters.items():
        read = re.findall(rf"^(?:# )?{re.escape(name)} = (.*?)\s*$", output, re.MULTILINE)
        if not read or read[-1].upper() != value.upper():
            has = read[-1] if read else "none"
            raise InputError(
                f"{at}Betaflight has {name} = {has} after it was set to {value}. Correct the name "
                "and the value."
            )
