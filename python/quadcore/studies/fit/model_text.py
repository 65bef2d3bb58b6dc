"""Writing values into the text of a model."""

from __future__ import annotations

from typing import Collection, Dict, List, Mapping, Optional, Tuple
from xml.parsers import expat

from ... import _core
from ..._core import Document, Model
from ...model.overrides import apply_link_values
from ...support.values import Value, format_value


def write_values(
    model: Model, values: Mapping[str, Value], aliases: Optional[Mapping[str, str]] = None
) -> Model:
    """Write values of tags and links into the text of a model, and read the changed model.

    Parameters
    ----------
    model
        Model to change.
    values
        Values by ``PLUGIN.TAG``, ``LINK.mass`` and so on.
    aliases
        Alternative names of the tags in the text.

    Raises
    ------
    InputError
        If a value is not valid for the model.
    """
    from xml.sax.saxutils import escape  # imports urllib.request, which is slow

    changed, tags = apply_link_values(
        model, {name: format_value(value) for name, value in values.items()}
    )
    text = changed.document.text.encode()
    names = {key: {key, (aliases or {}).get(key, key)} for key in tags}
    edits = [(*_find_value(text, names[key]), key, escape(value)) for key, value in tags.items()]
    for begin, end, key, value in sorted(edits, reverse=True):
        tag = key.rpartition(".")[2]
        new = value if begin < end else f"<{tag}>{value}</{tag}>"
        text = text[:begin] + new.encode() + text[end:]
    document = Document(changed.document.name, text.decode(), changed.document.lines)
    return _core.read_model(document, list(model.ignored_elements.ignored))


def _find_value(text: bytes, keys: Collection[str]) -> Tuple[int, int]:
    """Find the byte range of a tag's value; for a new tag, both ends are its position."""
    plugin = next(iter(keys)).rpartition(".")[0]
    tags = [[key.rpartition(".")[2]] for key in keys]
    parser = expat.ParserCreate()
    found: Dict[str, int] = {}
    inside: List[str] = []

    def start(element: str, attributes: Mapping[str, str]) -> None:
        if inside:
            inside.append(element)
            if inside[1:] in tags:
                found["begin"] = text.index(b">", parser.CurrentByteIndex) + 1
        elif element == "plugin" and attributes.get("name") == plugin:
            inside.append(element)

    def end(element: str) -> None:
        if not inside:
            return
        if inside[1:] in tags:
            found["end"] = parser.CurrentByteIndex
        inside.pop()
        if not inside:
            found["last"] = parser.CurrentByteIndex

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(text, True)
    if "begin" in found:
        return found["begin"], found["end"]
    return found["last"], found["last"]
