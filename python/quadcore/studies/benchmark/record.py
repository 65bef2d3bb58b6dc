"""Record of a benchmark: version, controllers with the hash of their source, and machine."""

from __future__ import annotations

import hashlib
import importlib.util
import inspect
import platform
from pathlib import Path
from typing import Any, Dict, Optional

import numpy as np

from ... import __version__
from ...control import controllers, gains
from ...control.plugin_controller import find_library
from ...support.input_files import read_bytes
from ...support.user_code import split_name
from ..control_setup import ControlSetup, names_user_code
from ..evaluate.output import list_controllers
from .flights import Benchmark

_LARGEST = 10**8  # maximum size of a source file, bytes


def make_record(found: Benchmark) -> Dict[str, Any]:
    """Describe how a result was made, as plain values that do not change between repetitions."""
    control = found.parts[0].plan.control
    return {
        "benchmark": found.definition.version,
        "definition": found.definition.digest,
        "is_complete": found.is_complete,
        "quadcore": __version__,
        "vehicles": list(dict.fromkeys(part.plan.models[0] for part in found.parts)),
        "categories": list(dict.fromkeys(part.condition.category for part in found.parts)),
        "controllers": [
            _describe_controller(control, row) for row in range(len(control.controllers))
        ],
        "built_in": _list_built_in(found),
        "machine": {
            "system": platform.platform(),
            "processor": platform.machine(),
            "python": platform.python_version(),
            "numpy": np.__version__,
        },
    }


def _describe_controller(control: ControlSetup, row: int) -> Dict[str, Any]:
    thing = control.things[row]
    source = find_source(thing) if control.is_user_code(row) else None
    return {
        "name": control.controllers[row],
        "source": None if source is None else source.name,
        "sha256": None if source is None else _compute_hash(source),
    }


def find_source(thing: Any) -> Optional[Path]:
    """Find the file that defines a user-defined controller; None if there is no such file."""
    if isinstance(thing, str) and controllers.names_gains_file(thing):
        return find_source(gains.read(thing).law)
    if isinstance(thing, str) and names_user_code(thing):
        place = split_name(thing).place
        if controllers.names_plugin(thing):
            return find_library(place)
        if Path(place).suffix:
            return Path(place)
        spec = importlib.util.find_spec(place)
        return None if spec is None or spec.origin is None else Path(spec.origin)
    try:
        file = inspect.getsourcefile(thing if inspect.isroutine(thing) else type(thing))
    except TypeError:  # classes of the interpreter have no source
        return None
    return None if file is None or not Path(file).is_file() else Path(file)


def _compute_hash(file: Path) -> str:
    return hashlib.sha256(read_bytes(file, _LARGEST)).hexdigest()


def _list_built_in(found: Benchmark) -> Any:
    """List all parameters of the built-in controllers on each vehicle."""
    plans = {part.plan.models[0]: part.plan for part in found.parts if part.condition.delay is None}
    plans = plans or {part.plan.models[0]: part.plan for part in found.parts}
    return [row for plan in plans.values() for row in list_controllers(plan)]
