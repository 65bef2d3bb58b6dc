"""Real flights, cleaned, aligned and sampled for predictions."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Tuple, Union

import numpy as np

from ..._core import InputError
from ...formats.recordings import Recording, is_recording, read_recording
from ...formats.recordings.recording import interpolate_orientation
from ...formats.recordings.series import Series
from ...simulation.log import Log
from .alignment import compute_rates, find_lags, find_mount, shift_topics, turn_pose
from .cleaning import Removal, clean_recording, list_gaps
from .smoothing import NODES, fit_locally

_REACH = 0.04  # s; half-width of the polynomials that give a measured state
_AIRBORNE = 0.12  # m above the lowest position; higher positions are in the air
_CLIMB = 0.5  # s; time after take-off and before landing that is not used
_IDLE = 0.4
"""Fraction of the median command below which a rotor is idle."""
_SAME = 0.05
"""Fraction of equal rows above which two recordings are copies."""


class PreparedFlight(NamedTuple):
    """Recording of a flight after cleaning and alignment.

    Attributes
    ----------
    where : str
        Path of the recording.
    position, orientation, rates : Series, optional
        Cleaned and aligned measurements; None without any.
    velocity : Series, optional
        Velocity in world axes, derived from the positions, m/s.
    commands, rotors, battery : Series, optional
        Inputs of the recording: motor commands, rotor speeds and battery voltage.
    setpoint, setpoint_yaw : Series, optional
        Position (m) and yaw (rad) set-points; each is valid until the next one.
    spin : ndarray, optional
        Direction of rotation of each rotor.
    span : tuple of float
        Start and end of the time in the air, s.
    gaps : ndarray (gaps, 2)
        Start and end of intervals without measurements or with invalid inputs, s.
    lags : dict of str to float
        Lag of each topic that was corrected, s.
    tilt : float
        Angle by which the pose was rotated to the axes of the IMU, deg.
    removals : list of Removal
        Samples that were removed.
    rows : set of bytes
        Digest of each row, to detect copies.
    are_rates_derived : bool
        Whether the rates are derived from the orientation.
    """

    where: str
    position: Optional[Series]
    orientation: Optional[Series]
    rates: Series
    velocity: Optional[Series]
    commands: Optional[Series]
    rotors: Optional[Series]
    battery: Optional[Series]
    setpoint: Optional[Series]
    setpoint_yaw: Optional[Series]
    spin: Optional[np.ndarray]
    span: Tuple[float, float]
    gaps: np.ndarray
    lags: Dict[str, float]
    tilt: float
    removals: List[Removal]
    rows: set
    are_rates_derived: bool = False

    @property
    def has_pose(self) -> bool:
        """Whether position and orientation were measured."""
        return self.position is not None and self.orientation is not None


def read_flight(path: Union[str, Path], mapping: Optional[str] = None) -> Recording:
    """Read a recording, or a log of quadcore as if it were a recording."""
    if mapping is not None or is_recording(Path(path)):
        return read_recording(Path(path), mapping)
    log = Log.of_file(path)
    values = {
        "position": log.position,
        "orientation": log.orientation,
        "velocity": log.linear_velocity,
        "rates": log.angular_velocity,
        "rotors": log.rotor_velocity,
    }
    quantities = {name: Series(log.time, value) for name, value in values.items()}
    return Recording(str(path), quantities, None)


def prepare_flight(path: Union[str, Path], mapping: Optional[str] = None) -> PreparedFlight:
    """Read, clean and align the recording of a flight.

    Raises
    ------
    InputError
        If the recording contains neither rates nor an orientation, or neither commands nor rotor
        speeds.
    """
    recording = read_flight(path, mapping)
    rows = _digest(recording)
    recording, removals = clean_recording(recording)
    lags = find_lags(recording)
    recording = shift_topics(recording, lags)
    mount = find_mount(recording)
    if mount is not None:
        recording = turn_pose(recording, mount)
    given = recording.quantities
    if "rates" not in given and "orientation" not in given:
        raise InputError(f"{path}: the recording has neither rates nor an orientation. Log rates.")
    if "commands" not in given and "rotors" not in given:
        raise InputError(f"{path}: the recording has neither commands nor rotor speeds. Log one.")
    has_pose = "position" in given and "orientation" in given
    rates = given["rates"] if "rates" in given else compute_rates(given["orientation"])
    velocity = None
    if has_pose:
        position = given["position"]
        slope = fit_locally(position.time, position.values, position.time, _REACH)[1]
        velocity = Series(position.time, slope)
    return PreparedFlight(
        str(path),
        given["position"] if has_pose else None,
        given["orientation"] if has_pose else None,
        rates,
        velocity,
        given.get("commands"),
        given.get("rotors"),
        given.get("battery"),
        given.get("setpoint"),
        given.get("setpoint_yaw"),
        recording.spin,
        find_span(recording),
        _join_gaps(recording, has_pose),
        lags,
        0.0 if mount is None else float(np.degrees(2 * np.arccos(min(1.0, abs(mount[3]))))),
        removals,
        rows,
        "rates" not in given,
    )


def check_copies(fitted: List[PreparedFlight], judged: List[PreparedFlight]) -> None:
    """Raise `InputError` if a judged flight is a copy of a fitted flight."""
    for one in fitted:
        for other in judged:
            same = len(one.rows & other.rows) / max(1, min(len(one.rows), len(other.rows)))
            if same > _SAME:
                raise InputError(
                    f"{other.where}: {100 * same:.0f} % of the rows are those of {one.where}. "
                    "Judge on another flight."
                )


def _digest(recording: Recording) -> set:
    """Return a digest of each row without its time, because a copy may have other times."""
    rows = set()
    for name in ("position", "rates", "acceleration"):
        if name in recording.quantities:
            values = recording.quantities[name].values
            moving = np.ptp(values, axis=1) > 0
            rows |= {hashlib.md5(row.tobytes()).digest() for row in values[moving]}
    return rows


def find_span(recording: Recording) -> Tuple[float, float]:
    """Find the time in the air: the rotors turn, and the height (if known) is above the ground.

    Raises
    ------
    InputError
        If the vehicle is never in the air.
    """
    given = recording.quantities
    inputs = given.get("commands", given.get("rotors"))
    assert inputs is not None
    level = np.mean(np.abs(inputs.values), axis=1)
    turning = level > _IDLE * np.median(level[level > 0]) if (level > 0).any() else level > 0
    if "position" in given and not turning.all():  # the lowest position is on the ground
        height = given["position"].values[:, 2]
        low = float(np.percentile(height, 0.5))
        high = np.interp(inputs.time, given["position"].time, height) > low + _AIRBORNE
        if high.mean() > 0.1:
            turning &= high
    longest = _find_longest(turning)
    if longest is None:
        raise InputError(f"{recording.where}: the vehicle is never in the air.")
    begin, end = float(inputs.time[longest[0]]), float(inputs.time[longest[1]])
    return begin + _CLIMB, end - _CLIMB


def _find_longest(flags: np.ndarray) -> Optional[tuple]:
    edges = np.diff(np.concatenate([[0], flags.astype(int), [0]]))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    if len(begins) == 0:
        return None
    best = int(np.argmax(ends - begins))
    return int(begins[best]), int(ends[best])


def _join_gaps(recording: Recording, has_pose: bool) -> np.ndarray:
    names = ["rotors" if "rotors" in recording.quantities else "commands"]
    names += ["position", "orientation"] if has_pose else []
    names += ["rates"] if "rates" in recording.quantities else []
    return np.vstack([list_gaps(recording.quantities[name]) for name in names])


def split_samples(flight: PreparedFlight, half: int) -> PreparedFlight:
    """Keep every 2nd measured sample: the even (0) or the odd (1) samples.

    The noise of both halves is independent. Commands are not measured, so all are kept.
    """

    def keep(series: Optional[Series]) -> Optional[Series]:
        return None if series is None else Series(series.time[half::2], series.values[half::2])

    orientation = keep(flight.orientation)
    rates = keep(flight.rates)
    if flight.are_rates_derived and orientation is not None:
        rates = compute_rates(orientation)
    assert rates is not None
    return flight._replace(
        position=keep(flight.position),
        orientation=orientation,
        rates=rates,
        rotors=keep(flight.rotors),
    )


def smooth_rotors(flight: PreparedFlight) -> PreparedFlight:
    """Smooth the measured rotor speeds."""
    if flight.rotors is None:
        return flight
    time, values = flight.rotors
    return flight._replace(rotors=Series(time, fit_locally(time, values, time, _REACH)[0]))


def sample_state(
    flight: PreparedFlight, at: np.ndarray, nodes: int = NODES
) -> Dict[str, np.ndarray]:
    """Return the measured states at some times, from local polynomials.

    Parameters
    ----------
    flight
        Prepared flight.
    at
        Times, s.
    nodes
        Minimum number of samples on each side of each time.

    Returns
    -------
    dict
        ``rates``; with a pose also ``position``, ``orientation`` and ``velocity``.
    """
    rates, _ = fit_locally(flight.rates.time, flight.rates.values, at, 0.5 * _REACH, nodes)
    state = {"rates": rates}
    if flight.position is not None and flight.orientation is not None:
        place, slope = fit_locally(flight.position.time, flight.position.values, at, _REACH, nodes)
        aligned = interpolate_orientation(flight.orientation, flight.orientation.time)
        q, _ = fit_locally(flight.orientation.time, aligned, at, 0.5 * _REACH, nodes)
        q /= np.linalg.norm(q, axis=1, keepdims=True)
        state.update(position=place, velocity=slope, orientation=q)
    return state
