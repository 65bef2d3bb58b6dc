"""Descriptions of the options of studies, in the metadata of the fields of a dataclass."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Callable, Dict, NamedTuple

from ..support import arguments
from ..support.arguments import Kind

VEHICLE, FLIGHT, CONTROLLER, STUDY, OUTPUT = GROUPS = (
    "vehicle and world",
    "flight",
    "controller",
    "study",
    "output",
)
"""Headings under which `--help` lists options, in this order."""


class OptionInfo(NamedTuple):
    """How an option is written, read, checked and explained."""

    group: str
    """One of `GROUPS`."""
    flag: str
    """Name on the command line; "" for an option of the Python functions only."""
    metavar: str
    meaning: str
    read: Callable[[str], Any]
    """Reads the text of the command line."""
    kind: Kind
    without: str
    """Default in words, "" if the default value is clear."""
    repeats: bool


def describe_option(
    group: str,
    flag: str,
    metavar: str,
    meaning: str,
    read: Callable[[str], Any] = str,
    kind: Kind = arguments.ANY,
    without: str = "",
    repeats: bool = False,
) -> Dict[str, OptionInfo]:
    """Return the metadata of a field with the description of its option."""
    return {"about": OptionInfo(group, flag, metavar, meaning, read, kind, without, repeats)}


def describe_options(kind: Any) -> Dict[str, OptionInfo]:
    """Return the description of each option, by name."""
    return {each.name: each.metadata["about"] for each in fields(kind)}


def list_kinds(kind: Any) -> Dict[str, Kind]:
    """Give the kind of each option's value, by name."""
    return {name: about.kind for name, about in describe_options(kind).items()}


def explain(about: OptionInfo, default: Any) -> str:
    """Write the meaning and the default of an option in one line."""
    plain = f"{default:g}" if isinstance(default, float) else str(default)
    without = about.without or ("" if default in (None, ()) else plain)
    return f"{about.meaning} (default: {without})" if without else about.meaning
