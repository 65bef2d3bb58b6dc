"""Text files read and output files written, with one clear line when that fails."""

from __future__ import annotations

import os
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Iterator, Optional

from . import interrupts
from ._core import InputError


def read_text(path: Path, largest: Optional[int] = None) -> str:
    """Text of a UTF-8 file, without byte-order mark.

    Parameters
    ----------
    path
        The file.
    largest
        Bytes that it may have; None sets no limit.

    Raises
    ------
    InputError
        The file is missing, unreadable, too large or no text.
    """
    try:
        with path.open("rb") as stream:
            data = stream.read(-1 if largest is None else largest + 1)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    if largest is not None and len(data) > largest:
        raise InputError(f"{path}: is larger than {largest / 1e6:g} MB, the most that is read")
    try:
        if b"\0" in data:
            raise InputError(f"{path}: a binary file where text is expected")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path}:{line}: not UTF-8 text; save the file as UTF-8") from error


@contextmanager
def atomic_write(path: Path) -> Iterator[IO[bytes]]:
    """Open `path` for writing so that it appears whole or not at all.

    Raises
    ------
    InputError
        The file cannot be written. Nothing is left behind then, and an older file stays.
    """
    part = _beside(path)
    try:
        with part.open("wb") as stream:
            yield stream
        os.replace(part, path)
    except OSError as error:
        raise _unwritable(path, error) from error
    finally:
        with interrupts.held():
            if part.exists():
                part.unlink()


def make_folder(path: Path) -> None:
    """Make a folder, and those above it, unless it is there.

    Raises
    ------
    InputError
        It cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be made: {error.strerror}") from error


def check_writable(path: Path) -> None:
    """Raise `InputError` now if `path` could not be written later; an older file is not touched."""
    if path.is_dir():
        raise InputError(f"{path}: is a folder; name a file in it")
    if not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}; create it first")
    probe = _beside(path)
    try:
        with interrupts.held():
            probe.touch()
            probe.unlink()
    except OSError as error:
        raise _unwritable(path, error) from error


def _beside(path: Path) -> Path:
    # In the same folder, because a rename is atomic only within one file system.
    return path.with_name(f".{path.name}.{os.getpid()}.part")


def _unwritable(path: Path, error: OSError) -> InputError:
    return InputError(f"{path}: cannot be written: {error.strerror or error}")
