"""Gains files: the parameters of a controller for a vehicle.

A gains file is a YAML mapping with ``law`` (name of the controller), ``vehicle``, ``rate`` (1/s),
``delay`` (s), ``parameters`` by name, and ``history``, which is only for the reader. Only ``law``
is required. The built-in files are ``config/gains/VEHICLE/LAW.yaml``, where VEHICLE is the name of
the robot in its URDF.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Tuple, Union

from .. import _core
from ..model import resources
from ..support.import_lock import LOCK
from ..support.output_files import atomic_write, encode_text
from .built_in import BuiltInController
from .rate_and_delay import DELAY, RATE, check_rate_or_delay


@dataclass(frozen=True)
class Gains:
    """Contents of a gains file.

    Attributes
    ----------
    law : str
        Name of the controller.
    vehicle : str
        Name of the robot for which the gains are tuned; empty if unknown.
    rate : float
        Calls per simulated second, 1/s; NaN for a plugin, which sets its own rate.
    delay : float
        Actuation delay, s; NaN for a plugin, which sets its own delay.
    parameters : mapping of str to float
        Parameters of the controller. Missing parameters have their default values.
    history : mapping or list, optional
        Origin of the gains, which is written but never used.
    """

    law: str
    vehicle: str = ""
    rate: float = RATE
    delay: float = DELAY
    parameters: Mapping[str, float] = field(default_factory=dict)
    history: Any = None

    def make(self) -> BuiltInController:
        """Make the controller."""
        return BuiltInController(self.law, self.rate, self.delay, (), None, **self.parameters)


def read(path: Union[str, Path]) -> Gains:
    """Read a gains file.

    Parameters
    ----------
    path : str or path
        YAML file.

    Raises
    ------
    InputError
        If the file is missing or invalid; the message begins with ``FILE:LINE``.
    """
    return Gains(*_core.read_gains(str(path)))


def write(gains: Gains, path: Union[str, Path]) -> None:
    """Write a gains file atomically; if this fails, an existing file does not change.

    Parameters
    ----------
    gains : Gains
        Contents of the file.
    path : str or path
        Path of the YAML file.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    contents: Dict[str, Any] = {"law": gains.law}
    if gains.vehicle:
        contents["vehicle"] = gains.vehicle
    for name, value in (("rate", gains.rate), ("delay", gains.delay)):
        if not math.isnan(value):
            contents[name] = check_rate_or_delay("gains", name, value)
    contents["parameters"] = {name: float(value) for name, value in gains.parameters.items()}
    if gains.history is not None:
        contents["history"] = gains.history
    with LOCK:
        import yaml  # slow to import

    text = yaml.safe_dump(contents, sort_keys=False, allow_unicode=True)
    with atomic_write(Path(path)) as stream:
        stream.write(encode_text(text))


def read_controller(path: Union[str, Path]) -> BuiltInController:
    """Make the controller that a gains file describes.

    Parameters
    ----------
    path : str or path
        YAML file.

    Raises
    ------
    InputError
        If the file is missing or invalid; the message begins with ``FILE:LINE``.
    """
    return read(path).make()


def make_for_vehicle(name: str, vehicle: str) -> BuiltInController:
    """Make a controller with the built-in gains of a vehicle, or with the default gains.

    Parameters
    ----------
    name
        Name of the controller.
    vehicle
        Name of the robot in its URDF.

    Raises
    ------
    InputError
        If the controller does not exist.
    """
    path = find_shipped(name, vehicle)
    return BuiltInController(name) if path is None else read_controller(path)


def find_shipped(name: str, vehicle: str) -> Optional[Path]:
    """Return the path of the built-in gains of a vehicle; None if they do not exist."""
    return _list_shipped().get((vehicle, name))


@lru_cache(maxsize=None)
def _list_shipped() -> Dict[Tuple[str, str], Path]:
    """List the files of built-in gains by vehicle and controller."""
    folder = resources.find_root() / "config" / "gains"
    return {(path.parent.name, path.stem): path for path in folder.glob("*/*.yaml")}
