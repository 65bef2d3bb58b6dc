"""Variables of MATLAB files of any version."""

from __future__ import annotations

import math
from pathlib import Path
from typing import IO, Dict, Mapping, Sequence

from .._core import InputError, QuadcoreError
from ..support.input_files import open_file, read_whole
from ..support.optional_packages import require_package
from .mat_4 import load_4
from .mat_5 import is_5, load_5
from .mat_types import Choose, Value, Variable

_LARGEST = 10**9  # maximum size of a file before version 7.3, bytes
_MOST_VALUES = 10**7  # maximum size of a variable: commands for more than three hours at 1 kHz
_OCTAVE_TEXT = b"# Created by Octave"
_HDF5 = b"\x89HDF\r\n\x1a\n"


def load(path: Path, choose: Choose) -> Dict[str, Value]:
    """Load the variables that `choose` selects.

    Parameters
    ----------
    path
        File of version 4, 5, 6 or 7. With the package h5py also version 7.3, or HDF5 of Octave.
    choose
        Function that takes all variables by name and returns the names of those to load.

    Raises
    ------
    InputError
        If the file is missing, damaged or too large.
    """
    with open_file(path) as stream:
        try:
            return _load(path, stream, choose)
        except (QuadcoreError, OSError):
            raise
        except Exception as error:  # a damaged file can raise any exception
            raise InputError(f"{path}: not a MATLAB file: {error}. Save it again.") from error


def _load(path: Path, stream: IO[bytes], choose: Choose) -> Dict[str, Value]:
    head = stream.read(520)
    stream.seek(0)
    if head.startswith(_OCTAVE_TEXT):
        raise InputError(f"{path}: is a text file of Octave. Save it with the option -v7.")

    def chosen(held: Mapping[str, Variable]) -> Sequence[str]:
        return _check_chosen(path, choose(held), held)

    if _HDF5 in (head[:8], head[512:]):
        with require_package(
            f"{path}: a MATLAB 7.3 file (or save it with the option -v7)", "h5py", "matlab"
        ):
            from .mat_73 import load_73
        return load_73(stream, chosen)
    if is_5(head):
        return load_5(read_whole(path, stream, _LARGEST), chosen)
    if 0 in head[:4]:  # files of version 5 begin with a text
        return load_4(read_whole(path, stream, _LARGEST), chosen)
    raise InputError(f"{path}: not a MATLAB file. Save it with the option -v7.")


def _check_chosen(path: Path, names: Sequence[str], held: Mapping[str, Variable]) -> Sequence[str]:
    for name in names:
        values = math.prod(held[name].shape)
        if values > _MOST_VALUES:
            raise InputError(
                f"{path}: {name} has {values} values, more than {_MOST_VALUES}. Save fewer."
            )
    return names
