"""Recordings of real flights in other formats.

`read_recording` detects the format from the content of the file. A `mapping` assigns the columns to
the quantities of a flight, with units, frames and the order of the rotors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Optional, Sequence, Union

from ..._core import InputError, log_columns
from . import blackbox, crazyflie, ros, ulog
from .as_log import make_log_rows as make_log_rows
from .mapping import LogMapping, read_mapping
from .mapping import list_mappings as list_mappings
from .recording import Recording as Recording
from .recording import map_columns
from .series import Columns, read_content, read_head
from .table import read_header, read_table

_SHIPPED = {"crazyflie": "crazyflie", "ulog": "px4", "blackbox": "betaflight"}


def is_recording(path: Path) -> bool:
    """Return whether a file may be a recording of a real flight; False for a log of quadcore."""
    if path.suffix.lower() in (".mat", ".bag") or not path.is_file():
        return False
    head = read_head(path)
    if _find_format(head) != "csv":
        return True
    header = read_header(path, head)
    return header[: len(log_columns(0))] != log_columns(0) and _find_mapping(header) is not None


def read_recording(path: Path, mapping: Union[str, Path, None] = None) -> Recording:
    """Read the measurements of a flight.

    Parameters
    ----------
    path
        ULog, Crazyflie micro-SD log, blackbox log, bag or CSV file, optionally compressed by gzip.
    mapping
        Mapping file or name of a built-in mapping (default: the built-in mapping that matches).

    Raises
    ------
    InputError
        If a file is missing or damaged, or no mapping matches.
    """
    head = read_head(path)
    kind = _find_format(head)
    given = mapping
    if given is None:
        given = _SHIPPED.get(kind)
    if given is None and kind == "csv":
        given = _find_mapping(read_header(path, head))
    if given is None:
        raise InputError(
            f"{path}: no built-in mapping fits ({', '.join(list_mappings())}). Describe the "
            "columns in a file, and give it with --mapping FILE.yaml."
        )
    known = read_mapping(given)
    if known.format != kind:
        raise InputError(
            f"{path}: this is a {kind} file, but {known.where} maps {known.format} files. Give "
            "another mapping."
        )
    columns = _read_columns(path, known)
    return map_columns(columns, known, str(given) in list_mappings())


def _find_format(head: bytes) -> str:
    if blackbox.MAGIC in head:  # other data may precede it
        return "blackbox"
    starts = {"ulog": ulog.MAGIC, "crazyflie": crazyflie.MAGIC, "bag": ros.MAGIC}
    return next((kind for kind, magic in starts.items() if head.startswith(magic)), "csv")


def _find_mapping(header: Sequence[str]) -> Optional[str]:
    """Return the first built-in CSV mapping with all its measured columns in the header."""
    for name in list_mappings():
        known = read_mapping(name)
        if known.format == "csv" and {known.time, *known.list_measured()} <= set(header):
            return name
    return None


def _read_columns(path: Path, mapping: LogMapping) -> Columns:
    wanted = mapping.list_columns()
    if mapping.format == "ulog":
        return ulog.read_ulog(path, wanted)
    if mapping.format == "bag":
        return ros.read_bag(path, wanted)
    data = read_content(path)
    if mapping.format == "crazyflie":
        return crazyflie.read_crazyflie(path, data)
    if mapping.format == "blackbox":
        return blackbox.read_blackbox(path, data)
    return read_table(path, data, wanted, mapping.time)
