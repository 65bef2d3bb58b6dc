"""Descriptions of the options of studies, as metadata of dataclass fields."""

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
"""Headings of the options in `--help`, in this order."""


class OptionInfo(NamedTuple):
    """Name, format, check and explanation of an option."""

    group: str
    """One of `GROUPS`."""
    flag: str
    """Name on the command line; "" if only the Python functions accept the option."""
    metavar: str
    meaning: str
    read: Callable[[str], Any]
    """Parses the text from the command line."""
    kind: Kind
    without: str
    """Default in words; "" if the default value is self-explanatory."""
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
    """Return the metadata of a field that describe its option."""
    return {"about": OptionInfo(group, flag, metavar, meaning, read, kind, without, repeats)}


def describe_options(kind: Any) -> Dict[str, OptionInfo]:
    """Return the description of each option by name."""
    return {each.name: each.metadata["about"] for each in fields(kind)}


def list_kinds(kind: Any) -> Dict[str, Kind]:
    """Return the kind of each option's value by name."""
    return {name: about.kind for name, about in describe_options(kind).items()}


def explain(about: OptionInfo, default: Any) -> str:
    """Return the meaning and the default of an option in one line."""
    plain = f"{default:g}" if isinstance(default, float) else str(default)
    without = about.without or ("" if default in (None, ()) else plain)
    return f"{about.meaning} (default: {without})" if without else about.meaning
