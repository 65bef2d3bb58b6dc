"""Overrides that are not plugin tags: xacro.ARG, and values of links such as LINK.mass."""

from __future__ import annotations

import re
from typing import Any, Container, Dict, Iterable, List, Mapping, NamedTuple, Optional, Tuple
from xml.parsers import expat

from .. import _core
from .._core import Document, InputError, Model
from ..support.arguments import OPTIONS, check
from ..support.parameters import suggest

XACRO = "xacro"
_LINK = "a link"
_NUMBER = re.compile(rb"[^\s\"']+")


class LinkValue(NamedTuple):
    """Number in the ``<inertial>`` element of a link.

    Attributes
    ----------
    element, attribute : str
        Name of the XML element, and name of its attribute.
    place : int
        Index among the numbers of the attribute.
    unit, meaning : str
        Unit and meaning for tables.
    is_signed : bool
        Whether the number may be negative.
    """

    element: str
    attribute: str
    place: int
    unit: str
    meaning: str
    is_signed: bool


LINK_VALUES = {"mass": LinkValue("mass", "value", 0, "kg", "mass", False)}
"""Link values that ``LINK.NAME`` overrides, by NAME."""
LINK_VALUES.update(
    (f"i{a}{b}", LinkValue("inertia", f"i{a}{b}", 0, "kg m^2", f"{kind} of inertia", a != b))
    for a, b, kind in (
        ("x", "x", "moment"),
        ("x", "y", "product"),
        ("x", "z", "product"),
        ("y", "y", "moment"),
        ("y", "z", "product"),
        ("z", "z", "moment"),
    )
)
LINK_VALUES.update(
    (f"com_{axis}", LinkValue("origin", "xyz", place, "m", f"centre of mass, {axis}", True))
    for place, axis in enumerate("xyz")
)
LINK_NAMES = "LINK.mass, LINK.ixx ... LINK.izz, LINK.com_x ... LINK.com_z"
"""Names of `LINK_VALUES` for help texts."""


def split_xacro_arguments(
    parameters: Optional[Mapping[str, Any]], xacro_args: Optional[Mapping[str, object]]
) -> Tuple[Dict[str, object], Dict[str, Any]]:
    """Split parameters into xacro arguments and other parameters.

    Raises
    ------
    InputError
        If parameters are not a mapping of names, or an argument is given twice.
    """
    check({"parameters": parameters, "xacro_args": xacro_args}, OPTIONS)
    arguments, left = dict(xacro_args or {}), {}
    for key, value in (parameters or {}).items():
        owner, _, name = key.rpartition(".")
        if owner != XACRO:
            left[key] = value
        elif name in arguments:
            raise InputError(f"set {key}: is also given as a xacro argument. Keep one.")
        else:
            arguments[name] = value
    return arguments, left


def check_names(model: Model, parameters: Iterable[str]) -> None:
    """Raise `InputError` if the name in a parameter is ambiguous in a model."""
    keys = [key for key in parameters if _is_special(key)]
    if not keys:
        return
    kinds = _describe_names(model.document)
    for key in keys:
        owner = key.rpartition(".")[0]
        if len(kinds.get(owner, ())) > 1:
            raise InputError(
                f"set {key}: '{owner}' is the name of {' and of '.join(kinds[owner])}. Rename one."
            )


def apply_link_values(model: Model, parameters: Mapping[str, str]) -> Tuple[Model, Dict[str, str]]:
    """Apply parameters such as LINK.mass to a model.

    Returns
    -------
    tuple
        Model with the new values, and the remaining parameters, which are plugin tags.

    Raises
    ------
    InputError
        If the link lacks the value, the value is invalid, or the name is ambiguous.
    """
    _check_link_names(model, parameters)
    if not any(_is_special(key) for key in parameters):
        return model, dict(parameters)
    check_names(model, parameters)
    kinds = _describe_names(model.document)
    of_links: Dict[str, str] = {}
    left: Dict[str, str] = {}
    for key, value in parameters.items():
        owner = key.rpartition(".")[0]
        if owner == XACRO:
            raise InputError(f"set {key}: the model has already been read. Give it to read_model.")
        is_of_link = _is_special(key) and kinds.get(owner) == [_LINK]
        (of_links if is_of_link else left)[key] = value
    return (_change_values(model, of_links) if of_links else model), left


def _check_link_names(model: Model, parameters: Iterable[str]) -> None:
    """Raise `InputError` for an unknown link value, such as LINK.mas."""
    links = [link.name for link in model.links]
    for key in parameters:
        owner, _, name = key.rpartition(".")
        if (
            owner in links
            and not _is_special(key)
            and _describe_names(model.document)[owner] == [_LINK]
        ):
            near, known = suggest(name, list(LINK_VALUES)), ", ".join(LINK_VALUES)
            raise InputError(
                f"set {key}: link '{owner}' has no value '{name}'.{near} Set one of {known}."
            )


def list_link_values(document: Document) -> Dict[str, str]:
    """Return the text of every LINK.NAME in a document; the default of an origin is 0."""
    found = _find_attributes(_add_origins(document.text.encode()))
    return {key: attribute.text for key, attribute in found.items()}


def _is_special(key: str) -> bool:
    """Return whether a key may be something other than a plugin tag."""
    owner, _, name = key.rpartition(".")
    return owner == XACRO or name in LINK_VALUES


def _describe_names(document: Document) -> Dict[str, List[str]]:
    """Return the kinds of objects with each name in a document."""
    kinds: Dict[str, List[str]] = {XACRO: ["the arguments of xacro"]}

    def start(tag: str, attributes: Mapping[str, str]) -> None:
        if tag in ("link", "plugin") and "name" in attributes:
            kinds_of = kinds.setdefault(attributes["name"], [])
            if f"a {tag}" not in kinds_of:
                kinds_of.append(f"a {tag}")

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    parser.Parse(document.text, True)
    return kinds


def _change_values(model: Model, values: Mapping[str, str]) -> Model:
    document = model.document
    text = document.text.encode()
    if any(LINK_VALUES[key.rpartition(".")[2]].element == "origin" for key in values):
        text = _add_origins(text, [key.rpartition(".")[0] for key in values])
    places = _find_attributes(text)
    edits = []
    for key, value in values.items():
        if _core.parse_number(value) is None:
            raise InputError(f"set {key}: '{value}' is not a finite number. Write one.")
        if key not in places:
            raise InputError(f"set {key}: the link has no such <inertial>. Write one.")
        edits.append((*places[key].span, value.encode()))
    for begin, end, new in sorted(edits, reverse=True):
        text = text[:begin] + new + text[end:]
    changed = Document(document.name, text.decode(), document.lines)
    try:
        return _core.read_model(changed, list(model.ignored_elements.ignored))
    except InputError as error:
        raise InputError(f"set {', '.join(values)}: {error}") from None


class _Attribute(NamedTuple):
    """Value of a link in the text of a document."""

    span: Tuple[int, int]
    """Start and end of the value, bytes."""
    text: str


def _find_attributes(text: bytes) -> Dict[str, _Attribute]:
    """Find the link values in a document, by LINK.NAME."""
    found: Dict[str, _Attribute] = {}
    parser = expat.ParserCreate()
    path: List[str] = []
    link = ""

    def start(tag: str, attributes: Mapping[str, str]) -> None:
        nonlocal link
        path.append(tag)
        if path[1:] == ["link"]:
            link = attributes.get("name", "")
        if path[1:-1] != ["link", "inertial"]:
            return
        begin = parser.CurrentByteIndex
        for name, (element, attribute, place, *_) in LINK_VALUES.items():
            if tag == element and attribute in attributes:
                pattern = rb"\s" + attribute.encode() + rb"\s*=\s*(?:\"([^\"]*)\"|'([^']*)')"
                match = re.compile(pattern).search(text, begin)
                assert match is not None
                span = match.span(1 if match[1] is not None else 2)
                number = list(_NUMBER.finditer(text, *span))[place]
                found[f"{link}.{name}"] = _Attribute(number.span(), number[0].decode())

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: path.pop()
    parser.Parse(text, True)
    return found


def _add_origins(text: bytes, links: Optional[Container[str]] = None) -> bytes:
    """Add the default origin to each ``<inertial>`` without one.

    Parameters
    ----------
    text
        Text of a document.
    links
        Names of the links (default: all).
    """
    parser = expat.ParserCreate()
    path: List[str] = []
    additions: Dict[int, bytes] = {}
    link, mass, has_origin = "", -1, False

    def is_wanted() -> bool:
        return links is None or link in links

    def start(tag: str, attributes: Mapping[str, str]) -> None:
        nonlocal link, mass, has_origin
        path.append(tag)
        if path[1:] == ["link"]:
            link, mass, has_origin = attributes.get("name", ""), -1, False
        elif path[1:] == ["link", "inertial", "mass"]:
            mass = parser.CurrentByteIndex
        elif path[1:] == ["link", "inertial", "origin"]:
            has_origin = True
            if "xyz" not in attributes and is_wanted():
                additions[parser.CurrentByteIndex + len("<origin")] = b' xyz="0 0 0"'

    def end(tag: str) -> None:
        if path[1:] == ["link"] and mass >= 0 and not has_origin and is_wanted():
            additions[mass] = b'<origin xyz="0 0 0"/>'
        path.pop()

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(text, True)
    for at in sorted(additions, reverse=True):
        text = text[:at] + additions[at] + text[at:]
    return text
