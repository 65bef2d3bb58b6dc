"""Gains files: a law with the parameters with which it flies a vehicle.

A mapping in YAML: ``law``, ``vehicle``, ``rate`` [1/s], ``delay`` [s], ``parameters`` by name and
``history``, which is kept for people; only ``law`` must be there. Those that quadcore has lie in
``config/gains/VEHICLE/LAW.yaml``, VEHICLE being the name of the robot in its URDF.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Union

from .. import _core
from ..model import resources
from ..support.import_lock import LOCK
from ..support.input_files import is_file
from ..support.output_files import atomic_write, text_bytes
from .built_in import BuiltInController
from .rate_and_delay import DELAY, RATE, check_rate_or_delay


@dataclass(frozen=True)
class Gains:
    """What a gains file says.

    Attributes
    ----------
    law : str
        Its name.
    vehicle : str
        Name of the robot for which they were made; empty: not told.
    rate : float
        Calls per simulated second.
    delay : float
        Time after which a command reaches the motors, s.
    parameters : mapping of str to float
        Of the law; those that are not there have the law's defaults.
    history
        How they were found: a mapping or a list to be written; what is read has None.
    """

    law: str
    vehicle: str = ""
    rate: float = RATE
    delay: float = DELAY
    parameters: Mapping[str, float] = field(default_factory=dict)
    history: Any = None

    def make(self) -> BuiltInController:
        """Make the law."""
        return BuiltInController(self.law, self.rate, self.delay, (), None, **self.parameters)


def read(path: Union[str, Path]) -> Gains:
    """Read a gains file.

    Parameters
    ----------
    path : str or path
        A YAML file with the law, its parameters, rate and delay.

    Raises
    ------
    InputError
        A missing file, or one that is wrong: one line with file and line.
    """
    return Gains(*_core.read_gains(str(path)))


def write(gains: Gains, path: Union[str, Path]) -> None:
    """Write a gains file, whole or not at all; raises `InputError` if it cannot be written."""
    told: Dict[str, Any] = {"law": gains.law}
    if gains.vehicle:
        told["vehicle"] = gains.vehicle
    told["rate"] = check_rate_or_delay("gains", "rate", gains.rate)
    told["delay"] = check_rate_or_delay("gains", "delay", gains.delay)
    told["parameters"] = {name: float(value) for name, value in gains.parameters.items()}
    if gains.history is not None:
        told["history"] = gains.history
    with LOCK:
        import yaml  # slow to import

    text = yaml.safe_dump(told, sort_keys=False, allow_unicode=True)
    with atomic_write(Path(path)) as stream:
        stream.write(text_bytes(text))


def of_file(path: Union[str, Path]) -> BuiltInController:
    """Make the law of a gains file; raises as `read`.

    Parameters
    ----------
    path : str or path
        As for `read`.
    """
    return read(path).make()


def law_for(name: str, vehicle: str) -> BuiltInController:
    """Make a law with the gains that are shipped for a vehicle, or else with its defaults.

    Parameters
    ----------
    name
        Of the law.
    vehicle
        Name of the robot in its URDF.

    Raises
    ------
    InputError
        No such law.
    """
    path = shipped(name, vehicle)
    return BuiltInController(name) if path is None else of_file(path)


def shipped(name: str, vehicle: str) -> Optional[Path]:
    """Path of the gains that are shipped for a vehicle; None if there are none."""
    folder = resources.root() / "config" / "gains"
    path = folder / vehicle / f"{name}.yaml"
    # A name is no path.
    return path if path.parent.parent == folder and is_file(path) else None
