"""Differences between the files of two models."""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Optional
from xml.parsers import expat

from ..._core import Document

_IGNORED = ("visual", "material")
ABSENT = "absent"


class Difference(NamedTuple):
    """A value or element in which two models differ."""

    what: str
    """Path of an element or attribute (``link frame/inertial/mass value``), or ``PLUGIN.TAG``."""
    before: str
    after: str
    before_at: str
    """``FILE:LINE``; "" if `before` is absent."""
    after_at: str


class Fact(NamedTuple):
    """Value of a tag or attribute of a model."""

    text: str
    at: str
    """``FILE:LINE``."""
    within: Optional[str]
    """Enclosing link, joint or plugin, if any."""


def list_facts(document: Document) -> Dict[str, Fact]:
    """List all values of a model that can affect a flight, by name, in the order of the file."""
    found: Dict[str, Fact] = {}
    for element in _parse(document).children:
        if element.tag == "gazebo":
            for child in element.children:
                _add(found, child)
        elif element.tag not in _IGNORED:
            _add(found, element)
    return found


def compare_documents(before: Document, after: Document) -> List[Difference]:
    """List the differences between two models; numeric texts are compared as numbers."""
    old, new = list_facts(before), list_facts(after)
    rows = []
    for what in {**old, **new}:
        a, b = old.get(what), new.get(what)
        if a is not None and b is not None:
            if not _are_equal(a.text, b.text):
                rows.append(Difference(what, a.text, b.text, a.at, b.at))
            continue
        fact, other = (a, new) if a is not None else (b, old)
        assert fact is not None
        if fact.within is not None and fact.within not in other:
            continue  # the missing enclosing element is already listed
        present = fact.text or "present"
        if a is not None:
            rows.append(Difference(what, present, ABSENT, fact.at, ""))
        else:
            rows.append(Difference(what, ABSENT, present, "", fact.at))
    return rows + _compare_joint_order(old, new)


class _Element:
    def __init__(self, tag: str, attributes: Dict[str, str], at: str) -> None:
        self.tag, self.attributes, self.at = tag, attributes, at
        self.text = ""
        self.children: List[_Element] = []


def _parse(document: Document) -> _Element:
    # Not with xml_source, because models may use undeclared prefixes.
    parser = expat.ParserCreate()
    top = _Element("", {}, "")
    stack = [top]

    def start(tag: str, attributes: Dict[str, str]) -> None:
        line = parser.CurrentLineNumber
        name, line = document.lines[line - 1] if document.lines else (document.name, line)
        element = _Element(tag, attributes, f"{name}:{line}")
        stack[-1].children.append(element)
        stack.append(element)

    def text(data: str) -> None:
        stack[-1].text += data

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: stack.pop()
    parser.CharacterDataHandler = text
    parser.Parse(document.text, True)
    return top.children[0]


def _add(found: Dict[str, Fact], element: _Element) -> None:
    """Add a top-level element and its contents to the facts."""
    attributes = dict(element.attributes)
    name = f"{element.tag} {attributes.pop('name', '')}".strip()
    main = attributes.pop({"plugin": "filename", "joint": "type"}.get(element.tag, ""), "")
    found[name] = Fact(" ".join((main or element.text).split()), element.at, None)
    prefix = f"{element.attributes.get('name', '')}." if element.tag == "plugin" else f"{name}/"
    _add_inner(found, element, attributes, name, prefix, name)


def _add_inner(
    found: Dict[str, Fact],
    element: _Element,
    attributes: Dict[str, str],
    name: str,
    prefix: str,
    within: str,
) -> None:
    for key, value in attributes.items():
        found[f"{name} {key}"] = Fact(" ".join(value.split()), element.at, within)
    seen: Dict[str, int] = {}
    for child in element.children:
        if child.tag in _IGNORED:
            continue
        seen[child.tag] = seen.get(child.tag, 0) + 1
        path = prefix + child.tag + (f"[{seen[child.tag]}]" if seen[child.tag] > 1 else "")
        text = " ".join(child.text.split())
        if text or not (child.attributes or child.children):
            found[path] = Fact(text, child.at, within)
        _add_inner(found, child, child.attributes, path, f"{path}/", within)


def _compare_joint_order(old: Dict[str, Fact], new: Dict[str, Fact]) -> List[Difference]:
    """Report a different order of the joints, because the order numbers the rotors."""
    a = [name for name in old if name.startswith("joint ") and old[name].within is None]
    b = [name for name in new if name.startswith("joint ") and new[name].within is None]
    a, b = [name for name in a if name in b], [name for name in b if name in a]
    if a == b:
        return []
    before, after = (" ".join(name[len("joint ") :] for name in names) for names in (a, b))
    return [Difference("order of the joints", before, after, old[a[0]].at, new[b[0]].at)]


def _are_equal(a: str, b: str) -> bool:
    if a == b:
        return True
    try:
        return [float(x) for x in a.split()] == [float(x) for x in b.split()]
    except ValueError:
        return False
