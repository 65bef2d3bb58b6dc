"""MATLAB files of version 5, a vector for each column."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any, Callable, Dict, Mapping, Sequence

import numpy as np

from .._core import InputError, QuadcoreError, log_columns
from ..files import atomic_write, check_regular, unwritable
from ..forks import LOCK
from .rows import LogRows, Table, check_log_columns, check_log_rows, split_columns, with_wrenches

_OF_PATH = ("t", "x", "y", "z")
_MOST_VALUES = 10**7  # of a variable; of commands more than three hours at 1 kHz


def read_commands(path: Path, names: Sequence[str]) -> Table:
    """Read vectors of these names.

    Raises
    ------
    InputError
        A variable is missing or no vector of real numbers, or they differ in length.
    """
    variables = _variables(path, names)
    return Table(
        _together(path, {name: _vector(path, name, variables[name]) for name in names}),
        lambda row: f"{path}: row {1 + row}",
        " (rows count from 1, as MATLAB's do)",
    )


def read_path(path: Path) -> np.ndarray:
    """Read vectors t, x, y, z and, where it is held, yaw; shape (rows, 4 or 5).

    Raises
    ------
    InputError
        A variable is missing or no vector of real numbers, or they differ in length.
    """

    def choose(held: Mapping[str, int]) -> Sequence[str]:
        if not set(_OF_PATH) <= set(held):
            found = ", ".join(sorted(held)) or "no variables"
            raise InputError(f"{path}: holds {found}; a path is {', '.join(_OF_PATH)}[, yaw]")
        return [*_OF_PATH, *(["yaw"] if "yaw" in held else [])]

    variables = _load(path, choose)
    return _together(path, {name: _vector(path, name, variables[name]) for name in variables})


def read_log(path: Path) -> LogRows:
    """Read what `write_log` wrote.

    Raises
    ------
    InputError
        No log, or a broken one.
    """
    variables = _load(path, lambda held: list(held))
    columns = [name for name in log_columns(len(variables)) if name in variables]
    of_state = check_log_columns(f"{path}", columns)
    parts = [_vector(path, name, variables[name]) for name in columns]
    wrenches = {}
    for name, value in variables.items():
        kind, _, rest = name.partition("_")
        if kind == "wrench":
            wrenches[rest] = np.asarray(value, dtype=float)
        elif kind == "topic":
            for field in value.dtype.names or ():
                columns.append(f"{rest}.{field}")
                parts.append(_vector(path, columns[-1], value[field][0, 0]))
    rows = _together(path, dict(zip(columns, parts)))
    check_log_rows(lambda row: f"{path}: row {1 + row}", rows, of_state)
    ignored = [str(name[0]) for name in variables.get("ignored", np.empty((0, 0))).flat]
    return LogRows(columns, rows, wrenches, ignored)


def _variables(path: Path, names: Sequence[str]) -> Mapping[str, Any]:
    def choose(held: Mapping[str, int]) -> Sequence[str]:
        if not set(names) <= set(held) or f"w{len(names)}" in held:
            found = ", ".join(sorted(held))
            raise InputError(
                f"{path}: holds {found or 'no variables'}; this model with {len(names) - 1} rotors "
                f"takes {', '.join(names)}"
            )
        return names

    return _load(path, choose)


def _load(path: Path, choose: Callable[[Mapping[str, int]], Sequence[str]]) -> Mapping[str, Any]:
    """Load the variables that `choose` picks, told the name and size of each that is held."""
    with LOCK:
        import scipy.io

    try:
        check_regular(path)
        with path.open("rb") as stream:
            # Sizes first: a few compressed bytes can stand for more than there is memory.
            held = {name: math.prod(shape) for name, shape, _ in scipy.io.whosmat(stream)}
            names = choose(held)
            large = [name for name in names if held[name] > _MOST_VALUES]
            if large:
                raise InputError(
                    f"{path}: {large[0]} has {held[large[0]]} values; "
                    f"at most {_MOST_VALUES} are read"
                )
            stream.seek(0)
            loaded = scipy.io.loadmat(stream, variable_names=names)
            return {name: loaded[name] for name in names}
    except QuadcoreError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except NotImplementedError as error:
        raise InputError(f"{path}: a MATLAB 7.3 file; save it with the option -v7") from error
    except Exception as error:  # scipy has no common base class for what a broken file raises
        raise InputError(f"{path}: not a MATLAB file: {error}") from error


def _together(path: Path, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    count = len(columns["t"])
    for name, column in columns.items():
        if len(column) != count:
            raise InputError(f"{path}: {name} has {len(column)} values, t has {count}")
    return np.column_stack(list(columns.values()))


def _vector(path: Path, name: str, value: np.ndarray) -> np.ndarray:
    if value.dtype.kind not in "iuf" or value.size != max(value.shape, default=0):
        raise InputError(f"{path}: {name} is no vector of real numbers")
    return value.ravel().astype(float)


def write_log(
    path: Path,
    columns: Sequence[str],
    table: np.ndarray,
    wrenches: Mapping[str, np.ndarray],
    ignored: Sequence[str],
) -> None:
    """Write each column as a vector and each wrench as ``wrench_NAME``.

    Each topic is a struct ``topic_NAME`` of a vector for each field.
    What was ignored, if anything, is the cell array ``ignored``.
    """
    of_state, topics = split_columns(columns, table)
    variables: Dict[str, Any] = {name: table[:, i] for i, name in enumerate(of_state)}
    variables.update((f"wrench_{name}", value) for name, value in wrenches.items())
    variables.update((f"topic_{name}", fields) for name, fields in topics.items())
    if ignored:
        variables["ignored"] = np.array(ignored, dtype=object)
    write_variables(path, variables)


def write_variables(path: Path, variables: Mapping[str, Any]) -> None:
    """Write arrays, and mappings of them as structs; vectors as columns."""
    with LOCK:
        import scipy.io

    with atomic_write(path) as stream:
        scipy.io.savemat(stream, dict(variables), oned_as="column", long_field_names=True)


class MatFile:
    """A log whose variables are known at the end only: rows wait in a file without name.

    It lies beside the log, where there must be room for the log as well.
    """

    def __init__(
        self, path: Path, columns: Sequence[str], terms: Sequence[str], ignored: Sequence[str]
    ) -> None:
        self.path = path
        self.wrenches = bool(terms)
        self._columns, self._terms, self._ignored = columns, terms, ignored
        self._count = 0
        try:
            self._rows = tempfile.TemporaryFile(dir=str(path.parent))  # noqa: SIM115
        except OSError as error:
            raise unwritable(path, error) from error

    def receive(self, table: np.ndarray, wrenches: np.ndarray) -> None:
        """Keep a piece."""
        rows = with_wrenches(table, wrenches if self.wrenches else None)
        try:
            self._rows.write(rows.tobytes())
            self._rows.flush()
        except OSError as error:
            raise unwritable(self.path, error) from error
        self._count += len(table)

    def close(self) -> None:
        """Write the file."""
        n = len(self._columns)
        with self._rows as stream:
            if self._count == 0:
                return
            rows = np.memmap(
                stream, dtype=float, mode="r", shape=(self._count, n + 6 * len(self._terms))
            )
            wrenches = {
                name: rows[:, n + 6 * i : n + 6 * (i + 1)] for i, name in enumerate(self._terms)
            }
            write_log(self.path, self._columns, rows[:, :n], wrenches, self._ignored)
