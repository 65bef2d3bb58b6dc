"""Variables of MATLAB files of versions 5, 6 and 7.

SciPy's reader trusts the sizes and types in a file, and crashes if they are wrong. This reader
checks them first.
"""

from __future__ import annotations

import math
import zlib
from typing import Dict, List, NamedTuple, Tuple

import numpy as np

from .mat_elements import COMPRESSED, HEADER, MATRIX, Elements, find_byte_order
from .mat_types import Choose, Value, Variable, combine_parts

_LARGEST = 10**9  # maximum size of a variable, bytes
_DEEPEST = 32  # maximum nesting depth of cells and structs
_BEGINNING = 4096  # bytes that contain the dimensions and the name of any variable

_CLASSES = {
    1: "cell",
    2: "struct",
    3: "object",
    4: "char",
    5: "sparse",
    6: "double",
    7: "single",
    8: "int8",
    9: "uint8",
    10: "int16",
    11: "uint16",
    12: "int32",
    13: "uint32",
    14: "int64",
    15: "uint64",
    16: "function",
    17: "opaque",
}
_UNREAD = ("sparse", "function", "opaque")
_LOGICAL, _COMPLEX = 0x200, 0x800


def is_5(data: bytes) -> bool:
    """Return whether a file has one of these versions."""
    return find_byte_order(data) is not None


def load_5(data: bytes, choose: Choose) -> Dict[str, Value]:
    """Load the variables that `choose` selects; raise ValueError if the file is damaged."""
    elements = Elements(memoryview(data)[HEADER:], find_byte_order(data) or "<")
    found: Dict[str, Tuple[int, Elements]] = {}
    held: Dict[str, Variable] = {}
    while elements:
        kind, content = elements.take()
        matrix = _read_head(_inflate(content, _BEGINNING) if kind == COMPRESSED else content)
        if matrix.name:  # only the shared data of MATLAB objects have no name
            found[matrix.name] = kind, Elements(content.data, content.order)
            held[matrix.name] = Variable(matrix.shape, matrix.kind)
    return {name: _read_variable(*found[name]) for name in choose(held)}


def _read_variable(kind: int, content: Elements) -> Value:
    return _read_value(_inflate(content, _LARGEST) if kind == COMPRESSED else content)


def _inflate(content: Elements, most: int) -> Elements:
    """Decompress a variable, or its first `most` bytes."""
    stream = zlib.decompressobj()
    try:
        head = Elements(memoryview(stream.decompress(content.data, 8)), content.order)
        size = head.take_size(MATRIX)
        if size > _LARGEST:
            raise ValueError(f"a variable of {size} bytes is larger than {_LARGEST}")
        data = stream.decompress(stream.unconsumed_tail, min(size, most)) if size else b""
        if size <= most:
            stream.decompress(stream.unconsumed_tail, 1)  # the rest, for the checksum
            if len(data) < size or not stream.eof:
                raise ValueError("a compressed variable is not whole")
    except zlib.error as error:
        raise ValueError(f"a compressed variable is damaged ({error})") from error
    return Elements(memoryview(data), content.order)


class _Matrix(NamedTuple):
    """Header of a variable, cell or field."""

    kind: str
    shape: Tuple[int, ...]
    name: str
    is_complex: bool
    content: Elements


def _read_head(parts: Elements) -> _Matrix:
    flags = parts.take_numbers("u4")
    kind = _CLASSES.get(int(flags[0]) & 0xFF) if len(flags) == 2 else None
    if kind is None:
        raise ValueError("a variable is of no class of MATLAB")
    shape: Tuple[int, ...] = (1, 1)
    if kind != "opaque":
        shape = tuple(parts.take_numbers("i4").tolist())
    if not 2 <= len(shape) <= 32 or min(shape) < 0:
        raise ValueError(f"a variable has the dimensions {shape}")
    name = parts.take_text()
    is_logical, is_complex = (bool(flags[0] & flag) for flag in (_LOGICAL, _COMPLEX))
    return _Matrix("logical" if is_logical else kind, shape, name, is_complex, parts)


def _read_value(parts: Elements, level: int = 0) -> Value:
    if not parts:
        return np.empty((0, 0))
    if level > _DEEPEST:
        raise ValueError(f"cells and structs are nested deeper than {_DEEPEST} levels")
    matrix = _read_head(parts)
    if matrix.kind in _UNREAD:
        return f"of class {matrix.kind}"
    if matrix.kind == "char":
        text = parts.take_text()
        return text if matrix.shape[0] == 1 else ""
    if matrix.kind == "cell":
        return _read_contents(matrix, 1, level)
    if matrix.kind in ("struct", "object"):
        return _read_structs(matrix, level)
    numbers = _read_array(matrix)
    return combine_parts(numbers, _read_array(matrix)) if matrix.is_complex else numbers


def _read_array(matrix: _Matrix) -> np.ndarray:
    """Read real numbers in their stored type, which is often smaller than the class."""
    numbers = matrix.content.take_numbers()
    if len(numbers) != math.prod(matrix.shape):
        raise ValueError(f"{len(numbers)} numbers for the dimensions {matrix.shape}")
    return numbers.reshape(matrix.shape, order="F")


def _read_contents(matrix: _Matrix, each: int, level: int) -> List[Value]:
    """Read the contents of all elements, each with a fixed number of variables."""
    count = each * math.prod(matrix.shape)
    if 8 * count > len(matrix.content.data):  # a tag alone takes 8 bytes
        raise ValueError(f"{len(matrix.content.data)} bytes hold no {count} variables")
    return [_read_value(matrix.content.take_matrix(), level + 1) for _ in range(count)]


def _read_structs(matrix: _Matrix, level: int) -> Value:
    """Read a struct, or an array of structs."""
    parts = matrix.content
    if matrix.kind == "object":
        parts.take_text()  # skip the name of the class
    lengths = parts.take_numbers("i4")
    names = parts.take_bytes()
    if len(lengths) != 1 or lengths[0] < 1 or len(names) % lengths[0]:
        raise ValueError("a struct has damaged names of fields")
    width = int(lengths[0])
    fields = [names[i : i + width].split(b"\0")[0].decode() for i in range(0, len(names), width)]
    values = _read_contents(matrix, len(fields), level)
    if not fields:
        return {}
    starts = range(0, len(values), len(fields))
    structs: List[Value] = [dict(zip(fields, values[i : i + len(fields)])) for i in starts]
    return structs[0] if len(structs) == 1 else structs
