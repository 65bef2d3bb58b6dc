"""Variables of MATLAB files: arrays, texts, cells as lists, structs as dictionaries."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

import numpy as np

from .._core import InputError, QuadcoreError
from ..extras import needed
from ..files import check_regular
from ..forks import LOCK

Value = Union[np.ndarray, str, List[Any], Dict[str, Any]]
_MOST_VALUES = 10**7  # of a variable; of commands more than three hours at 1 kHz
_OCTAVE_TEXT = b"# Created by Octave"


class Held(NamedTuple):
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
        return self.kind not in ("struct", "char", "cell", "opaque")


Choose = Callable[[Mapping[str, Held]], Sequence[str]]


def load(path: Path, choose: Choose) -> Dict[str, Value]:
    """Load the variables that `choose` picks.

    Parameters
    ----------
    path
        Of version 4, 5, 6 or 7; with the package h5py of 7.3, or HDF5 by Octave.
    choose
        Told what is held, by name.

    Raises
    ------
    InputError
        No such file, a broken one, or one that holds too much.
    """
    try:
        check_regular(path)
        with path.open("rb") as stream:
            head = stream.read(len(_OCTAVE_TEXT))
        if head == _OCTAVE_TEXT:
            raise InputError(f"{path}: is a text by Octave; save it with the option -v7")
        return _load(path, choose)
    except QuadcoreError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except Exception as error:  # there is no common base class for what a broken file raises
        raise InputError(f"{path}: not a MATLAB file: {error}") from error


def _load(path: Path, choose: Choose) -> Dict[str, Value]:
    with path.open("rb") as stream:
        is_hdf5 = b"\x89HDF\r\n\x1a\n" in (stream.read(8), stream.seek(512) and stream.read(8))
    if is_hdf5:
        with needed(
            f"{path}: a MATLAB 7.3 file (or save it with the option -v7)", "h5py", "matlab"
        ):
            from .mat_73 import load_73
        return load_73(path, lambda held: _checked(path, choose(held), held))
    with LOCK:
        import scipy.io
    with path.open("rb") as stream:
        # Sizes first: a few compressed bytes can stand for more than there is memory.
        held = {name: Held(shape, kind) for name, shape, kind in scipy.io.whosmat(stream)}
        names = _checked(path, choose(held), held)
        stream.seek(0)
        loaded = scipy.io.loadmat(stream, variable_names=names)
        return {name: _plain(loaded[name]) for name in names}


def _checked(path: Path, names: Sequence[str], held: Mapping[str, Held]) -> Sequence[str]:
    for name in names:
        values = math.prod(held[name].shape)
        if values > _MOST_VALUES:
            raise InputError(f"{path}: {name} has {values} values; at most {_MOST_VALUES} are read")
    return names


def _plain(value: Any) -> Value:
    """Take scipy's arrays of objects apart."""
    if value.dtype.names is not None:
        if type(value).__name__ == "MatlabOpaque":
            return "an object of MATLAB"
        structs = [{name: _plain(item[name]) for name in value.dtype.names} for item in value.flat]
        return structs[0] if len(structs) == 1 else structs
    if value.dtype == object:
        return [_plain(item) for item in value.flat]
    if value.dtype.kind == "U":
        return str(value.item()) if value.size == 1 else ""
    return np.asarray(value)
