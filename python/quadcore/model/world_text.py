"""Changes to the text of a world that keep the line numbers of unchanged parts."""

from __future__ import annotations

from typing import Any, Collection, List, NamedTuple, Sequence, Tuple

from .._core import Document

_DEPTH = 2  # nesting level of the children of <world> in <sdf>


class Child(NamedTuple):
    """Direct child element of <world>."""

    name: str
    begin: int
    """Index of its first character in the text."""
    end: int
    """Index after its last character."""


def find_children(text: str) -> Tuple[List[Child], int]:
    """Return the direct children of <world>, and the index at which <world> ends.

    Parameters
    ----------
    text
        World that has already been read, so its XML is well-formed.
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
            # For an element without content, the index is that of its only tag.
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
    """Remove some elements from a world, and add others at its end.

    Parameters
    ----------
    document
        Document of a world that has already been read.
    removed
        Names of direct children of <world> to remove.
    added
        Elements to add, each in one line, with the file and line for error messages about it.
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
    last = before.count("\n") + 1  # line in which <world> ends
    whole = "\n".join([before, *(element for element, _ in added), after])
    places = [place for _, place in added]
    return Document(document.name, whole, [*lines[:last], *places, *lines[last - 1 :]])
