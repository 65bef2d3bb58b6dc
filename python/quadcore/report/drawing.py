"""Drawn figures: an SVG element for pages, and files in the chosen formats."""

from __future__ import annotations

import re
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Dict, Iterator, List, Mapping, Match, NamedTuple, Sequence

from .._core import InputError
from ..support.output_files import atomic_write

FORMATS = ("png", "svg", "pdf")
"""Formats of plot files; the first is the default."""

_formats: ContextVar[Sequence[str]] = ContextVar("quadcore_plot_formats", default=FORMATS[:1])
_DIGITS = re.compile(r"(\d+\.\d\d)\d+")
_REFERENCE = re.compile(r"(?:url\(#|href=\"#)([^)\"]+)")


class Drawing(NamedTuple):
    """A drawn figure, which can pass to another process.

    Attributes
    ----------
    title : str
        Title of the figure.
    svg : str
        SVG element for a page; empty if there is neither a page nor an SVG file.
    files : dict of str to bytes
        Contents of the files, by format.
    """

    title: str
    svg: str
    files: Dict[str, bytes]


@contextmanager
def use_formats(formats: Sequence[str]) -> Iterator[None]:
    """Write plots in the given formats within the `with` block."""
    token = _formats.set(tuple(formats))
    try:
        yield
    finally:
        _formats.reset(token)


def set_formats(formats: Sequence[str]) -> None:
    """Write plots in formats until the end of the block of `use_formats`."""
    _formats.set(tuple(formats))


def get_formats() -> Sequence[str]:
    """Return the formats of plot files."""
    return _formats.get()


def check_formats(formats: Sequence[str]) -> Sequence[str]:
    """Return formats; raises `InputError` if one does not exist."""
    for name in formats:
        if name not in FORMATS:
            raise InputError(f"format '{name}' does not exist. Use some of {', '.join(FORMATS)}.")
    return formats


def name_files(name: str, drawing: Drawing) -> Dict[str, bytes]:
    """Return the files of a drawing by their names."""
    return {f"{name}.{kind}": data for kind, data in drawing.files.items()}


def save_drawings(folder: Path, drawings: Mapping[str, Drawing]) -> List[Path]:
    """Write the files of drawings, by name without suffix, into an existing folder.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    written = []
    for name, drawing in drawings.items():
        for file, data in name_files(name, drawing).items():
            with atomic_write(folder / file) as stream:
                stream.write(data)
            written.append(folder / file)
    return written


def make_element(document: str) -> str:
    """Make the SVG element of a page from a document of matplotlib.

    The identifiers of matplotlib are random. Those that are used get names that depend on the
    contents only, so that several figures fit into one page.
    """
    text = document[document.index("<svg") :]
    text = text.replace("<svg", '<svg style="stroke-linejoin: round; stroke-linecap: butt"', 1)
    text = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->|<style.*?</style>", "", text, flags=re.S)
    import hashlib  # is slow to import

    text = re.sub(r' (?:d|x|y)="[^"]*"', lambda found: _DIGITS.sub(r"\1", found.group()), text)
    numbers: Dict[str, str] = {}
    for name in _REFERENCE.findall(text):
        numbers.setdefault(name, f"@{len(numbers)}@")

    def rename(found: Match[str]) -> str:
        number = numbers.get(found.group(2))
        return found.group(1) + number + found.group(3) if number else ""

    text = re.sub(r'( id=")([^"]*)(")', rename, text)
    text = re.sub(r"(url\(#)([^)]+)(\))", rename, text)
    text = re.sub(r'(href="#)([^"]+)(")', rename, text)
    digest = hashlib.sha256(text.encode()).hexdigest()[:8]
    text = re.sub(r"@(\d+)@", rf"f{digest}-\1", text)
    return re.sub(r"\s*\n\s*", "\n", text).strip()
