"""CSV files with arbitrary column names."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List, Sequence

import numpy as np

from ..._core import InputError
from ...support.parameters import suggest
from .series import Columns, make_columns


def read_header(path: Path, data: bytes) -> List[str]:
    """Return the names of the columns; raise `InputError` if the file is not text."""
    line = data[: data.find(b"\n") if b"\n" in data else len(data)]
    try:
        return [name.strip().strip('"') for name in line.decode("utf-8-sig").split(",")]
    except UnicodeDecodeError:
        raise InputError(f"{path}: its format is unknown. Name another file.") from None


def read_table(path: Path, data: bytes, wanted: Sequence[str], time: str) -> Columns:
    """Read columns of numbers; empty cells become NaN.

    Parameters
    ----------
    path, data
        Path of the file, and its content.
    wanted
        Names of the columns to read; missing columns are skipped.
    time
        Name of the time column.

    Raises
    ------
    InputError
        If the time column is missing, or a cell is not a number.
    """
    header = read_header(path, data)
    if time not in header:
        raise InputError(
            f"{path}:1: column '{time}' of the time does not exist.{suggest(time, header)}"
        )
    names = [name for name in dict.fromkeys([time, *wanted]) if name in header]
    places = [header.index(name) for name in names]
    try:
        lines = data.decode("utf-8-sig").splitlines()[1:]
    except UnicodeDecodeError:
        raise InputError(f"{path}: its format is unknown. Name another file.") from None
    table = np.empty((len(lines), len(names)))
    count = 0
    for number, line in enumerate(lines, start=2):
        if not line.strip():
            continue
        cells = line.split(",")
        if len(cells) != len(header):
            raise InputError(f"{path}:{number}: {len(cells)} columns instead of {len(header)}.")
        try:
            table[count] = [float(cells[i]) if cells[i].strip() else np.nan for i in places]
        except ValueError:
            wrong = next(cells[i] for i in places if not _is_number(cells[i]))
            raise InputError(f"{path}:{number}: '{wrong.strip()}' is no number.") from None
        count += 1
    columns: Dict[str, np.ndarray] = dict(zip(names, table[:count].T))
    return make_columns(str(path), columns[time], columns)


def _is_number(text: str) -> bool:
    try:
        float(text or "nan")
    except ValueError:
        return not text.strip()
    return True
