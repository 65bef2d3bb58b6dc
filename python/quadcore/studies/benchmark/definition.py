"""Definition of a benchmark: vehicles, references, scenarios and seeds of a version."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence

import yaml

from ..._core import InputError
from ...model import resources
from ...support.input_files import read_bytes, read_text
from ...support.parameters import suggest

_FOLDER = "config/benchmark"
_FILE = "benchmark.yaml"
_LARGEST = 10**6  # maximum size of a file, bytes

VERSIONS = tuple(
    sorted(path.parent.name for path in (resources.find_root() / _FOLDER).glob(f"*/{_FILE}"))
)
LATEST = VERSIONS[-1]


class Condition(NamedTuple):
    """A scenario of the benchmark with its references."""

    category: str
    name: str
    references: Sequence[str]
    scenario: Optional[str] = None
    """File name in the folder of the version; ``{vehicle}`` stands for the vehicle. None: none."""
    seeds: int = 1
    delay: Optional[float] = None
    """Actuation delay of all controllers, s. Default: the controller's own."""


class Definition:
    """Contents of a version.

    Parameters
    ----------
    version
        Name, such as ``v1``.

    Attributes
    ----------
    engine : str
        Engine of all flights.
    duration : float
        Duration of each flight, s.
    vehicles : dict
        Arguments of the xacro file by vehicle.
    references : dict of str to str
        References by label, as on the command line.
    conditions : list of Condition
        Scenarios of all categories.
    digest : str
        SHA-256 of all input files of the version, hexadecimal.

    Raises
    ------
    InputError
        If the version does not exist.
    """

    def __init__(self, version: str = LATEST) -> None:
        if version not in VERSIONS:
            raise InputError(
                f"benchmark '{version}' does not exist.{suggest(version, VERSIONS)} Use one of "
                f"{', '.join(VERSIONS)}."
            )
        self.version = version
        self.folder = resources.find_root() / _FOLDER / version
        content = yaml.safe_load(read_text(self.folder / _FILE))
        self.engine: str = content["engine"]
        self.duration = float(content["duration"])
        self.vehicles: Dict[str, Dict[str, Any]] = content["vehicles"]
        self.references = {
            label: self._complete_path(text) for label, text in content["references"].items()
        }
        self.conditions: List[Condition] = [
            Condition(category, name, **given)
            for category, conditions in content["categories"].items()
            for name, given in conditions.items()
        ]
        self.digest = self._compute_digest()

    @property
    def categories(self) -> List[str]:
        """Names of the categories."""
        return list(dict.fromkeys(condition.category for condition in self.conditions))

    @property
    def results(self) -> Path:
        """File with the results of the built-in controllers."""
        return self.folder / "results" / "built_in.csv"

    def find_scenario(self, condition: Condition, vehicle: str) -> Optional[Path]:
        """Return the scenario file of a condition for a vehicle; None without a scenario."""
        if condition.scenario is None:
            return None
        return self.folder / condition.scenario.format(vehicle=vehicle)

    def _complete_path(self, reference: str) -> str:
        name, _, file = reference.partition(":")
        return f"{name}:{self.folder / file}" if file.endswith(".csv") else reference

    def _compute_digest(self) -> str:
        whole = hashlib.sha256()
        for path in sorted(self.folder.glob("*.*")):
            whole.update(f"{path.name}\n".encode())
            whole.update(hashlib.sha256(read_bytes(path, _LARGEST)).digest())
        return whole.hexdigest()
