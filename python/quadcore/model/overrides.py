"""Values given from outside beside those of plugins' tags: xacro.ARG, LINK.mass, LINK.ixx."""

from __future__ import annotations

import re
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Tuple
from xml.parsers import expat

from .. import _core
from .._core import Document, InputError, Model
from ..support.arguments import OPTIONS, check
from ..support.parameters import suggest

XACRO = "xacro"
_LINK = "a link"

# Element and attribute of a link's <inertial> that each name stands for.
_PLACES = {"mass": ("mass", "value")}
_PLACES.update({name: ("inertia", name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")})


def split_xacro_arguments(
    parameters: Optional[Mapping[str, Any]], xacro_args: Optional[Mapping[str, object]]
) -> Tuple[Dict[str, object], Dict[str, Any]]:
    """Take the xacro.ARG out of parameters: arguments for the reader, and what is left.

    Raises
    ------
    InputError
        Something else than names with values, or an argument that is given in both ways.
    """
    check({"parameters": parameters, "xacro_args": xacro_args}, OPTIONS)
    arguments, left = dict(xacro_args or {}), {}
    for key, value in (parameters or {}).items():
        owner, _, name = key.rpartition(".")
        if owner != XACRO:
            left[key] = value
        elif name in arguments:
            raise InputError(f"set {key}: is given as a xacro argument, too; keep one")
        else:
            arguments[name] = value
    return arguments, left


def check_names(model: Model, parameters: Iterable[str]) -> None:
    """Raise `InputError` if two things in a model go by a name that is used outside."""
    keys = [key for key in parameters if _is_special(key)]
    if not keys:
        return
    kinds = _describe_names(model.document)
    for key in keys:
        owner = key.rpartition(".")[0]
        if len(kinds.get(owner, ())) > 1:
            raise InputError(
                f"set {key}: '{owner}' is the name of {' and of '.join(kinds[owner])}; rename one"
            )


def apply_link_values(model: Model, parameters: Mapping[str, str]) -> Tuple[Model, Dict[str, str]]:
    """Take the LINK.mass and the like out of parameters, and give the model these values.

    Returns
    -------
    tuple
        The model, read again if anything changed, and what is left: tags of plugins.

    Raises
    ------
    InputError
        A link without that value, a value that the model cannot have, or a name that two go by.
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
            raise InputError(f"set {key}: the model is read already; give it to its reader")
        is_of_link = _is_special(key) and kinds.get(owner) == [_LINK]
        (of_links if is_of_link else left)[key] = value
    return (_change_values(model, of_links) if of_links else model), left


def _check_link_names(model: Model, parameters: Iterable[str]) -> None:
    """Raise `InputError` for a value that no link has, such as LINK.mas."""
    links = [link.name for link in model.links]
    for key in parameters:
        owner, _, name = key.rpartition(".")
        if (
            owner in links
            and not _is_special(key)
            and _describe_names(model.document)[owner] == [_LINK]
        ):
            near, known = suggest(name, list(_PLACES)), ", ".join(_PLACES)
            raise InputError(
                f"set {key}: link '{owner}' has no value '{name}'{near}. Set one of {known}."
            )


def list_link_values(document: Document) -> Dict[str, str]:
    """Find every LINK.NAME that a document's links have, with its text."""
    found = _find_attributes(document.text.encode())
    return {key: attribute.text for key, attribute in found.items()}


def _is_special(key: str) -> bool:
    """Whether a key may be another than a plugin's tag."""
    owner, _, name = key.rpartition(".")
    return owner == XACRO or name in _PLACES


def _describe_names(document: Document) -> Dict[str, List[str]]:
    """Say what goes by each name in a document."""
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
    places = _find_attributes(document.text.encode())
    edits = []
    for key, value in values.items():
        if _core.parse_number(value) is None:
            raise InputError(f"set {key}: '{value}' is not a finite number; write one")
        if key not in places:
            raise InputError(f"set {key}: the link has no <inertial> that says so; write one")
        edits.append((*places[key].span, value.encode()))
    text = document.text.encode()
    for begin, end, new in sorted(edits, reverse=True):
        text = text[:begin] + new + text[end:]
    changed = Document(document.name, text.decode(), document.lines)
    try:
        return _core.read_model(changed, list(model.ignored_elements.ignored))
    except InputError as error:
        raise InputError(f"set {', '.join(values)}: {error}") from None


class _Attribute(NamedTuple):
    """A value of a link that may be changed."""

    span: Tuple[int, int]
    """Begin and end in the document's bytes."""
    text: str


def _find_attributes(text: bytes) -> Dict[str, _Attribute]:
    """Find the values that may be changed, by LINK.NAME."""
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
        for name, (element, attribute) in _PLACES.items():
            if tag == element and attribute in attributes:
                pattern = rb"\s" + attribute.encode() + rb"\s*=\s*(?:\"([^\"]*)\"|'([^']*)')"
                match = re.compile(pattern).search(text, begin)
                assert match is not None
                span = match.span(1 if match[1] is not None else 2)
                found[f"{link}.{name}"] = _Attribute(span, attributes[attribute])

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: path.pop()
    parser.Parse(text, True)
    return found
