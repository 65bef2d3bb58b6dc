"""Tables in MATLAB variables: vectors, a matrix, a struct of vectors, or time and signals."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence

import numpy as np

from .._core import InputError
from .mat_types import Value, Variable
from .mat_variables import load


def read_table(path: Path, names: Sequence[str], needed: int, expected: str) -> np.ndarray:
    """Read columns in any of the supported layouts.

    Parameters
    ----------
    path
        MATLAB file that contains vectors with these names, or a single matrix or struct. A matrix
        has the columns in this order. A struct contains vectors with these names, ``time`` and
        ``signals`` with ``values`` as in Simulink, or ``Time`` and ``Data`` of a timeseries.
    names
        Names of the columns, starting with the time.
    needed
        Number of required columns.
    expected
        Description of a suitable file for messages.

    Raises
    ------
    InputError
        If the file has other contents.
    """

    def choose(held: Mapping[str, Variable]) -> Sequence[str]:
        if set(names[:needed]) <= set(held) and not _is_one_more(held, names):
            return [name for name in names if name in held]
        tables = [
            name
            for name, variable in held.items()
            if variable.is_table or (name not in names and _is_row(variable, needed, len(names)))
        ]
        if len(tables) == 1 and not set(names[:needed]) <= set(held):
            return tables
        found = ", ".join(sorted(held)) or "no variables"
        raise InputError(f"{path}: contains {found}. {expected}")

    variables = load(path, choose)
    if set(names[:needed]) <= set(variables):
        return stack_vectors(path, variables)
    [(name, value)] = variables.items()
    if isinstance(value, dict) and set(names[:needed]) <= set(value):
        if _is_one_more(value, names):
            raise InputError(f"{path}: {name} contains {', '.join(value)}. {expected}")
        return stack_vectors(path, {column: value[column] for column in names if column in value})
    table = _join_signals(value) if isinstance(value, dict) else value
    if not (
        isinstance(table, np.ndarray)
        and table.dtype.kind in "iuf"
        and table.ndim == 2
        and needed <= table.shape[1] <= len(names)
    ):
        raise InputError(f"{path}: {name} is {_describe(value)}. {expected}")
    return table.astype(float)


def _is_row(variable: Variable, least: int, most: int) -> bool:
    """Return whether an array can be a matrix with a single row, such as a constant command."""
    return (
        variable.shape[:1] == (1,) and least <= variable.shape[-1] <= most and variable.is_numbers
    )


def _is_one_more(held: Mapping[str, Any], names: Sequence[str]) -> bool:
    """Return whether the file has a column for a rotor that the model does not have."""
    return f"w{len(names)}" in held and names[-1] == f"w{len(names) - 1}"


def stack_vectors(path: Path, columns: Mapping[str, Value]) -> np.ndarray:
    """Join vectors of equal length into a table."""
    vectors = {name: check_vector(path, name, value) for name, value in columns.items()}
    first = next(iter(vectors))
    count = len(vectors[first])
    for name, column in vectors.items():
        if len(column) != count:
            raise InputError(f"{path}: {name} has {len(column)} values, {first} has {count}")
    return np.column_stack(list(vectors.values()))


def check_vector(path: Path, name: str, value: Value) -> np.ndarray:
    """Return a variable as a vector; raise `InputError` if it is not a vector of real numbers."""
    if (
        not isinstance(value, np.ndarray)
        or value.dtype.kind not in "iuf"
        or value.size != max(value.shape, default=0)
    ):
        raise InputError(f"{path}: {name} is no vector of real numbers")
    return value.ravel().astype(float)


def _join_signals(struct: Dict[str, Value]) -> Optional[np.ndarray]:
    """Join time and signals into a table; return None if the struct has another layout."""
    fields = {name.lower(): value for name, value in struct.items()}
    time = fields.get("time")
    if "signals" in fields:
        signals = fields["signals"]
        parts = [
            signal.get("values") for signal in list_signals(signals) if isinstance(signal, dict)
        ]
    else:
        parts = [fields.get("data")]
    arrays = [part for part in [time, *parts] if isinstance(part, np.ndarray)]
    if len(arrays) != 1 + len(parts) or len(parts) == 0:
        return None
    rows = arrays[0].size
    columns = [_to_rows(array, rows) for array in arrays]
    if any(column is None for column in columns):
        return None
    return np.hstack([column for column in columns if column is not None])


def list_signals(signals: Value) -> List[Any]:
    """Return the signals of a Simulink struct as a list, even if there is only one signal."""
    return signals if isinstance(signals, list) else [signals]


def _to_rows(array: np.ndarray, rows: int) -> Optional[np.ndarray]:
    """Return values with one row per time; Simulink stores vectors as (n, 1, rows)."""
    flat = np.squeeze(array)
    if flat.ndim <= 1 and flat.size == rows:
        return flat.reshape(rows, 1)
    if flat.ndim == 2 and flat.shape[0] == rows:
        return flat
    return flat.T if flat.ndim == 2 and flat.shape[1] == rows else None


def _describe(value: Value) -> str:
    if isinstance(value, dict):
        return f"a struct of {', '.join(value)}"
    if isinstance(value, np.ndarray):
        return f"an array of {'x'.join(map(str, value.shape))} {value.dtype}"
    return "no table"
