"""Record of a flight: commands and measurements."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ..._core import InputError
from ...simulation.commands import check_commands
from ...simulation.log import Log
from ...support import arguments

CHANNELS: Dict[str, int] = {"position": 3, "attitude": 3, "velocity": 3, "rates": 3, "rotors": 0}
"""Channels with their number of values; `rotors` has one value per rotor."""

UNITS = {"position": "m", "attitude": "rad", "velocity": "m/s", "rates": "rad/s", "rotors": "rad/s"}

_COMMANDS = "vel_cmd"


class Record(NamedTuple):
    """Commands and measurements of a flight.

    Attributes
    ----------
    time : ndarray (rows,)
        Time, s.
    position, velocity, rates : ndarray (rows, 3)
        As in `Log`: m in world axes, m/s, and rad/s in body axes.
    orientation : ndarray (rows, 4)
        Unit quaternions x, y, z, w.
    rotors : ndarray (rows, n)
        Velocities of the rotor joints, rad/s.
    commands : ndarray (m, 1 + n), optional
        Columns t (s), w1..wn (rad/s); each row is valid until the next one. None if unknown.
    """

    time: np.ndarray
    position: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    rates: np.ndarray
    rotors: np.ndarray
    commands: Optional[np.ndarray]


def read_record(
    log: Union[Log, str, Path],
    rotors: int,
    commands: Union[np.ndarray, str, Path, None] = None,
    sensed: Optional[str] = None,
) -> Record:
    """Read the record of a flight.

    Parameters
    ----------
    log
        Log or log file.
    rotors
        Number of rotors of the model.
    commands
        Command table or file (default: topic ``vel_cmd`` of the log, if it exists).
    sensed
        Topic with measured pose and velocities, such as ``odom`` (default: the state).

    Raises
    ------
    InputError
        If the log has fewer than two rows or a different number of rotors, the topic does not
        exist, or the commands are invalid.
    """
    where = "log" if isinstance(log, Log) else str(log)
    flown = log if isinstance(log, Log) else Log.of_file(log)
    if len(flown.time) < 2:
        raise InputError(f"{where}: the log has {len(flown.time)} rows. Give one with at least 2.")
    if flown.rotor_velocity.shape[1] != rotors:
        raise InputError(
            f"{where}: the log has {flown.rotor_velocity.shape[1]} rotors, the model {rotors}"
        )
    if commands is not None:
        table: Optional[np.ndarray] = check_commands(commands, rotors)
    elif _COMMANDS in flown.topics:
        table = _read_commands(flown)
    else:
        table = None
    if sensed is None:
        parts: Tuple[np.ndarray, ...] = (
            flown.position,
            flown.orientation,
            flown.linear_velocity,
            flown.angular_velocity,
        )
    else:
        parts = _read_sensed_state(flown, where, sensed)
    position, orientation, velocity, rates = parts
    return Record(
        flown.time.copy(), position, orientation, velocity, rates, flown.rotor_velocity, table
    )


def choose_channels(given: Optional[Sequence[str]], flown: Record) -> List[str]:
    """Return the channels to compare; raise `InputError` for unknown names."""
    if given is None:
        return ["position", "attitude", "rates"] + ["rotors"] * (flown.commands is not None)
    given = arguments.to_list(given)
    if not given:
        raise InputError(f"channels is {given}. Give some of {', '.join(CHANNELS)}.")
    for name in given:
        if name not in CHANNELS:
            known = ", ".join(CHANNELS)
            raise InputError(f"channel '{name}' does not exist. Use some of {known}.")
    return [name for name in CHANNELS if name in given]


def _read_sensed_state(log: Log, where: str, topic: str) -> Tuple[np.ndarray, ...]:
    fields = log.topics.get(topic, {})
    names = ("x y z", "qx qy qz qw", "vx vy vz", "wx wy wz")
    if not set(" ".join(names).split()) <= set(fields):
        known = ", ".join(log.topics) or "none"
        raise InputError(
            f"{where}: topic '{topic}' with pose and velocities does not exist (topics: {known}). "
            "Log it with --log-topics odom."
        )
    parts = [np.column_stack([fields[name] for name in each.split()]) for each in names]
    parts[1] /= np.linalg.norm(parts[1], axis=1, keepdims=True)
    return tuple(parts)


def _read_commands(log: Log) -> Optional[np.ndarray]:
    """Return each command once, with its time; None without commands."""
    fields = log.topics[_COMMANDS]
    table = np.column_stack(
        [fields["stamp"], *(fields[name] for name in fields if name != "stamp")]
    )
    table = table[np.isfinite(table).all(axis=1)]
    new = np.diff(table[:, 0], prepend=-np.inf) > 0
    return table[new] if new.any() else None
