"""What a MATLAB file holds: arrays, texts, cells as lists, structs as dictionaries."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

import numpy as np

Value = Union[np.ndarray, str, List[Any], Dict[str, Any]]

_OTHERS = ("struct", "object", "char", "cell", "sparse", "function", "opaque")


class Variable(NamedTuple):
    """A variable before it is read."""

    shape: Tuple[int, ...]
    kind: str
    """MATLAB's name of its class."""

    @property
    def is_table(self) -> bool:
        """Whether it holds several columns."""
        return self.kind == "struct" or (self.is_numbers and min(self.shape, default=0) > 1)

    @property
    def is_numbers(self) -> bool:
        """Whether it is an array of them."""
        return self.kind not in _OTHERS


Choose = Callable[[Mapping[str, Variable]], Sequence[str]]


def combine_parts(real: np.ndarray, imaginary: np.ndarray) -> np.ndarray:
    """Put parts together, whatever they are: a product of infinities would warn."""
    numbers = real.astype(complex)
    numbers.imag = imaginary
    return numbers
