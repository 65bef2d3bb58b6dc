"""XML elements that know the file and line they were written on, through cloning and moving."""

from __future__ import annotations

from typing import Any, Iterator
from xml.dom import expatbuilder, minidom
from xml.parsers import expat
from xml.sax.saxutils import escape, quoteattr

from .xml_source import Origin, check, make_syntax_error

_KEY = "quadcore.origin"


def parse(file: str, text: str) -> minidom.Document:
    """Document of `text` whose elements know their `find_origin`.

    Raises
    ------
    InputError
        Malformed XML, an undeclared namespace prefix, a DOCTYPE, or a limit exceeded.
    """
    check(file, text)
    try:
        return _Builder(file).parseString(text)
    except expat.ExpatError as error:
        raise make_syntax_error(file, error) from error


def find_origin(node: Any) -> Origin | None:
    """Where a node, or the nearest element around it that was read from a file, stands."""
    while isinstance(node, minidom.Node):
        found: Origin | None = node.getUserData(_KEY)
        if found is not None:
            return found
        node = node.parentNode
    return None


def write(document: minidom.Document) -> list[tuple[str, Origin]]:
    """Lines of `document`, at most one start tag on each, with the place each line comes from.

    Comments and the white space around texts are left out. Text between elements, which neither a
    URDF nor a world has, comes before them.
    """
    root = document.documentElement
    assert root is not None
    return list(_write_lines(root))


class _Inherit:
    """Lets a clone stand where its original stands."""

    @staticmethod
    def handle(operation: int, key: str, data: Any, source: Any, clone: Any) -> None:
        if clone is not None:
            clone.setUserData(key, data, _Inherit)


class _Builder(expatbuilder.ExpatBuilderNS):
    def __init__(self, file: str) -> None:
        super().__init__()
        self._file = file

    def start_element_handler(self, name: str, attributes: Any) -> None:
        super().start_element_handler(name, attributes)
        place = Origin(self._file, self.getParser().CurrentLineNumber)
        self.curNode.setUserData(_KEY, place, _Inherit)


def _write_lines(element: minidom.Element) -> Iterator[tuple[str, Origin]]:
    place = find_origin(element)
    assert place is not None
    tag = element.tagName
    head = "<" + tag + "".join(f" {k}={quoteattr(v)}" for k, v in element.attributes.items())
    texts = [node.data for node in element.childNodes if isinstance(node, minidom.Text)]
    text = escape("".join(texts).strip())
    children = [node for node in element.childNodes if isinstance(node, minidom.Element)]
    if not children:
        whole = f"{head}>{text}</{tag}>" if text else f"{head}/>"
        yield from ((line, place) for line in whole.split("\n"))
        return
    yield from ((line, place) for line in f"{head}>{text}".split("\n"))
    for child in children:
        yield from _write_lines(child)
    yield f"</{tag}>", place
