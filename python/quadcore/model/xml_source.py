"""Reading and checking of XML texts."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, Sized
from xml.parsers import expat

from .._core import Document, InputError
from ..support.input_files import read_text

# The limits of the core.
LARGEST = Document.largest
DEEPEST = Document.most_levels
MOST_ATTRIBUTES = Document.most_attributes


class Origin(NamedTuple):
    """File and line of an element."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


def read(path: Path, largest: int = LARGEST) -> str:
    """Read the text of an XML file; raise `InputError` if it is unreadable or too large."""
    return read_text(path, largest)


def check(file: str, text: str) -> None:
    """Raise `InputError` unless `text` is well-formed XML without a DOCTYPE, within the limits.

    Entities of a DOCTYPE can expand without limit or include other files. Namespace prefixes need
    no declaration, because some world files lack it.
    """
    parser = expat.ParserCreate()
    level = 0

    def refuse(what: str) -> None:
        raise InputError(f"{Origin(file, parser.CurrentLineNumber)}: {what}")

    def doctype(*_: object) -> None:
        refuse(
            "DOCTYPE and entity declarations are not supported. Remove them and write the values."
        )

    def start(_: object, attributes: Sized) -> None:
        nonlocal level
        level += 1
        if len(attributes) > MOST_ATTRIBUTES:
            refuse(
                f"an element has more than {MOST_ATTRIBUTES} attributes. "
                "Use a valid model or world file."
            )
        if level > DEEPEST:
            refuse(
                f"elements are nested deeper than {DEEPEST} levels. "
                "Use a valid model or world file."
            )

    def end(_: object) -> None:
        nonlocal level
        level -= 1

    parser.StartDoctypeDeclHandler = doctype
    parser.StartElementHandler, parser.EndElementHandler = start, end
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise make_syntax_error(file, error) from error


def make_syntax_error(file: str, error: expat.ExpatError) -> InputError:
    """Make the error for malformed XML."""
    what = expat.ErrorString(error.code)
    hint = ' (declare it: xmlns:xacro="http://www.ros.org/wiki/xacro")' if "prefix" in what else ""
    return InputError(f"{Origin(file, error.lineno)}: malformed XML: {what}{hint}")
