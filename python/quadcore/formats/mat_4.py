"""Variables of MATLAB files of version 4: matrices and texts."""

from __future__ import annotations

import struct
from typing import Dict, Tuple

import numpy as np

from .mat_types import Choose, Value, Variable, combine_parts

_HEADER = 20  # bytes: MOPT, rows, columns, complex flag, length of the name
_TYPES = ("f8", "f4", "i4", "i2", "u2", "u1")
_CLASSES = ("double", "char", "sparse")


def load_4(data: bytes, choose: Choose) -> Dict[str, Value]:
    """Load the variables that `choose` selects; raise ValueError if the file is damaged."""
    found: Dict[str, Tuple[Variable, np.ndarray]] = {}
    rest = memoryview(data)
    while rest:
        name, held, size, dtype = _read_header(rest)
        begin = _HEADER + len(name) + 1
        if begin + size > len(rest):
            raise ValueError(f"{size} bytes of a variable are not all there")
        found[name.decode("latin-1")] = held, np.frombuffer(rest[begin : begin + size], dtype)
        rest = rest[begin + size :]
    names = choose({name: held for name, (held, _) in found.items()})
    return {name: _read_value(*found[name]) for name in names}


def _read_header(data: memoryview) -> Tuple[bytes, Variable, int, np.dtype]:
    """Return the name, the shape and kind, the size in bytes and the number type of a variable."""
    if len(data) < _HEADER:
        raise ValueError("it ends within a header")
    order = "<" if struct.unpack_from("<i", data)[0] in range(5000) else ">"
    mopt, rows, columns, is_complex, length = struct.unpack_from(f"{order}5i", data)
    name = bytes(data[_HEADER : _HEADER + max(0, length)])
    machine, reserved, precision, kind = (mopt // 10**digit % 10 for digit in (3, 2, 1, 0))
    if (
        mopt // 10**4
        or machine != "<>".index(order)
        or reserved
        or precision >= len(_TYPES)
        or kind >= len(_CLASSES)
        or min(rows, columns) < 0
        or is_complex not in (0, 1)
        or len(name) != length
        or name[-1:] != b"\0"
    ):
        raise ValueError("a variable has a damaged header")
    dtype = np.dtype(f"{order}{_TYPES[precision]}")
    held = Variable((rows, columns), _CLASSES[kind])
    return name[:-1], held, rows * columns * (1 + is_complex) * dtype.itemsize, dtype


def _read_value(held: Variable, numbers: np.ndarray) -> Value:
    if held.kind == "sparse":
        return "of class sparse"
    if held.kind == "char":
        return numbers.astype("uint8").tobytes().decode("latin-1") if held.shape[0] == 1 else ""
    count = held.shape[0] * held.shape[1]
    if len(numbers) > count:
        numbers = combine_parts(numbers[:count], numbers[count:])
    return numbers.reshape(held.shape, order="F")
