"""Changes to the text of a world, which keep the lines of what stays."""

from __future__ import annotations

from typing import Any, Collection, List, NamedTuple, Sequence, Tuple

from .._core import Document

_DEPTH = 2  # of children of <world> in <sdf>


class Child(NamedTuple):
    """Element directly in <world>."""

    name: str
    begin: int
    """Position of its first character in the text."""
    end: int
    """Position after its last character."""


def find_children(text: str) -> Tuple[List[Child], int]:
    """Return the elements directly in <world>, and the position where <world> ends.

    Parameters
    ----------
    text
        World that has been read, so that it is well-formed.
    """
    from xml.parsers import expat

    parser = expat.ParserCreate()
    open_elements: List[Tuple[str, int]] = []
    children: List[Child] = []
    encoded, end = text.encode(), 0

    def start(element: str, attributes: Any) -> None:
        open_elements.append((element, parser.CurrentByteIndex))

    def stop(element: str) -> None:
        nonlocal end
        at = parser.CurrentByteIndex
        _, begin = open_elements.pop()
        if element == "world" and len(open_elements) < _DEPTH:
            end = at
        elif len(open_elements) == _DEPTH and open_elements[-1][0] == "world":
            # The index of an element without content is that of its only tag.
            children.append(Child(element, begin, encoded.index(b">", at) + 1))

    parser.StartElementHandler, parser.EndElementHandler = start, stop
    parser.Parse(encoded, True)
    children = [
        Child(name, len(encoded[:first].decode()), len(encoded[:last].decode()))
        for name, first, last in children
    ]
    return children, len(encoded[:end].decode())


def change_world_text(
    document: Document, removed: Collection[str], added: Sequence[Tuple[str, Tuple[str, int]]]
) -> Document:
    """Return the document of a world without some elements and with others at its end.

    Parameters
    ----------
    document
        Document of a world that has been read.
    removed
        Names of elements directly in <world>.
    added
        Elements of one line each, with the file and line that errors in them state.
    """
    text = document.text
    children, end = find_children(text)
    for child in reversed(children):
        if child.name in removed:
            kept = "\n" * text.count("\n", child.begin, child.end)
            text = text[: child.begin] + kept + text[child.end :]
            end += len(kept) - (child.end - child.begin)
    before, after = text[:end], text[end:]
    count = text.count("\n") + 1
    lines: List[Any] = document.lines or [(document.name, i + 1) for i in range(count)]
    last = before.count("\n") + 1  # the line in which the world ends
    whole = "\n".join([before, *(element for element, _ in added), after])
    places = [place for _, place in added]
    return Document(document.name, whole, [*lines[:last], *places, *lines[last - 1 :]])
