"""MATLAB files of version 7.3, and HDF5 files of Octave."""

from __future__ import annotations

from typing import IO, Any, Dict

import h5py
import numpy as np

from .mat_types import Choose, Value, Variable

_OF_MATLAB = "#"  # first character of the names of MATLAB's internal groups


def load_73(stream: IO[bytes], choose: Choose) -> Dict[str, Value]:
    """Load the variables that `choose` selects; errors of h5py propagate."""
    with h5py.File(stream, "r") as file:
        items = {name: _unwrap(item) for name, item in file.items() if name[0] != _OF_MATLAB}
        held = {name: _describe(item) for name, item in items.items()}
        return {name: _read_value(file, items[name]) for name in choose(held)}


def _unwrap(item: Any) -> Any:
    """Return the content of a variable; Octave stores it in a group with its type."""
    is_wrapped = isinstance(item, h5py.Group) and set(item) >= {"type", "value"}
    return item["value"] if is_wrapped else item


def _describe(item: Any) -> Variable:
    if isinstance(item, h5py.Group):
        return Variable((1, 1), "struct")
    return Variable(item.shape[::-1], _find_kind(item))


def _find_kind(item: Any) -> str:
    kind = item.attrs.get("MATLAB_class", b"double")
    return kind.decode() if isinstance(kind, bytes) else str(kind)


def _read_value(file: Any, item: Any) -> Value:
    item = _unwrap(item)
    if isinstance(item, h5py.Group):
        fields = {name: _read_value(file, part) for name, part in item.items()}
        if fields and all(isinstance(value, list) for value in fields.values()):
            return [dict(zip(fields, row)) for row in zip(*fields.values())]  # array of structs
        return fields
    if item.dtype == h5py.ref_dtype:
        return [_read_value(file, file[reference]) for reference in item[()].T.flat]
    if item.attrs.get("MATLAB_empty", 0):
        return "" if _find_kind(item) == "char" else np.empty((0, 0))
    numbers = np.asarray(item[()]).T  # column-major order
    if _find_kind(item) == "char":
        return "".join(map(chr, numbers.flat))
    return numbers
