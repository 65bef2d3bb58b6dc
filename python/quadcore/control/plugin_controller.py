"""Controllers that are C++ plugins."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, Mapping

from .._core import InputError, load_plugin_path, plugin_folders
from ..support.input_files import check_regular, is_file

NAME = "controller"
"""Name of the plugin in the model."""


def find_library(library: str) -> Path:
    """Return the path of a plugin; a name without a folder is searched in the plugin folders.

    Raises
    ------
    InputError
        If the file is missing.
    """
    file = Path(library)
    if file.parent == Path():
        folders = [Path(folder) for folder in plugin_folders()]
        file = next((folder / file for folder in folders if is_file(folder / file)), file)
    check_regular(file)
    return file


class PluginController:
    """Controller in a plugin, which a flight plan adds to its vehicle.

    The plugin reads the topics ``odom`` and ``reference``, and publishes ``vel_cmd``.

    Parameters
    ----------
    library : str
        Path of the plugin. A name without a folder is searched in ``QUADCORE_PLUGIN_PATH``.
    tags : mapping of str to float
        Values of its tags by name.

    Raises
    ------
    InputError
        If the file is missing.
    """

    def __init__(self, library: str, tags: Mapping[str, float]) -> None:
        file = find_library(library)
        load_plugin_path(file.resolve().parent)
        self.file = file.name
        self.tags: Dict[str, float] = dict(tags)

    @property
    def delay(self) -> float:
        """NaN, because the plugin delays its commands itself."""
        return math.nan

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Raise `InputError`, because the plugin runs within the simulation."""
        raise InputError(
            f"controller '{self.file}' is a plugin, which this simulation does not have. Fly a "
            "FlightPlan with it, or name it in the URDF."
        )
