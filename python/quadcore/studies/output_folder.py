"""Output folder of a study: exclusive access, and removal of files of earlier studies."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import threading
import time
from pathlib import Path
from typing import Any, Callable, Iterator, List, Mapping, Optional, Sequence, Set

from .._core import InputError
from ..report.drawing import FORMATS, Drawing, name_files, save_drawings
from ..support import interrupts
from ..support.input_files import read_bytes
from ..support.output_files import make_write_error, prepare_folder
from .table import make_json, save_files

_LOCK = ".quadcore.lock"
_PATIENCE = 10.0  # s; a study that has just been killed may still hold the lock
_LARGEST = 10**9  # maximum size of a document, bytes

_held: Set[str] = set()  # folders that threads of this process have locked
_held_lock = threading.Lock()


@contextlib.contextmanager
def output_folder(
    folder: Optional[Path], names: Sequence[str] = (), document: str = ""
) -> Iterator[None]:
    """Make a folder, and lock it during the block.

    Parameters
    ----------
    folder
        Folder. None: no output.
    names
        Names of files that must be writable.
    document
        File that only this kind of study writes. If the folder lacks this file but contains one of
        `names`, the function raises instead of overwriting. "": no check.

    Raises
    ------
    InputError
        If the folder cannot be made, a file is not writable or was written by something else, or
        another study is writing to the folder.
    """
    if folder is None:
        yield
        return
    prepare_folder(folder, names)
    if document and not os.path.lexists(folder / document):
        for name in names:
            if os.path.lexists(folder / name):
                raise InputError(
                    f"{folder / name}: was not written by this command. Move it, or name "
                    "another folder."
                )
    real = os.path.realpath(folder)
    with _held_lock:
        if real in _held:
            raise _make_conflict(folder)
        _held.add(real)
    try:
        number = _lock(folder)
        try:
            yield
        finally:
            with interrupts.hold_signals():
                with contextlib.suppress(OSError):
                    os.unlink(folder / _LOCK)
                os.close(number)
    finally:
        _held.discard(real)


def _lock(folder: Path) -> int:
    """Lock the folder; forked processes do not inherit the lock."""
    path = folder / _LOCK
    end = time.monotonic() + _PATIENCE
    while True:
        try:
            number = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise make_write_error(path, error) from error
        with contextlib.suppress(OSError):
            fcntl.lockf(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(number), os.stat(path)):  # otherwise its owner removed it
                return number
        os.close(number)
        if time.monotonic() > end:
            raise _make_conflict(folder)
        time.sleep(0.1)


def _make_conflict(folder: Path) -> InputError:
    return InputError(f"{folder}: another study is writing there. Wait, or name another folder.")


def remove_listed_files(
    folder: Path, document: str, key: str, is_ours: Callable[[str], Any]
) -> None:
    """Remove the files that an earlier study lists in its document.

    Parameters
    ----------
    folder
        Folder of the files and the document.
    document
        Name of the JSON document. A missing or damaged document lists nothing.
    key
        Key of the list of file names in the document.
    is_ours
        Function that returns whether a study writes files with this name.
    """
    try:
        listed = json.loads(read_bytes(folder / document, _LARGEST)).get(key, [])
    except (InputError, ValueError, AttributeError, RecursionError):
        return
    for name in listed if isinstance(listed, list) else []:
        if isinstance(name, str) and is_ours(name):
            with contextlib.suppress(OSError):
                (folder / name).unlink()


def remove_plots(folder: Path, document: str, is_plot: Callable[[str], bool]) -> None:
    """Remove the plots of an earlier study; `is_plot` is called with a name without suffix."""

    def is_ours(name: str) -> bool:
        stem, _, kind = name.rpartition(".")
        return kind in FORMATS and is_plot(stem)

    remove_listed_files(folder, document, "pictures", is_ours)


def save_plots(
    folder: Path, document: str, content: Mapping[str, Any], images: Mapping[str, Drawing]
) -> List[Path]:
    """Write plots, given by name without suffix, and list them in a document with this content."""
    pictures = [file for name, drawing in images.items() for file in name_files(name, drawing)]
    save_files(folder, {document: make_json({**content, "pictures": pictures})})
    return save_drawings(folder, images)
