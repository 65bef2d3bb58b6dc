"""Mappings: files that assign the columns of a log to the quantities of a flight."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Tuple, Union

from ..._core import InputError
from ...support.input_files import read_text
from ...support.parameters import suggest
from .units import UNITS

QUANTITIES: Dict[str, int] = {
    "position": 3,
    "orientation": 0,
    "velocity": 3,
    "rates": 3,
    "acceleration": 3,
    "rotors": 0,
    "commands": 0,
    "battery": 1,
    "setpoint": 3,
    "setpoint_yaw": 1,
}
"""Number of columns of each quantity of a recording; 0 if the number varies."""

_SETPOINT = "setpoint"
_ORDERS = {"xyzw": 4, "wxyz": 4, "roll_pitch_yaw": 3}
_FOLDER = Path(__file__).parent / "mappings"
_TOP = ("format", "time", "world", "body", "rotor_order", "spin", *QUANTITIES)
_ENTRY = ("columns", "unit", "signs")
_ENTRY_OF = {"orientation": ("order",), "velocity": ("axes",), "commands": ("range",)}
"""Additional keys of some quantities."""

FORMATS = ("csv", "crazyflie", "ulog", "blackbox", "bag")


class Entry(NamedTuple):
    """Columns of a quantity.

    Attributes
    ----------
    columns : list of str
        Names of the columns.
    factor : float
        Factor from the unit of the columns to SI units.
    signs : list of float
        Sign of each column.
    order : str
        Order of the components of an orientation: xyzw, wxyz or roll_pitch_yaw.
    axes : str
        Axes of a velocity: world or body.
    range : pair of float, optional
        Command values that correspond to 0 and 1.
    """

    columns: List[str]
    factor: float
    signs: List[float]
    order: str
    axes: str
    range: Optional[Tuple[float, float]]


class LogMapping(NamedTuple):
    """Mapping for one kind of log.

    Attributes
    ----------
    where : str
        Path of the file for messages.
    format : str
        Format of the log, one of `FORMATS`.
    time : str
        Time column of a CSV file.
    time_factor : float
        Factor from the unit of the time column to seconds.
    is_ned, is_frd : bool
        Whether the world axes are north, east, down, and the body axes forward, right, down.
    rotor_order : list of int, optional
        Motor number in the log, starting at 1, for each rotor of the model.
    spin : list of float, optional
        Direction of rotation of each rotor of the model about its axis, 1 or -1.
    entries : dict
        Entries of each quantity. The first entry for which all columns exist is used.
    """

    where: str
    format: str
    time: str
    time_factor: float
    is_ned: bool
    is_frd: bool
    rotor_order: Optional[List[int]]
    spin: Optional[List[float]]
    entries: Dict[str, List[Entry]]

    def list_columns(self) -> List[str]:
        """List the columns of all entries."""
        return [name for group in self.entries.values() for each in group for name in each.columns]

    def list_measured(self) -> List[str]:
        """List the columns of all entries except the set-points, which few logs contain."""
        measured = {n: group for n, group in self.entries.items() if not n.startswith(_SETPOINT)}
        return self._replace(entries=measured).list_columns()


def list_mappings() -> List[str]:
    """List the names of the built-in mappings."""
    return sorted(path.stem for path in _FOLDER.glob("*.yaml"))


def read_mapping(given: Union[str, Path]) -> LogMapping:
    """Read a mapping from a file, or by its built-in name.

    Raises
    ------
    InputError
        If the file is missing or invalid; the message begins with the file.
    """
    import yaml  # slow to import

    path = Path(given)
    if str(given) in list_mappings():
        path = _FOLDER / f"{given}.yaml"
    elif path.suffix not in (".yaml", ".yml"):
        known = list_mappings()
        raise InputError(
            f"mapping '{given}' does not exist.{suggest(str(given), known)} Give a .yaml file, or "
            f"one of {', '.join(known)}."
        )
    try:
        content = yaml.safe_load(read_text(path))
    except yaml.YAMLError as error:
        line = getattr(getattr(error, "problem_mark", None), "line", 0) + 1
        raise InputError(f"{path}:{line}: this is not YAML. Correct the file.") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}:1: the mapping is empty. Write the columns of each quantity.")
    return _check_mapping(str(path), content)


def _check_mapping(where: str, content: Mapping[str, Any]) -> LogMapping:
    _check_keys(where, content, _TOP)
    kind = _choose(where, content, "format", FORMATS)
    time = content.get("time", {})
    _check_keys(f"{where}: time", time, ("column", "unit"))
    if kind == "csv" and "column" not in time:
        raise InputError(f"{where}: time has no column. Write time: {{column: NAME, unit: s}}.")
    entries: Dict[str, List[Entry]] = {}
    for name in QUANTITIES:
        if name in content:
            given = content[name] if isinstance(content[name], list) else [content[name]]
            entries[name] = [_check_entry(f"{where}: {name}", name, each) for each in given]
    if not entries:
        raise InputError(f"{where}: no quantity is mapped. Map some of {', '.join(QUANTITIES)}.")
    return LogMapping(
        where,
        kind,
        str(time.get("column", "")),
        _read_unit(f"{where}: time", time, "s"),
        _choose(where, content, "world", ("ENU", "NED"), "ENU") == "NED",
        _choose(where, content, "body", ("FLU", "FRD"), "FLU") == "FRD",
        _read_numbers(where, content, "rotor_order", int),
        _read_numbers(where, content, "spin", float),
        entries,
    )


def _check_entry(where: str, name: str, given: Any) -> Entry:
    _check_keys(where, given, (*_ENTRY, *_ENTRY_OF.get(name, ())))
    columns = given.get("columns")
    columns = [columns] if isinstance(columns, str) else columns
    if not isinstance(columns, list) or not columns:
        raise InputError(f"{where}: columns is missing. Write a list of names.")
    order = _choose(where, given, "order", tuple(_ORDERS), "xyzw")
    expected = _ORDERS[order] if name == "orientation" else QUANTITIES[name]
    if expected and len(columns) != expected:
        raise InputError(f"{where}: {len(columns)} columns instead of {expected}. Name {expected}.")
    signs = _read_numbers(where, given, "signs", float) or [1.0] * len(columns)
    if len(signs) != len(columns):
        raise InputError(
            f"{where}: {len(signs)} signs for {len(columns)} columns. Write one for each."
        )
    limits = _read_numbers(where, given, "range", float)
    if limits is not None and (len(limits) != 2 or limits[0] >= limits[1]):
        raise InputError(f"{where}: range is {limits}. Write [LOW, HIGH].")
    return Entry(
        [str(column) for column in columns],
        _read_unit(where, given, "1"),
        signs,
        order,
        _choose(where, given, "axes", ("world", "body"), "world"),
        None if limits is None else (limits[0], limits[1]),
    )


def _check_keys(where: str, given: Any, known: Tuple[str, ...]) -> None:
    if not isinstance(given, dict):
        raise InputError(f"{where}: this is no mapping of names to values.")
    for key in given:
        if key not in known:
            raise InputError(
                f"{where}: '{key}' is unknown.{suggest(str(key), known)} Use {', '.join(known)}."
            )


def _choose(
    where: str,
    given: Mapping[str, Any],
    key: str,
    known: Tuple[str, ...],
    fallback: Optional[str] = None,
) -> str:
    value = str(given.get(key, fallback))
    if value not in known:
        raise InputError(f"{where}: {key} is '{value}'. Use one of {', '.join(known)}.")
    return value


def _read_unit(where: str, given: Mapping[str, Any], fallback: str) -> float:
    unit = str(given.get("unit", fallback))
    if unit not in UNITS:
        raise InputError(f"{where}: unit '{unit}' is unknown. Use one of {', '.join(UNITS)}.")
    return UNITS[unit]


def _read_numbers(where: str, given: Mapping[str, Any], key: str, kind: Any) -> Optional[List[Any]]:
    value = given.get(key)
    if value is None:
        return None
    if not isinstance(value, list) or not all(
        isinstance(v, (int, float)) and not isinstance(v, bool) for v in value
    ):
        raise InputError(f"{where}: {key} is no list of numbers.")
    return [kind(v) for v in value]
