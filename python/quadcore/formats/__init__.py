"""Files of logs and commands: one module for each format, and the table of their suffixes."""

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
    """What can be done with files of one kind."""

    read_commands: Callable[[Path, Sequence[str]], Table]
    """read_commands(path, names): the columns of these names, as they stand."""
    write_log: Callable[[Path, Sequence[str], np.ndarray, _Wrenches, Sequence[str]], None]
    """write_log(path, columns, table, wrenches, ignored): whole or not at all. Columns named
    TOPIC.FIELD follow those of the state."""
    read_log: Callable[[Path], LogRows]
    """read_log(path): what write_log wrote."""
    log_file: Callable[[Path, Sequence[str], Sequence[str], Sequence[str]], LogFile]
    """log_file(path, columns, terms, ignored): a log that is written while it is flown, with these
    wrench terms."""


FORMATS: Dict[str, Format] = {
    ".csv": Format(csv.read_commands, csv.write_log, csv.read_log, csv.CsvFile),
    ".mat": Format(
        mat.read_commands, mat.write_log, mat.read_log, partial(DeferredLogFile, mat.write_log)
    ),
    ".bag": Format(bag.read_commands, bag.write_log, bag.read_log, bag.make_log_file),
}


def find_format(path: Path, what: str) -> Format:
    """Find the format that a file's name asks for.

    Parameters
    ----------
    path
        The file.
    what
        "logs are written to" or "commands are read from", for the error.

    Raises
    ------
    InputError
        There is none such.
    """
    found = FORMATS.get(path.suffix.lower())
    if found is None:
        raise InputError(f"{path}: {what} {', '.join(FORMATS)} files")
    return found
