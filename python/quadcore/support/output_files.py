"""Output files written, with one clear line when that fails."""

from __future__ import annotations

import contextlib
import glob
import os
import shutil
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Iterable, Iterator, Tuple, Union

from .._core import InputError
from . import interrupts

_PART = ".part"


def printable_name(name: Union[str, Path]) -> str:
    """Name of a file as it can be shown anywhere: bytes that are no UTF-8 are escaped."""
    return os.fsencode(name).decode("utf-8", "backslashreplace")


@contextmanager
def atomic_write(path: Path) -> Iterator[IO[bytes]]:
    """Open `path` for writing so that it appears whole or not at all.

    A link is followed, and what an older file may be read and written by stays.

    Raises
    ------
    InputError
        The file cannot be written. Nothing is left behind then, and an older file stays.
    """
    target = Path(os.path.realpath(str(path)))
    part = name_temporary(target)
    try:
        if not _is_replaceable(target):
            with target.open("wb") as stream:
                yield stream
            return
        with part.open("wb") as stream:
            yield stream
        if target.exists():
            shutil.copymode(str(target), str(part))
        os.replace(part, target)
    except OSError as error:
        raise make_write_error(path, error) from error
    finally:
        with interrupts.hold_signals(), contextlib.suppress(OSError):
            part.unlink()


class LineFile:
    """A file that grows by whole lines and is complete up to the last one at any time.

    Parameters
    ----------
    path
        Made if there is none.
    older
        Whether what it holds stays for now; else it is emptied.

    Raises
    ------
    InputError
        It cannot be written.
    """

    def __init__(self, path: Path, older: bool = False) -> None:
        self._path = path
        try:
            how = os.O_RDWR | os.O_CREAT | (0 if older else os.O_TRUNC)
            self._stream = open(os.open(path, how, 0o666), "r+b", buffering=0)  # noqa: SIM115
        except OSError as error:
            raise make_write_error(path, error) from error

    def keep(self, size: int) -> None:
        """Cut what is there to so many bytes, and go on behind them."""
        try:
            self._stream.truncate(size)
            self._stream.seek(size)
        except OSError as error:
            raise make_write_error(self._path, error) from error

    def lines(self) -> Iterator[bytes]:
        """Give its lines from the start."""
        self._stream.seek(0)
        with open(self.fileno(), "rb", closefd=False) as stream:
            yield from stream

    def parts(self, places: Iterable[Tuple[int, int]]) -> Iterator[bytes]:
        """Give the bytes at places, each a begin and a length; writing goes on where it was."""
        for begin, length in places:
            yield os.pread(self.fileno(), length, begin)

    def write(self, lines: bytes) -> None:
        """Append lines; of those that do not fit, the whole ones stay.

        Raises
        ------
        InputError
            The disk is full, for instance.
        """
        written = 0
        try:
            while written < len(lines):
                written += self._stream.write(memoryview(lines)[written:]) or 0
        except OSError as error:
            with contextlib.suppress(OSError):
                rest = written - (lines.rfind(b"\n", 0, written) + 1)
                self._stream.truncate(self._stream.tell() - rest)
            raise make_write_error(self._path, error) from error

    def fileno(self) -> int:
        """Give the number of the open file."""
        return self._stream.fileno()

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._stream.closed

    def close(self) -> None:
        """Close the file."""
        self._stream.close()


def encode_text(text: str) -> bytes:
    """UTF-8 of a text; file names in it that are none are escaped."""
    return text.encode("utf-8", "backslashreplace")


def escape_cell(value: object) -> object:
    """Keep a text in a CSV table from being taken for a formula by a spreadsheet."""
    return f"'{value}" if isinstance(value, str) and value[:1] in tuple("=+-@") else value


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


def prepare_folder(path: Path, names: Iterable[str]) -> None:
    """Make a folder in which files of these names are to be written later.

    Raises
    ------
    InputError
        It cannot be made, or one of them cannot be written.
    """
    make_folder(path)
    for name in names:
        check_writable(path / name)


def check_writable(path: Path) -> None:
    """Raise `InputError` now if `path` could not be written later; an older file is not touched."""
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder; name a file in it")
        if not path.parent.is_dir():
            raise InputError(f"{path}: there is no folder {path.parent}; create it first")
        target = Path(os.path.realpath(str(path)))
        if not _is_replaceable(target):
            return
        if target.exists() and not os.access(str(target), os.W_OK):
            raise InputError(f"{path}: cannot be written: it is read-only")
        probe = name_temporary(target)
        with interrupts.hold_signals():
            probe.touch()
            probe.unlink()
    except OSError as error:
        raise make_write_error(path, error) from error


def make_write_error(path: Path, error: OSError) -> InputError:
    """Make the error that says why a file cannot be written."""
    return InputError(f"{path}: cannot be written: {error.strerror or error}")


def remove_leftovers(path: Path) -> None:
    """Remove what processes that were killed while they wrote `path` have left beside it."""
    target = Path(os.path.realpath(str(path)))
    for part in target.parent.glob(f"{glob.escape(_find_previous(target))}*{_PART}"):
        number = part.name[len(_find_previous(target)) :].partition(".")[0]
        if not number.isdigit():
            continue
        try:
            os.kill(int(number), 0)
        except (ProcessLookupError, OverflowError):
            with contextlib.suppress(OSError):
                part.unlink()
        except PermissionError:  # it runs, as somebody else
            pass


def name_temporary(path: Path, piece: str = "") -> Path:
    """Name a file in which a process prepares `path`, or a piece of it, until it is whole.

    In the same folder, because a rename is atomic only within one file system.
    """
    return path.with_name(f"{_find_previous(path)}{os.getpid()}{piece}{_PART}")


def _find_previous(path: Path) -> str:
    return f".{path.name}."


def _is_replaceable(path: Path) -> bool:
    """Whether a new file may take the place of what is there: not of a device or a pipe."""
    return not path.exists() or path.is_file()
