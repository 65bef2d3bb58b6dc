"""Events of scenarios, which are converted to lists in plugin tags."""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

import yaml

from .._core import InputError, parse_number
from ..support.parameters import suggest
from ..support.yaml_nodes import find_line, read_numbers, read_pairs


class EventKind(NamedTuple):
    """Kind of event, identified by its key."""

    library: str
    """Library of the plugin, and default name of the plugin."""
    tag: str
    numbers: int
    """Number of values after the key; 0 if the value is the name of a plugin."""
    others: Mapping[str, Tuple[int, str]]
    """Additional keys with their number of values and their default ("" for a required key)."""
    row: str
    """Format of the row that is added to the tag."""
    label: str
    """Format of the label in plots."""


KINDS: Dict[str, EventKind] = {
    "gust": EventKind("wind", "gusts", 3, {"lasts": (1, "")}, "{gust} {at} {lasts}", "gust"),
    "push": EventKind(
        "push",
        "pushes",
        3,
        {"torque": (3, "0 0 0"), "lasts": (1, "")},
        "{at} {lasts} {push} {torque}",
        "push",
    ),
    "release": EventKind("payload", "release", 0, {}, "{at}", "{release} released"),
    "pick_up": EventKind("payload", "pickUp", 0, {}, "{at}", "{pick_up} picked up"),
    "weaken": EventKind(
        "fault", "losses", 1, {"to": (1, "")}, "{at} {weaken} {to}", "rotor {weaken} to {to}"
    ),
    "cut": EventKind("fault", "cuts", 1, {}, "{at} {cut}", "rotor {cut} cut"),
}
"""Kinds of events by key."""


class Event(NamedTuple):
    """Event in a flight."""

    time: float
    """Simulation time, s."""
    text: str
    """Label in plots and messages."""
    plugin: str
    library: str
    tag: str
    row: str
    """Row that the event adds to the tag."""
    may_repeat: bool
    thing: str
    """Name of the affected part in messages."""
    rotor: Optional[float]
    """Number of the affected rotor, starting at 1; None for other events."""
    line: int

    def check(self, file: str, rotors: int) -> None:
        """Raise `InputError` if the vehicle does not have the affected rotor."""
        if self.rotor is not None and self.rotor not in range(1, rotors + 1):
            raise InputError(
                f"{file}:{self.line}: rotor {self.rotor:g} does not exist. Use 1 to {rotors}."
            )


def read_events(file: str, node: yaml.Node) -> Sequence[Event]:
    """Read the events of a scenario, sorted by time.

    Parameters
    ----------
    file
        Name of the scenario file in messages.
    node
        YAML node with the list of events.

    Raises
    ------
    InputError
        If an event is invalid; the message begins with ``FILE:LINE``.
    """
    what = "events as a list of {at: TIME, KIND: ...}"
    if not isinstance(node, yaml.SequenceNode):
        raise InputError(f"{file}:{find_line(node)}: write {what}")
    events: List[Event] = []
    for item in node.value:
        event = _read_event(file, item, what)
        for other in events:
            if (other.time, other.thing) == (event.time, event.thing):
                raise InputError(
                    f"{file}:{event.line}: a second event on {event.thing} at {event.time:g} s, "
                    f"the first in line {other.line}. Keep one."
                )
        events.append(event)
    return sorted(events, key=lambda event: event.time)


def _read_event(file: str, node: yaml.Node, what: str) -> Event:
    given = {key.value: (key, value) for key, value in read_pairs(file, node, what)}
    where = f"{file}:{find_line(node)}"
    named = [name for name in given if name in KINDS]
    if len(named) != 1:
        several = " and ".join(named) or _name_unknown(given)
        raise InputError(f"{where}: an event is {several}. Write one of {', '.join(KINDS)}.")
    (name,) = named
    kind = KINDS[name]
    wanted = {name: (kind.numbers, ""), "at": (1, ""), **kind.others}
    if kind.numbers:
        wanted["plugin"] = (0, kind.library)
    values = {}
    for key, (node_of_key, _) in given.items():
        if key not in wanted:
            known = list(wanted)
            raise InputError(
                f"{file}:{find_line(node_of_key)}: {name} has no '{key}'.{suggest(key, known)} "
                f"Write {', '.join(known)}."
            )
    for key, (count, default) in wanted.items():
        if key in given:
            values[key] = read_numbers(file, key, given[key][1], count)
        elif default:
            values[key] = default
        else:
            raise InputError(f"{where}: {name} lacks '{key}'. Write it.")
    time = parse_number(values["at"])
    assert time is not None  # the value was already read as a number
    if time < 0:
        at = find_line(given["at"][0])
        raise InputError(
            f"{file}:{at}: an event at {time:g} s is before the start. Write at: >= 0."
        )
    plugin = values["plugin"] if kind.numbers else values[name]
    rotor = parse_number(values[name]) if kind.numbers == 1 else None
    thing = f"rotor {values[name]}" if kind.numbers == 1 else f"'{plugin}'"
    row = kind.row.format(**values)
    may_repeat = kind.numbers > 0
    text = kind.label.format(**values)
    return Event(
        time, text, plugin, kind.library, kind.tag, row, may_repeat, thing, rotor, find_line(node)
    )


def _name_unknown(given: Mapping[str, object]) -> str:
    others = [name for name in given if name != "at"]
    return f"'{others[0]}'" if others else "nothing"
