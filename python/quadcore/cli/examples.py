"""``quadcore examples``: copy the examples that come with quadcore."""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path
from typing import Any

from .._core import InputError
from ..model import resources
from ..support.output_files import make_folder
from . import options, terminal
from .parser import add_command

_FOLDERS = ("notebooks", "examples", "config")
_LEFT_OUT = shutil.ignore_patterns("__pycache__", "build", ".*")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "examples",
        "Copy notebooks, examples and configuration files into a folder.",
        copy_examples,
        "quadcore examples quadcore_examples",
    )
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder; created if it is missing")
    options.add_quiet(parser)


def copy_examples(arguments: argparse.Namespace) -> None:
    """Copy the folders without overwriting files."""
    for name in _FOLDERS:
        if not (resources.find_root() / name).is_dir():
            raise InputError(
                f"{resources.find_root()}: has no folder {name}. Install quadcore again."
            )
        if (arguments.folder / name).exists():
            raise InputError(f"{arguments.folder / name}: exists already. Name another folder.")
    make_folder(arguments.folder)
    for name in _FOLDERS:
        target = arguments.folder / name
        shutil.copytree(resources.find_root() / name, target, ignore=_LEFT_OUT)
        if not arguments.quiet:
            terminal.print_written([target])
