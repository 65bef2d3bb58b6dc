"""Stacks by name, and controllers from stack files."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any, Callable, Dict, NamedTuple, Sequence, Union

from .._core import InputError
from ..support.user_code import find_controller
from .ardupilot import ArduPilot
from .autopilot import Autopilot
from .betaflight.betaflight import Betaflight
from .crazyflie import Crazyflie
from .motor_curve import read_curve
from .px4.px4 import PX4
from .session import Session
from .stack_file import StackFile, read_stack_file


class Stack(NamedTuple):
    """Autopilot for which a bridge exists."""

    summary: str
    """Noun phrase for lists of stacks."""
    make: Callable[..., Autopilot]
    """Function that makes the controller from the values of a stack file."""
    is_module: bool
    """Whether the program is a Python module that runs in this process."""
    keys: Sequence[str]
    """Keys of stack files that not all stacks support."""


STACKS: Dict[str, Stack] = {
    "ardupilot": Stack(
        "ArduPilot SITL by JSON over UDP, stick pilot; never tried with the program",
        ArduPilot,
        False,
        ("arguments",),
    ),
    "betaflight": Stack(
        "Betaflight SITL over UDP, level mode with stick pilot",
        Betaflight,
        False,
        ("arguments", "commands", "lockstep", "pilot"),
    ),
    "crazyflie": Stack(
        "Crazyflie firmware in this process, Mellinger's controller", Crazyflie, True, ()
    ),
    "px4": Stack(
        "PX4 SITL over TCP, offboard mode, with simulated sensors", PX4, False, ("arguments",)
    ),
}
"""Stacks by their name in stack files."""


def read_autopilot(path: Union[str, Path]) -> Autopilot:
    """Make the controller that a stack file describes.

    Parameters
    ----------
    path : str or path
        YAML file.

    Raises
    ------
    InputError
        If the file is missing or invalid; the message begins with ``FILE:LINE``.
    """
    read = read_stack_file(path, tuple(STACKS))
    stack = STACKS[read.kind]
    for other in STACKS.values():
        for name in other.keys:
            if name in read.values and name not in stack.keys:
                raise InputError(
                    f"{read.locate(name)}{name}: autopilot {read.kind} does not use it. Leave it "
                    "out."
                )
    find = _find_module if stack.is_module else _find_program
    values = {**read.values, "program": find(read)}
    if "motor_curve" in values:
        try:
            read_curve(values["motor_curve"])
        except InputError as error:
            raise InputError(f"{read.locate('motor_curve')}{error}") from None
    if "pilot" in values:
        values["pilot"] = _find_pilot(read)
    where = {name: read.locate(name) for name in read.lines}
    return stack.make(**values, where=where)


def make_replay(session: Session) -> Autopilot:
    """Make the controller that replays a recorded session; it starts no program.

    Raises
    ------
    InputError
        If the session does not describe a flight with one of the stacks.
    """
    about = session.about
    try:
        made = STACKS[about["autopilot"]].make("", **about["settings"])
    except (KeyError, TypeError) as error:
        raise InputError(f"{session.file}: its description is damaged. Record it again.") from error
    made.session = session
    return made


def _find_program(read: StackFile) -> str:
    """Return the path of the program; raise `InputError` if it does not exist."""
    name: str = read.values["program"]
    found = shutil.which(name)
    if found is None:
        raise InputError(
            f"{read.locate('program')}program '{name}' does not exist or is not executable. Build "
            "it, or correct its path."
        )
    return found


def _find_module(read: StackFile) -> str:
    """Return the path of the module; raise `InputError` if it does not exist."""
    name: str = read.values["program"]
    if not Path(name).is_file():
        raise InputError(
            f"{read.locate('program')}module '{name}' does not exist. Build it, or correct its "
            "path."
        )
    return name


def _find_pilot(read: StackFile) -> Any:
    """Import a user-defined pilot function."""
    try:
        return find_controller(read.values["pilot"], lambda found: found)
    except InputError as error:
        raise InputError(f"{read.locate('pilot')}{error}") from None
