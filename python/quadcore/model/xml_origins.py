"""XML elements that keep their file and line when they are cloned or moved."""

from __future__ import annotations

from typing import Any, Iterator
from xml.dom import expatbuilder, minidom
from xml.parsers import expat

from .xml_source import Origin, check, make_syntax_error

_KEY = "quadcore.origin"


def parse(file: str, text: str) -> minidom.Document:
    """Parse a text to a document with elements that keep their origin.

    Raises
    ------
    InputError
        If the XML is malformed, has an undeclared prefix or a DOCTYPE, or exceeds a limit.
    """
    check(file, text)
    try:
        return _Builder(file).parseString(text)
    except expat.ExpatError as error:
        raise make_syntax_error(file, error) from error


def find_origin(node: Any) -> Origin | None:
    """Return the origin of a node, or of its nearest ancestor that has one."""
    while isinstance(node, minidom.Node):
        found: Origin | None = node.getUserData(_KEY)
        if found is not None:
            return found
        node = node.parentNode
    return None


def write(document: minidom.Document) -> list[tuple[str, Origin]]:
    """Return the lines of a document with their origins; each line has at most one start tag.

    Comments and surrounding white space are removed. Text between elements, which does not occur in
    URDF and world files, is moved before them.
    """
    root = document.documentElement
    assert root is not None
    return list(_write_lines(root))


class _Inherit:
    """Handler that copies the origin of an element to its clones."""

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
    from xml.sax.saxutils import escape, quoteattr  # imports urllib.request, which is slow

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
