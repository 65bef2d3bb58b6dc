"""Reading of files, with one-line error messages."""

from __future__ import annotations

import os
import stat
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Iterator

from .._core import InputError

LARGEST = 10**7
"""Maximum size of a text file, bytes."""


@contextmanager
def open_file(path: Path) -> Iterator[IO[bytes]]:
    """Open a regular file; pipes and devices, which could block, are rejected.

    Raises
    ------
    InputError
        If the file is missing, unreadable, or not a regular file.
    """
    try:
        check_regular(path)
        # The path may have changed since the check, and opening a pipe would wait for a writer.
        with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as stream:
            _check(path, os.fstat(stream.fileno()).st_mode)
            yield stream
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error


def check_regular(path: Path) -> None:
    """Raise `InputError` unless a path is a regular file, for libraries that take only paths."""
    try:
        _check(path, path.stat().st_mode)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:  # the name contains a null byte
        raise InputError(f"{path}: cannot be read: {error}") from error


def _check(path: Path, mode: int) -> None:
    if stat.S_ISDIR(mode):
        raise InputError(f"{path}: cannot be read: Is a directory")
    if not stat.S_ISREG(mode):
        raise InputError(f"{path}: this is not a regular file. Save its content in a regular file.")


def read_bytes(path: Path, largest: int) -> bytes:
    """Read a whole file.

    Parameters
    ----------
    path
        File to read.
    largest
        Maximum size, bytes.

    Raises
    ------
    InputError
        If the file is larger than this, or cannot be read; see `open_file`.
    """
    with open_file(path) as stream:
        return read_whole(path, stream, largest)


def read_whole(path: Path, stream: IO[bytes], largest: int) -> bytes:
    """Read the rest of an open file; parameters and errors are those of `read_bytes`."""
    data = stream.read(largest + 1)
    if len(data) > largest:
        raise InputError(
            f"{path}: the file exceeds the limit of {largest / 1e6:g} MB. Use a smaller file."
        )
    return data


def read_text(path: Path, largest: int = LARGEST) -> str:
    """Read a UTF-8 file, and remove its byte-order mark.

    Raises
    ------
    InputError
        If the file is not UTF-8 text, or `read_bytes` fails.
    """
    data = read_bytes(path, largest)
    try:
        if b"\0" in data:
            raise InputError(f"{path}: a binary file where text is expected")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}:{line}: the text is not UTF-8. Save the file as UTF-8."
        ) from error


def is_file(path: Path) -> bool:
    """Return whether a path is a regular file.

    Raises
    ------
    InputError
        If a parent folder is not accessible, or the name is too long.
    """
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return False
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
