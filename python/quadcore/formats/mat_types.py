"""Values of MATLAB files: arrays, texts, cells as lists, and structs as dictionaries."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

import numpy as np

Value = Union[np.ndarray, str, List[Any], Dict[str, Any]]

_OTHERS = ("struct", "object", "char", "cell", "sparse", "function", "opaque")


class Variable(NamedTuple):
    """Shape and class of a variable before it is read."""

    shape: Tuple[int, ...]
    kind: str
    """MATLAB class of the variable."""

    @property
    def is_table(self) -> bool:
        """Whether the variable has several columns."""
        return self.kind == "struct" or (self.is_numbers and min(self.shape, default=0) > 1)

    @property
    def is_numbers(self) -> bool:
        """Whether the variable is an array of numbers."""
        return self.kind not in _OTHERS


Choose = Callable[[Mapping[str, Variable]], Sequence[str]]


def combine_parts(real: np.ndarray, imaginary: np.ndarray) -> np.ndarray:
    """Combine real and imaginary parts; a multiplication would warn about infinite parts."""
    numbers = real.astype(complex)
    numbers.imag = imaginary
    return numbers
