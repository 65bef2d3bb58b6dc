"""``quadcore list``: names that other commands accept."""

from __future__ import annotations

import argparse
from typing import Any, Dict, List

from .. import _core
from ..model import resources
from ..simulation.engines import list_engines
from ..simulation.scenarios import NONE
from . import options, terminal
from .parser import add_command

_FOLDERS = {"models": "urdf", "worlds": "worlds", "scenarios": "config/scenarios"}
"""Folders of the built-in files."""

KINDS = (*_FOLDERS, "controllers", "references", "engines")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "list",
        "List the built-in models, worlds, scenarios, controllers, references or engines.",
        print_names,
        """
        quadcore list models
        quadcore list controllers --json
        """,
    )
    parser.add_argument("kind", metavar="KIND", choices=KINDS, help=", ".join(KINDS))
    options.add_json(parser)


def print_names(arguments: argparse.Namespace) -> None:
    """Print the names with their meanings or files."""
    entries = list_entries(arguments.kind)
    if arguments.json:
        terminal.print_json(entries)
    else:
        print_entries(entries)


def print_entries(entries: List[Dict[str, Any]]) -> None:
    """Print a table of names and their meanings or files."""
    table = terminal.make_table("", "", show_header=False)
    for entry in entries:
        table.add_row(entry["name"], entry.get("summary") or entry.get("file", ""))
    terminal.make_console().print(table)


def list_entries(kind: str) -> List[Dict[str, Any]]:
    """List the entries of a kind with all their properties."""
    if kind in _FOLDERS:
        files = resources.list_shipped(_FOLDERS[kind])
        found: List[Dict[str, Any]] = [
            {"name": name, "file": str(file)} for name, file in files.items()
        ]
        if kind == "scenarios":
            found.insert(0, {"name": NONE, "summary": "no disturbance"})
        return found
    if kind == "engines":
        return [{"name": name, "summary": summary} for name, summary in list_engines()]
    tables: Any = _core.controllers() if kind == "controllers" else _core.references()
    return [
        {
            "name": name,
            "summary": summary,
            "parameters": [
                {
                    "name": spec.name,
                    "default": spec.default,
                    "unit": spec.unit,
                    "meaning": spec.meaning,
                }
                for spec in table
            ],
        }
        for name, summary, table, *_ in tables
    ]
