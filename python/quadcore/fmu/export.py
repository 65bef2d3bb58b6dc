"""Export of FMUs."""

from __future__ import annotations

import hashlib
import math
import re
import uuid
import zipfile
from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Any,
    Dict,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    Tuple,
    TypedDict,
    Union,
)

import yaml

from .. import __version__, _core
from .._core import Document, InputError
from ..simulation.engines import EngineName
from ..simulation.flight_plan import FlightPlan
from ..simulation.scenarios import Scenario
from ..simulation.simulation import Simulation
from ..support.input_files import read_bytes
from ..support.output_files import atomic_write
from ..support.values import Number, Value
from .description import make_description
from .libraries import Libraries
from .variables import Variable, list_start_variables, list_variables

if TYPE_CHECKING:
    from typing_extensions import Unpack

_VERSION = 2  # version of flight.yaml, which cpp/fmu/flight_file.cpp reads
_LARGEST = 10**8  # maximum size of a file that a tag names, bytes; same limit as in the core
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # fixed date, so that equal FMUs are bit-identical


class _Options(TypedDict, total=False):
    """Keyword arguments of `export_fmu`."""

    engine: EngineName
    world: Union[str, Path, _core.World, None]
    dt: Optional[float]
    seed: int
    parameters: Optional[Mapping[str, Value]]
    xacro_args: Optional[Mapping[str, object]]
    spawn: Sequence[Number]
    ignore: Sequence[str]
    scenario: Union[str, Path, Scenario, None]
    wind: Optional[Sequence[float]]


def export_fmu(
    path: Union[str, Path],
    model: Union[str, Path, _core.Model] = "quadrotor",
    **options: Unpack[_Options],
) -> None:
    """Write a vehicle in its world as an FMU for co-simulation (FMI 2.0).

    The FMU contains everything that it needs on Linux, and no absolute paths.

    Parameters
    ----------
    path
        Path with the suffix ``.fmu``.
    model
        As for `Simulation`.
    **options
        As for `Simulation`; ``scenario`` and ``wind`` as for `FlightPlan.of`.

    Raises
    ------
    InputError
        If the model or an option is invalid, a plugin is not part of quadcore, or the file cannot
        be written.
    """
    file = Path(path)
    if file.suffix.lower() != ".fmu":
        raise InputError(f"{path}: the suffix is not .fmu. Name a file that ends in .fmu.")
    for name in options:
        if name not in _Options.__annotations__:
            raise InputError(
                f"an FMU has no option {name}: it starts at rest, and its importer commands it. "
                f"Use {', '.join(_Options.__annotations__)}."
            )
    write_fmu(file, FlightPlan.of(model, duration=math.inf, **options))


def write_fmu(path: Path, plan: FlightPlan) -> None:
    """Write the vehicle of a plan as an FMU; the errors are those of `export_fmu`."""
    simulation = plan.simulation()
    if plan.engine not in dict(_core.engines()):
        raise InputError(f"an FMU cannot contain the engine {plan.engine}. Choose another engine.")
    libraries = Libraries(simulation)
    variables = [*list_variables(simulation), *list_start_variables(plan.spawn, plan.seed)]
    files = dict(_read_files(simulation))
    flight = _make_flight_file(
        plan, simulation, variables, {tag: name for tag, (name, _) in files.items()}
    )
    contents = {f"resources/{name}": data for name, data in files.values()}
    digest = hashlib.sha256(_write_yaml(flight))
    for _, data in sorted(contents.items()):
        digest.update(data)
    digest.update(libraries.compute_digest())
    guid = str(uuid.UUID(bytes=digest.digest()[:16]))
    name = simulation.model.name
    identifier = re.sub(r"\W|^(?=\d)", "_", name, flags=re.ASCII)
    contents["modelDescription.xml"] = make_description(
        name, identifier, f"{{{guid}}}", f"quadcore {__version__}", simulation.dt, variables
    )
    contents["resources/flight.yaml"] = _write_yaml({**flight, "guid": f"{{{guid}}}"})
    for library, data in libraries.make_files(identifier, guid).items():
        contents[f"binaries/linux64/{library}"] = data
    with atomic_write(path) as stream, zipfile.ZipFile(stream, "w") as archive:
        for place, data in contents.items():
            entry = zipfile.ZipInfo(place, _LONG_AGO)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)


def _read_files(simulation: Simulation) -> Iterator[Tuple[str, Tuple[str, bytes]]]:
    """Yield PLUGIN.TAG, resource name and content of each file that a tag names."""
    for plugin in simulation.plugins:
        for tag in plugin.parameters:
            if tag.file:
                key = f"{plugin.name}.{tag.name}"
                yield key, (f"{key}{Path(tag.file).suffix}", read_bytes(Path(tag.file), _LARGEST))


def _make_flight_file(
    plan: FlightPlan, simulation: Simulation, variables: List[Variable], files: Dict[str, str]
) -> Dict[str, Any]:
    tags = (variable for variable in variables if variable.kind in ("parameter", "file"))
    return {
        "version": _VERSION,
        "engine": plan.engine,
        "dt": simulation.dt,
        "seed": plan.seed,
        "spawn": [float(x) for x in plan.spawn],
        "model": _pack_document(plan.model.document, plan.model.ignored_elements.ignored),
        "world": _pack_document(plan.world.document, plan.world.ignored_elements.ignored),
        "parameters": {key: value for key, value in plan.parameters.items() if key not in files},
        "tags": {tag.key: str(tag.start) for tag in tags if tag.key not in files},
        "files": files,
        "inputs": {
            topic: [float(v.start or 0) for v in variables if v.kind == "input" and v.key == topic]
            for topic in sorted({v.key for v in variables if v.kind == "input"})
        },
        "variables": [[*v[:4], v.variability, v.type] for v in variables],
    }


def _pack_document(document: Document, ignored: List[str]) -> Dict[str, Any]:
    lines = [(Path(file).name, line) for file, line in document.lines]
    files = sorted({file for file, _ in lines})
    return {
        "name": Path(document.name).name,
        "text": document.text,
        "files": files,
        "lines": [[files.index(file), line] for file, line in lines],
        "ignore": list(ignored),
    }


def _write_yaml(flight: Dict[str, Any]) -> bytes:
    text: str = yaml.safe_dump(flight, default_flow_style=None, allow_unicode=True)
    return text.encode()
