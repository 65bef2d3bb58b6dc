"""MATLAB files: any version for reading, version 5 for writing."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Tuple

import numpy as np

from .._core import InputError, log_columns
from ..support.import_lock import LOCK
from ..support.output_files import atomic_write
from .mat_tables import list_signals, read_table, stack_vectors
from .mat_types import Value
from .mat_variables import load
from .rows import LogRows, Table, check_log_columns, check_log_rows, split_columns

_OF_PATH = ("t", "x", "y", "z", "yaw")
_LOG = "log"
"""Name of the variable in all layouts except "vectors"."""

LAYOUTS = ("vectors", "struct", "matrix", "signals")
"""Layouts of a log: a vector per column, a struct of these vectors, a matrix with the names of its
columns, or time and signals as in Simulink."""


def read_commands(path: Path, names: Sequence[str]) -> Table:
    """Read columns by name; see `read_table`.

    Raises
    ------
    InputError
        If a column is missing, is not a vector of real numbers, or differs in length.
    """
    expected = (
        f"For {len(names) - 1} rotors, save {', '.join(names)}, or one matrix or struct of them"
    )
    return Table(
        read_table(path, names, len(names), expected),
        lambda row: f"{path}: row {1 + row}",
        " (rows count from 1, as MATLAB's do)",
    )


def read_path(path: Path) -> np.ndarray:
    """Read t, x, y, z and, if present, yaw; shape (rows, 4 or 5).

    Raises
    ------
    InputError
        If a column is missing, is not a vector of real numbers, or differs in length.
    """
    expected = "Save t, x, y, z[, yaw], or one matrix or struct of them."
    return read_table(path, _OF_PATH, 4, expected)


def read_log(path: Path) -> LogRows:
    """Read a file written by `write_log`, in any layout.

    Raises
    ------
    InputError
        If the file is damaged or contains no log.
    """
    variables = _split_layout(path, load(path, list))
    columns = [name for name in log_columns(len(variables)) if name in variables]
    of_state = check_log_columns(f"{path}", columns)
    parts = {name: variables[name] for name in columns}
    wrenches: Dict[str, np.ndarray] = {}
    for name, value in variables.items():
        kind, _, rest = name.partition("_")
        if kind == "wrench":
            wrenches[rest] = _read_wrench(path, name, value)
        elif kind == "topic" and isinstance(value, dict):
            parts.update((f"{rest}.{field}", column) for field, column in value.items())
    rows = stack_vectors(path, parts)
    for name, wrench in wrenches.items():
        if len(wrench) != len(rows):
            raise InputError(f"{path}: wrench_{name} has {len(wrench)} rows, the log {len(rows)}")
    check_log_rows(lambda row: f"{path}: row {1 + row}", rows, of_state)
    ignored = variables.get("ignored", [])
    names = [ignored] if isinstance(ignored, str) else [str(name) for name in ignored]
    return LogRows(list(parts), rows, wrenches, names)


def _read_wrench(path: Path, name: str, value: Any) -> np.ndarray:
    wrench = np.asarray(value)
    if wrench.dtype.kind not in "iuf" or wrench.ndim != 2 or wrench.shape[1] != 6:
        raise InputError(f"{path}: {name} is not a matrix of 6 columns. Give force and torque.")
    return wrench.astype(float)


def _split_layout(path: Path, variables: Dict[str, Value]) -> Dict[str, Any]:
    """Convert a log of any layout to the layout of vectors."""
    log = variables.get(_LOG)
    if isinstance(log, np.ndarray) and log.ndim == 2:
        named = variables.get("columns")
        rotors = max(0, log.shape[1] - len(log_columns(0)))
        names = named if isinstance(named, list) else log_columns(rotors)
        if len(names) != log.shape[1]:
            raise InputError(
                f"{path}: {_LOG} has {log.shape[1]} columns, {len(names)} are named. Name each in "
                "the cell array columns."
            )
        of_state, topics = split_columns(list(map(str, names)), log)
        vectors: Dict[str, Any] = {name: log[:, [i]] for i, name in enumerate(of_state)}
        vectors.update((f"topic_{name}", fields) for name, fields in topics.items())
        rest = {name: v for name, v in variables.items() if name not in (_LOG, "columns")}
        return {**vectors, **rest}
    if not isinstance(log, dict):
        return variables
    if not set(log) >= {"time", "signals"}:
        return log
    vectors = {"t": log["time"]}
    for label, values in _add_labels(path, log["signals"]):
        topic, is_topic, field = label.partition(".")
        if is_topic:
            vectors.setdefault(f"topic_{topic}", {})[field] = values
        else:
            vectors[label] = values
    return {**vectors, **{name: value for name, value in variables.items() if name != _LOG}}


def _add_labels(path: Path, signals: Any) -> Iterator[Tuple[str, Any]]:
    for signal in list_signals(signals):
        if not isinstance(signal, dict) or not set(signal) >= {"label", "values"}:
            raise InputError(f"{path}: {_LOG}.signals: give each a label and values")
        yield str(signal["label"]), signal["values"]


def write_log(
    path: Path,
    columns: Sequence[str],
    table: np.ndarray,
    wrenches: Mapping[str, np.ndarray],
    ignored: Sequence[str],
    layout: str = LAYOUTS[0],
) -> None:
    """Write each column as a vector and each wrench as ``wrench_NAME``.

    Each topic is a struct ``topic_NAME`` with one vector per field. If there are ignored parts, the
    cell array ``ignored`` contains them. All other `LAYOUTS` write the variable ``log``.
    """
    if layout not in LAYOUTS:
        raise InputError(f"layout '{layout}' does not exist. Use one of {', '.join(LAYOUTS)}.")
    of_state, topics = split_columns(columns, table)
    variables: Dict[str, Any] = {name: table[:, i] for i, name in enumerate(of_state)}
    variables.update((f"wrench_{name}", value) for name, value in wrenches.items())
    variables.update((f"topic_{name}", fields) for name, fields in topics.items())
    named = {"ignored": np.array(ignored, dtype=object)} if ignored else {}
    if layout == "struct":
        variables = {_LOG: {**variables, **named}}
    elif layout == "matrix":
        acting = {name: value for name, value in variables.items() if name.startswith("wrench_")}
        named["columns"] = np.array(list(columns), dtype=object)
        variables = {_LOG: table, **acting}
    elif layout == "signals":
        variables = {_LOG: _make_signals(variables)}
    write_variables(path, {**variables, **named} if layout != "struct" else variables)


def _make_signals(variables: Mapping[str, Any]) -> Dict[str, Any]:
    """Convert the variables of a log to the Simulink format "structure with time"."""
    labelled: List[Tuple[str, np.ndarray]] = []
    for name, value in variables.items():
        if isinstance(value, dict):
            topic = name[len("topic_") :]
            labelled += [(f"{topic}.{field}", column) for field, column in value.items()]
        elif name != "t":
            labelled.append((name, value))
    kinds = [("values", object), ("dimensions", object), ("label", object)]
    signals = np.empty((1, len(labelled)), dtype=kinds)
    for i, (label, values) in enumerate(labelled):
        whole = values.reshape(len(values), -1)
        signals[0, i] = (whole, float(whole.shape[1]), label)
    return {"time": variables["t"], "signals": signals}


def write_variables(path: Path, variables: Mapping[str, Any]) -> None:
    """Write arrays as variables and mappings as structs; vectors become column vectors."""
    with LOCK:
        import scipy.io

    with atomic_write(path) as stream:
        scipy.io.savemat(stream, dict(variables), oned_as="column", long_field_names=True)
