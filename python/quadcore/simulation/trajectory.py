"""States of a flight as rows of numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict, Mapping, Optional, Sequence

import numpy as np

from .._core import InputError, Rotor, Simulation, log_columns
from ..support.arguments import shorten
from ..support.rotation import to_roll_pitch_yaw

if TYPE_CHECKING:
    from ..support.values import FloatArray

_STATE_SIZE = len(log_columns(0))


def per_command(simulation: Simulation) -> float:
    """Return the ratio of joint velocity to commanded speed; 1 if it differs between rotors."""
    sizes = {abs(rate) for rate in simulation._rates_per_command.tolist()}
    return sizes.pop() if len(sizes) == 1 else 1.0


def find_speed_limit(rotors: Sequence[Rotor]) -> float:
    """Return the lowest speed limit of all rotor joints, rad/s; infinite without a limit."""
    return min((rotor.max_speed / rotor.slowdown for rotor in rotors), default=math.inf)


def is_slow(size: float) -> bool:
    """Return whether the ratio of joint velocity to commanded speed is known and not 1."""
    return size not in (0.0, 1.0)


def _check_table(table: Any) -> FloatArray:
    if isinstance(table, np.ndarray) and table.ndim == 2 and table.shape[1] >= _STATE_SIZE:
        return table
    given = f"an array {table.shape}" if isinstance(table, np.ndarray) else shorten(table)
    raise InputError(
        f"table is {given}. Give an array (rows, {_STATE_SIZE} + rotors), or read a file with "
        "Log.of_file."
    )


class Wrenches(Dict[str, np.ndarray]):
    """Wrenches by the name of their term."""

    def __missing__(self, name: str) -> FloatArray:
        if self:
            raise InputError(
                f"log.wrenches: '{name}' does not exist. Use one of {', '.join(self)}."
            )
        raise InputError("log.wrenches: the log has none. Run the flight with wrenches=True.")


class Trajectory:
    """States of a flight, one row per logged step.

    Parameters
    ----------
    table : ndarray (rows, 14 + n)
        States, with the columns in `columns`.
    wrenches : mapping of str to ndarray (rows, 6), optional
        Force (N), then torque (N m), in frame axes, about the centre of mass of the vehicle. Each
        row is the wrench during the step that begins at this row.
    title : str, default ""
        Title of plots.
    ignored : sequence of str, default ()
        Parts of the model and the world that the option `ignore` left out.
    topics : mapping of str to mapping of str to ndarray (rows,), optional
        Logged topics: the fields of the latest message and its ``stamp`` (s). NaN before the first
        message.

    Raises
    ------
    InputError
        If the table does not contain states.

    Attributes
    ----------
    per_command : float
        Ratio of joint velocity to commanded speed, for example 0.1 for a sim_slow of 10; 1 if it is
        unknown.
    """

    per_command = 1.0

    def __init__(
        self,
        table: np.ndarray,
        wrenches: Optional[Mapping[str, np.ndarray]] = None,
        title: str = "",
        ignored: Sequence[str] = (),
        topics: Optional[Mapping[str, Mapping[str, np.ndarray]]] = None,
    ) -> None:
        self.table = _check_table(table)
        self.wrenches = Wrenches(wrenches or {})
        self.title = title
        self.ignored = list(ignored)
        self.topics = {name: dict(fields) for name, fields in (topics or {}).items()}

    def __len__(self) -> int:
        return len(self.table)

    @property
    def is_slow(self) -> bool:
        """Whether the joints are known to turn at a speed other than the commanded one."""
        return is_slow(self.per_command)

    @property
    def columns(self) -> list[str]:
        """Names of the columns of `table`, as in the header of the CSV file."""
        return log_columns(self.table.shape[1] - _STATE_SIZE)

    @property
    def time(self) -> FloatArray:
        """Time since the start, s; shape (rows,)."""
        return self.table[:, 0]

    @property
    def position(self) -> FloatArray:
        """Position of the frame link's origin in the world, m; shape (rows, 3)."""
        return self.table[:, 1:4]

    @property
    def orientation(self) -> FloatArray:
        """Orientation of the frame link in the world, unit quaternion x, y, z, w; (rows, 4)."""
        return self.table[:, 4:8]

    @property
    def rpy(self) -> FloatArray:
        """Roll, pitch, yaw of the frame link, R = Rz(yaw) Ry(pitch) Rx(roll), rad; (rows, 3)."""
        return to_roll_pitch_yaw(self.orientation)

    @property
    def linear_velocity(self) -> FloatArray:
        """Velocity of the frame link's origin, world axes, m/s; shape (rows, 3)."""
        return self.table[:, 8:11]

    @property
    def angular_velocity(self) -> FloatArray:
        """Angular velocity of the frame link, body axes, rad/s; shape (rows, 3)."""
        return self.table[:, 11:14]

    @property
    def rotor_velocity(self) -> FloatArray:
        """Velocity of the rotor joints, rad/s; shape (rows, n)."""
        return self.table[:, _STATE_SIZE:]
