"""Scenarios: disturbances, faults, payload events and obstacles of a flight, in YAML.

A scenario file is a mapping with ``plugins``, ``events`` and ``obstacles``. ``plugins`` contains
tag values by plugin; plugins that the model does not have are added. `KINDS` lists the events. The
built-in files are ``config/scenarios/NAME.yaml``.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union
from xml.parsers import expat

import yaml

from .._core import Document, InputError, Model, World, read_model
from ..control.plugin_controller import NAME, PluginController
from ..model import resources
from ..support.input_files import check_regular, is_file
from ..support.output_files import printable_name
from ..support.parameters import suggest
from ..support.yaml_nodes import find_line, read_pairs, read_root, read_scalar
from .scenario_events import Event, read_events
from .scenario_obstacles import PlacedObstacle, add_obstacles, read_obstacles

NONE = "none"
"""Name of the scenario without disturbances."""

_LIBRARY = "library"
_SECTIONS = ("plugins", "events", "obstacles")
_WRITE = "plugins:, events: or obstacles:"


class Tag(NamedTuple):
    """Tag of a plugin in a scenario file."""

    name: str
    value: str
    line: int


class PluginEntry(NamedTuple):
    """Plugin in a scenario file."""

    name: str
    library: str
    line: int
    tags: List[Tag]


class Scenario:
    """Contents of a scenario file.

    Parameters
    ----------
    path : str or path
        File, or name of a built-in scenario.

    Attributes
    ----------
    name : str
        Name of the file without its suffix.
    events : sequence of Event
        Events, sorted by time.

    Raises
    ------
    InputError
        If the file is missing or invalid; the message begins with ``FILE:LINE``.
    """

    def __init__(self, path: Union[str, Path]) -> None:
        file = _find(str(path))
        self.name = file.name.split(".")[0]
        self._file = printable_name(file)
        nodes = _read_sections(self._file, read_root(file))
        additions = {}
        if "plugins" in nodes:
            what = "plugins as NAME: {TAG: VALUE, ...}"
            for key, node in read_pairs(self._file, nodes["plugins"], what):
                additions[key.value] = _read_plugin(self._file, key, node)
        self.events: Sequence[Event] = ()
        if "events" in nodes:
            self.events = read_events(self._file, nodes["events"])
        for event in self.events:
            library = f"lib{event.library}_plugin.so"
            addition = additions.setdefault(
                event.plugin, PluginEntry(event.plugin, library, event.line, [])
            )
            _add_event(self._file, addition, event)
        self._additions = list(additions.values())
        self._obstacles: Sequence[PlacedObstacle] = ()
        if "obstacles" in nodes:
            self._obstacles = read_obstacles(self._file, nodes["obstacles"])

    def apply_to(self, model: Model) -> Tuple[Model, Dict[str, str]]:
        """Apply the scenario to a model.

        Returns
        -------
        tuple
            Model with the added plugins, and values by ``PLUGIN.TAG`` for plugins that the model
            already has.

        Raises
        ------
        InputError
            If a plugin, tag, value or rotor is invalid; the message begins with ``FILE:LINE``.
        """
        for event in self.events:
            event.check(self._file, len(model.joints))
        own, end = _find_plugins(model.document.text)
        parameters = {
            f"{addition.name}.{tag.name}": tag.value
            for addition in self._additions
            if addition.name in own
            for tag in addition.tags
        }
        added = [addition for addition in self._additions if addition.name not in own]
        if not added:
            return model, parameters
        document = _insert_plugins(model.document, end, added, self._file)
        return read_model(document, list(model.ignored_elements.ignored)), parameters

    def add_obstacles(self, world: World) -> World:
        """Return the world with the obstacles of the scenario.

        Raises
        ------
        InputError
            If an obstacle is invalid; the message begins with ``FILE:LINE``.
        """
        return add_obstacles(world, self._obstacles, self._file)

    def describe_late_events(self, end: float) -> str:
        """Return a warning about events after the end of a flight; "" without such events.

        Parameters
        ----------
        end
            Time at which the flight ends, s.
        """
        late = [event for event in self.events if event.time >= end]
        if not late:
            return ""
        events = ", ".join(f"{event.text} at {event.time:g} s" for event in late)
        return f"{self._file}:{late[0].line}: the flight ends at {end:g} s, before {events}"

    @contextmanager
    def locate_errors(self) -> Iterator[None]:
        """Add file and line to errors in the block that concern tags of the scenario."""
        try:
            yield
        except InputError as error:
            for addition in self._additions:
                for tag in addition.tags:
                    where = f"{self._file}:{tag.line}"
                    given = re.escape(f"{addition.name}.{tag.name}")
                    if re.match(rf"set {given}(?![\w.])", str(error)):
                        raise InputError(f"{where}: {str(error)[4:]}") from error
                    # If two plugins must agree, the message names the line in the model file.
                    if re.search(rf"<{tag.name}> is .* in '{addition.name}' \(set\)", str(error)):
                        raise InputError(f"{where}: {error}") from error
            raise


def add_wind(model: Model, velocity: Sequence[float]) -> Tuple[Model, Dict[str, str]]:
    """Add a constant wind to a model.

    Parameters
    ----------
    model
        Model of the vehicle.
    velocity
        Velocity of the air, world axes, m/s.

    Returns
    -------
    tuple
        Model with a plugin ``wind``, and values by ``PLUGIN.TAG`` if the model already has one.
    """
    text = " ".join(repr(float(part)) for part in velocity)
    names, end = _find_plugins(model.document.text)
    if "wind" in names:
        return model, {"wind.velocity": text}
    wind = PluginEntry("wind", "libwind_plugin.so", 1, [Tag("velocity", text, 1)])
    document = _insert_plugins(model.document, end, [wind], "--wind")
    return read_model(document, list(model.ignored_elements.ignored)), {}


def add_controller(model: Model, controller: PluginController) -> Model:
    """Add the plugin of a controller to a model."""
    _, end = _find_plugins(model.document.text)
    tags = [Tag(name, repr(value), 1) for name, value in controller.tags.items()]
    entry = PluginEntry(NAME, controller.file, 1, tags)
    document = _insert_plugins(model.document, end, [entry], controller.file)
    return read_model(document, list(model.ignored_elements.ignored))


def read_scenario(scenario: Union[str, Path, Scenario, None]) -> Optional[Scenario]:
    """Read a scenario unless it is already read; return None for `NONE`."""
    if scenario is None or isinstance(scenario, Scenario):
        return scenario
    return None if str(scenario) == NONE else Scenario(scenario)


def _find(name: str) -> Path:
    if is_file(Path(name)):
        return Path(name)
    known = resources.list_shipped("config/scenarios")
    if name in known:
        return known[name]
    if Path(name).exists():
        check_regular(Path(name))
    names = [NONE, *known]
    raise InputError(
        f"{name}: neither a file nor a built-in scenario.{suggest(name, names)} Name a file, or "
        f"one of {', '.join(names)}."
    )


def _read_sections(file: str, node: yaml.Node) -> Dict[str, yaml.Node]:
    found = {}
    for key, value in read_pairs(file, node, _WRITE):
        if key.value not in _SECTIONS:
            raise InputError(
                f"{file}:{find_line(key)}: a scenario has no '{key.value}'. Write {_WRITE}."
            )
        found[key.value] = value
    return found


def _read_plugin(file: str, key: yaml.ScalarNode, node: yaml.Node) -> PluginEntry:
    tags = [
        Tag(tag.value, _read_value(file, tag, value), find_line(tag))
        for tag, value in read_pairs(file, node, "{TAG: VALUE, ...}, or {}")
    ]
    library = key.value
    for tag in tags:
        if not re.fullmatch(r"[A-Za-z_][\w.-]*", tag.name):
            raise InputError(
                f"{file}:{tag.line}: '{tag.name}' is not the name of a tag. Write one."
            )
        if tag.name == _LIBRARY:
            library = tag.value
    if not library.endswith(".so"):
        library = f"lib{library}_plugin.so"
    others = [tag for tag in tags if tag.name != _LIBRARY]
    return PluginEntry(key.value, library, find_line(key), others)


def _read_value(file: str, tag: yaml.ScalarNode, node: yaml.Node) -> str:
    if isinstance(node, yaml.SequenceNode):
        return " ".join(read_scalar(file, tag.value, item) for item in node.value)
    return read_scalar(file, tag.value, node)


def _add_event(file: str, addition: PluginEntry, event: Event) -> None:
    """Add an event to the list in the plugin tag."""
    for i, tag in enumerate(addition.tags):
        if tag.name != event.tag:
            continue
        if not event.may_repeat:
            raise InputError(
                f"{file}:{event.line}: <{tag.name}> of '{addition.name}' is given twice, first in "
                f"line {tag.line}. Keep one."
            )
        addition.tags[i] = tag._replace(value=f"{tag.value} {event.row}")
        return
    addition.tags.append(Tag(event.tag, event.row, event.line))


def _find_plugins(text: str) -> Tuple[List[str], int]:
    """Return the plugin names of a model, and the position at which its root element ends."""
    parser = expat.ParserCreate()
    names: List[str] = []
    end = depth = 0

    def start(element: str, attributes: Mapping[str, str]) -> None:
        nonlocal depth
        depth += 1
        if element == "plugin":
            names.append(attributes.get("name", ""))

    def stop(_: str) -> None:
        nonlocal depth, end
        depth -= 1
        if depth == 0:
            end = parser.CurrentByteIndex

    parser.StartElementHandler, parser.EndElementHandler = start, stop
    encoded = text.encode()
    parser.Parse(encoded, True)
    return names, len(encoded[:end].decode())


def _insert_plugins(
    document: Document, end: int, added: Sequence[PluginEntry], file: str
) -> Document:
    """Insert plugins into a model; error messages about them refer to lines of the scenario."""
    from xml.sax.saxutils import escape, quoteattr  # imports urllib.request, which is slow

    before, after = document.text[:end], document.text[end:]
    count = document.text.count("\n") + 1
    lines: List[Any] = document.lines or [(document.name, i + 1) for i in range(count)]
    last = before.count("\n") + 1  # line in which the root element ends
    written, places = [], []
    for addition in added:
        head = f"name={quoteattr(addition.name)} filename={quoteattr(addition.library)}"
        written.append(f"<gazebo><plugin {head}>")
        places.append((file, addition.line))
        for tag in addition.tags:
            value = escape(" ".join(tag.value.split()))
            written.append(f"<{tag.name}>{value}</{tag.name}>")
            places.append((file, tag.line))
        written.append("</plugin></gazebo>")
        places.append((file, addition.line))
    text = "\n".join([before, *written, after])
    return Document(document.name, text, [*lines[:last], *places, *lines[last - 1 :]])
