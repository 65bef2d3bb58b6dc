"""Files of logs and commands: a module for each format, and a table of their suffixes."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Callable, Dict, Mapping, NamedTuple, Sequence

import numpy as np

from .._core import InputError
from . import bag, csv, mat
from .rows import LogFile, LogRows, Table
from .whole_log import DeferredLogFile

_Wrenches = Mapping[str, np.ndarray]


class Format(NamedTuple):
    """Functions to read and write one file format."""

    read_commands: Callable[[Path, Sequence[str]], Table]
    """read_commands(path, names): read the columns with these names, without checks."""
    write_log: Callable[[Path, Sequence[str], np.ndarray, _Wrenches, Sequence[str]], None]
    """write_log(path, columns, table, wrenches, ignored): write a complete log, or nothing. Columns
    ``TOPIC.FIELD`` follow those of the state."""
    read_log: Callable[[Path], LogRows]
    """read_log(path): read a file written by write_log."""
    log_file: Callable[[Path, Sequence[str], Sequence[str], Sequence[str]], LogFile]
    """log_file(path, columns, terms, ignored): make a recorder that writes during the flight."""


FORMATS: Dict[str, Format] = {
    ".csv": Format(csv.read_commands, csv.write_log, csv.read_log, csv.CsvFile),
    ".mat": Format(
        mat.read_commands, mat.write_log, mat.read_log, partial(DeferredLogFile, mat.write_log)
    ),
    ".bag": Format(bag.read_commands, bag.write_log, bag.read_log, bag.make_log_file),
    bag.ROS2: Format(bag.read_commands, bag.write_ros2_log, bag.read_log, bag.make_log_file),
}


def find_format(path: Path, what: str) -> Format:
    """Return the format that the suffix of a path selects.

    Parameters
    ----------
    path
        File to read or write.
    what
        Start of the error message: "logs are written to" or "commands are read from".

    Raises
    ------
    InputError
        If no format has this suffix.
    """
    found = FORMATS.get(bag.ROS2 if bag.is_ros2(path) else path.suffix.lower())
    if found is None:
        raise InputError(f"{path}: {what} {', '.join(FORMATS)} files")
    return found
