"""Time series in the file of a flight."""

from __future__ import annotations

import gzip
import zlib
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Dict, Iterator, Mapping, NamedTuple, Sequence, cast

import numpy as np

from ..._core import InputError
from ...support.input_files import open_file, read_bytes
from ...support.parameters import suggest

_LARGEST = 10**9  # maximum size of a file, bytes
_HEAD = 100_000  # bytes that are sufficient for each header
_GZIP = b"\x1f\x8b"


class Series(NamedTuple):
    """Values with their own times.

    Attributes
    ----------
    time : ndarray (rows,)
        Time, s.
    values : ndarray (rows, k)
        Values.
    """

    time: np.ndarray
    values: np.ndarray


class Columns:
    """Columns of a file by name; each column has its own times.

    Parameters
    ----------
    where
        Path of the file for messages.
    columns
        Columns by name, shape (rows,).
    times
        Times of each column by name, s.
    """

    def __init__(
        self, where: str, columns: Mapping[str, np.ndarray], times: Mapping[str, np.ndarray]
    ) -> None:
        self.where = where
        self._columns, self._times = columns, times

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    @property
    def names(self) -> Sequence[str]:
        """Names of the columns."""
        return list(self._columns)

    def stack(self, names: Sequence[str]) -> Series:
        """Return a float64 copy of the columns of one topic side by side.

        Raises
        ------
        InputError
            If a column does not exist, or the columns have different lengths.
        """
        for name in names:
            if name not in self._columns:
                near = suggest(name, self.names)
                raise InputError(f"{self.where}: column '{name}' does not exist.{near}")
        parts = [self._columns[name] for name in names]
        if len({len(part) for part in parts}) != 1:
            raise InputError(f"{self.where}: {', '.join(names)} have different numbers of rows")
        values = np.empty((len(parts[0]), len(parts)))
        for place, part in enumerate(parts):
            values[:, place] = part
        return Series(self._times[names[0]], values)


def make_columns(where: str, time: np.ndarray, columns: Mapping[str, np.ndarray]) -> Columns:
    """Make columns with common times."""
    return Columns(where, columns, dict.fromkeys(columns, time))


@contextmanager
def open_content(path: Path) -> Iterator[IO[bytes]]:
    """Open a plain or gzip-compressed file; raise `InputError` if it is damaged."""
    with open_file(path) as stream:
        try:
            head = stream.read(len(_GZIP))
            stream.seek(0)
            if head != _GZIP:
                yield stream
                return
            with gzip.open(stream) as unpacked:
                yield cast(IO[bytes], unpacked)
        except (EOFError, gzip.BadGzipFile, zlib.error) as error:
            raise InputError(f"{path}: the compressed file is damaged: {error}.") from error


def read_head(path: Path) -> bytes:
    """Read the first bytes of a plain or gzip-compressed file."""
    with open_content(path) as stream:
        return stream.read(_HEAD)


def read_content(path: Path) -> bytes:
    """Read a plain or gzip-compressed file; raise `InputError` if it is damaged."""
    data = read_bytes(path, _LARGEST)
    if data[:2] != _GZIP:
        return data
    try:
        return gzip.decompress(data)
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(f"{path}: the compressed file is damaged: {error}.") from error


def split_topics(names: Sequence[str]) -> Dict[str, Sequence[str]]:
    """Group columns ``TOPIC.FIELD`` by topic."""
    topics: Dict[str, list] = {}
    for name in names:
        topics.setdefault(name.partition(".")[0], []).append(name)
    return dict(topics)
