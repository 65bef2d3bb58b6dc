"""Measurements of a flight in SI units and in the frames of quadcore."""

from __future__ import annotations

from types import MappingProxyType
from typing import Dict, Mapping, NamedTuple, Optional

import numpy as np

from ..._core import InputError
from .mapping import Entry, LogMapping
from .series import Columns, Series


class Recording(NamedTuple):
    """Measurements of a flight; each has its own times.

    Attributes
    ----------
    where : str
        Path of the file for messages.
    quantities : dict of str to Series
        ``position`` (m) and ``velocity`` (m/s) in the world with z up, and ``orientation`` (x, y,
        z, w). ``rates`` (rad/s) and ``acceleration`` (specific force, m/s^2) in body axes: forward,
        left, up. ``rotors`` (rad/s), signed by the spin if it is known. ``commands``, from 0 to 1
        if their range is known. ``battery`` (V). ``setpoint`` (m) and ``setpoint_yaw`` (rad) of a
        position controller, in the same axes as ``position``.
    spin : ndarray (rotors,), optional
        Direction of rotation of each rotor, 1 or -1.
    incomplete : dict of str to int
        Number of rows of each quantity that were removed because some columns lack a number.
    """

    where: str
    quantities: Dict[str, Series]
    spin: Optional[np.ndarray]
    incomplete: Mapping[str, int] = MappingProxyType({})


def map_columns(columns: Columns, mapping: LogMapping, is_shipped: bool) -> Recording:
    """Convert columns to measurements.

    Parameters
    ----------
    columns
        Columns of the file.
    mapping
        Mapping of the columns.
    is_shipped
        Whether the mapping is built in. A log may lack some columns of such a mapping; for a user's
        mapping this is an error.

    Raises
    ------
    InputError
        If a column is missing, or the file contains none of the quantities.
    """
    found: Dict[str, Series] = {}
    entries: Dict[str, Entry] = {}
    incomplete: Dict[str, int] = {}
    for name, group in mapping.entries.items():
        chosen = next((e for e in group if all(c in columns for c in e.columns)), None)
        if chosen is None and is_shipped:
            continue
        entries[name] = chosen or group[0]
        series = columns.stack(entries[name].columns)
        incomplete[name] = _count_incomplete(series)
        series = _drop_empty(_convert(name, series, entries[name], mapping))
        if len(series.time):
            found[name] = series
    if not found:
        raise InputError(f"{columns.where}: none of the columns of {mapping.where} has values.")
    if "velocity" in found and entries["velocity"].axes == "body":
        found["velocity"] = _turn_velocity(columns.where, found)
    begin = min(series.time[0] for series in found.values())
    for name, series in found.items():
        _check_time(columns.where, name, series)
        found[name] = Series((series.time - begin), series.values)
    spin = None if mapping.spin is None else np.array(mapping.spin)
    return Recording(columns.where, found, spin, incomplete)


def _convert(name: str, series: Series, entry: Entry, mapping: LogMapping) -> Series:
    values = series.values  # a copy of the columns, which may be large
    values *= entry.factor * np.array(entry.signs)
    time = series.time * (mapping.time_factor if mapping.format == "csv" else 1.0)
    if name == "orientation":
        values = _to_quaternions(values, entry.order, mapping)
    elif name in ("position", "velocity", "setpoint") and mapping.is_ned and entry.axes == "world":
        values = values[:, [1, 0, 2]] * (1, 1, -1)
    elif name == "setpoint_yaw" and mapping.is_ned:
        values = np.pi / 2 - values
    elif mapping.is_frd and (name in ("rates", "acceleration") or entry.axes == "body"):
        values *= (1, -1, -1)
    elif name in ("commands", "rotors"):
        if entry.range is not None:
            values = (values - entry.range[0]) / (entry.range[1] - entry.range[0])
        if mapping.rotor_order is not None:
            values = values[:, [number - 1 for number in mapping.rotor_order]]
        if name == "rotors" and mapping.spin is not None:
            values = np.abs(values) * mapping.spin
    return Series(time, values)


def _to_quaternions(values: np.ndarray, order: str, mapping: LogMapping) -> np.ndarray:
    """Return unit quaternions x, y, z, w of the body in the world."""
    from scipy.spatial.transform import Rotation

    if order == "roll_pitch_yaw":
        q = np.full((len(values), 4), np.nan)
        known = np.isfinite(values).all(axis=1)
        q[known] = Rotation.from_euler("ZYX", values[known][:, ::-1]).as_quat()
    else:
        q = values if order == "xyzw" else values[:, [1, 2, 3, 0]]
    with np.errstate(invalid="ignore", divide="ignore"):
        q = q / np.linalg.norm(q, axis=1, keepdims=True)
    if mapping.is_ned:  # NED to ENU: half a turn about the axis between x and y
        half = np.sqrt(0.5)
        x, y, z, w = q.T
        q = half * np.column_stack([w + z, w - z, y - x, -x - y])
    if mapping.is_frd:  # FRD to FLU: half a turn about x
        x, y, z, w = q.T
        q = np.column_stack([w, z, -y, -x])
    return q


def _count_incomplete(series: Series) -> int:
    """Count the rows that contain both numbers and gaps; a row without any number is no sample."""
    known = np.isfinite(series.values)
    return int(np.sum(known.any(axis=1) & ~(known.all(axis=1) & np.isfinite(series.time))))


def _drop_empty(series: Series) -> Series:
    kept = np.isfinite(series.values).all(axis=1) & np.isfinite(series.time)
    return series if kept.all() else Series(series.time[kept], series.values[kept])


def _turn_velocity(where: str, found: Dict[str, Series]) -> Series:
    if "orientation" not in found:
        raise InputError(f"{where}: a velocity in body axes needs an orientation. Map one.")
    from scipy.spatial.transform import Rotation

    velocity = found["velocity"]
    q = interpolate_orientation(found["orientation"], velocity.time)
    return Series(velocity.time, Rotation.from_quat(q).apply(velocity.values))


def interpolate_orientation(series: Series, time: np.ndarray) -> np.ndarray:
    """Return interpolated unit quaternions (along the chord instead of the arc)."""
    q = series.values.copy()
    flips = np.cumprod(np.where(np.sum(q[1:] * q[:-1], axis=1) < 0, -1, 1))
    q[1:] *= flips[:, None]
    between = np.column_stack([np.interp(time, series.time, column) for column in q.T])
    unit: np.ndarray = between / np.linalg.norm(between, axis=1, keepdims=True)
    return unit


def _check_time(where: str, name: str, series: Series) -> None:
    late = np.diff(series.time) < 0
    if late.any():
        raise InputError(
            f"{where}: the time of {name} goes back at sample {2 + int(late.argmax())}. Save one "
            "flight per file."
        )
