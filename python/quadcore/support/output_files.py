"""Writing of files, with one-line error messages."""

from __future__ import annotations

import contextlib
import glob
import os
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Iterable, Iterator, Tuple, Union

from .._core import InputError
from . import interrupts

_PART = ".part"


def printable_name(name: Union[str, Path]) -> str:
    """Return a file name as text, with bytes that are not UTF-8 escaped."""
    return os.fsencode(name).decode("utf-8", "backslashreplace")


@contextmanager
def atomic_write(path: Path) -> Iterator[IO[bytes]]:
    """Open a file for writing, so that either the complete file appears or nothing changes.

    The function follows symbolic links, and keeps the permissions of an existing file.

    Raises
    ------
    InputError
        If the file cannot be written. An existing file does not change, and no partial file
        remains.
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
            import shutil  # slow to import

            shutil.copymode(str(target), str(part))
        os.replace(part, target)
    except OSError as error:
        raise make_write_error(path, error) from error
    finally:
        with interrupts.hold_signals(), contextlib.suppress(OSError):
            part.unlink()


class LineFile:
    """File to which lines are appended; it is complete up to its last line at any time.

    Parameters
    ----------
    path
        Path of the file. The file is created if it does not exist.
    older
        Whether to keep the existing contents.

    Raises
    ------
    InputError
        If the file cannot be written.
    """

    def __init__(self, path: Path, older: bool = False) -> None:
        self._path = path
        try:
            how = os.O_RDWR | os.O_CREAT | (0 if older else os.O_TRUNC)
            self._stream = open(os.open(path, how, 0o666), "r+b", buffering=0)  # noqa: SIM115
        except OSError as error:
            raise make_write_error(path, error) from error

    def keep(self, size: int) -> None:
        """Truncate the file to a size in bytes, and continue writing there."""
        try:
            self._stream.truncate(size)
            self._stream.seek(size)
        except OSError as error:
            raise make_write_error(self._path, error) from error

    def lines(self) -> Iterator[bytes]:
        """Yield all lines from the start of the file."""
        self._stream.seek(0)
        with open(self.fileno(), "rb", closefd=False) as stream:
            yield from stream

    def parts(self, places: Iterable[Tuple[int, int]]) -> Iterator[bytes]:
        """Yield the bytes at places (start, length); the write position does not change."""
        for begin, length in places:
            yield os.pread(self.fileno(), length, begin)

    def write(self, lines: bytes) -> None:
        """Append lines; if the disk is full, the complete lines remain.

        Raises
        ------
        InputError
            If the lines cannot be written, for example because the disk is full.
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
        """Return the file descriptor."""
        return self._stream.fileno()

    @property
    def closed(self) -> bool:
        """Whether the file is closed."""
        return self._stream.closed

    def close(self) -> None:
        """Close the file."""
        self._stream.close()


def encode_text(text: str) -> bytes:
    """Encode a text as UTF-8; file names in another encoding are escaped."""
    return text.encode("utf-8", "backslashreplace")


def escape_cell(value: object) -> object:
    """Escape a text that a spreadsheet would read as a formula."""
    return f"'{value}" if isinstance(value, str) and value[:1] in tuple("=+-@") else value


def make_folder(path: Path) -> None:
    """Create a folder and its parents unless they exist.

    Raises
    ------
    InputError
        If the folder cannot be created.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be made: {error.strerror}") from error


def prepare_folder(path: Path, names: Iterable[str]) -> None:
    """Create a folder, and check that files with these names can be written to it.

    Raises
    ------
    InputError
        If the folder cannot be created, or a file cannot be written.
    """
    make_folder(path)
    for name in names:
        check_writable(path / name)


def check_writable(path: Path) -> None:
    """Raise `InputError` if a file cannot be written; an existing file does not change."""
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder. Name a file in it.")
        if not path.parent.is_dir():
            raise InputError(f"{path}: folder {path.parent} does not exist. Create it first.")
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
    """Make the error for a file that cannot be written."""
    return InputError(f"{path}: cannot be written: {error.strerror or error}")


def remove_leftovers(path: Path) -> None:
    """Remove the partial files that killed processes left next to a file."""
    target = Path(os.path.realpath(str(path)))
    for part in target.parent.glob(f"{glob.escape(_make_prefix(target))}*{_PART}"):
        number = part.name[len(_make_prefix(target)) :].partition(".")[0]
        if not number.isdigit():
            continue
        try:
            os.kill(int(number), 0)
        except (ProcessLookupError, OverflowError):
            with contextlib.suppress(OSError):
                part.unlink()
        except PermissionError:  # the process of another user is still running
            pass


def name_temporary(path: Path, piece: str = "") -> Path:
    """Return the path at which this process prepares a file, or a piece of it.

    The path is in the same folder, because a rename is atomic only within a file system.
    """
    return path.with_name(f"{_make_prefix(path)}{os.getpid()}{piece}{_PART}")


def _make_prefix(path: Path) -> str:
    return f".{path.name}."


def _is_replaceable(path: Path) -> bool:
    """Return whether a new file can replace a path, which is not possible for devices and pipes."""
    return not path.exists() or path.is_file()
