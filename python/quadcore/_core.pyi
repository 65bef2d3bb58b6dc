"""Types of the C++ core."""

import os
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

class QuadcoreError(RuntimeError):
    """Base of every error that quadcore raises."""

class InputError(QuadcoreError):
    """The input is at fault; the refused call changed nothing."""

class FlightError(QuadcoreError):
    """The flight itself failed."""

    time: float

class Document:
    largest: int
    most_levels: int
    most_attributes: int
    name: str
    text: str
    lines: List[Tuple[str, int]]
    def __init__(self, name: str, text: str, lines: Sequence[Tuple[str, int]] = ...) -> None: ...

class Link:
    name: str
    where: str
    mass: float
    center_of_mass: Array
    inertia: Array

class Joint:
    name: str
    where: str
    damping: float
    axis: Array
    xyz: Array
    rpy: Array

class Model:
    name: str
    links: List[Link]
    joints: List[Joint]
    warnings: List[str]

class World:
    gravity: Array
    wind: Array
    max_step_size: float
    real_time_update_rate: float
    ground_plane: bool

class ParameterInfo:
    name: str
    value: str
    unit: str
    default: Optional[str]
    range: str
    meaning: str
    equation: str
    alias: str
    origin: str

class PluginInfo:
    name: str
    filename: str
    path: str
    summary: str
    parameters: List[ParameterInfo]

class Snapshot: ...

class Simulation:
    def __init__(
        self,
        model: Model,
        world: World,
        engine: str,
        dt: Optional[float],
        seed: int,
        parameters: Dict[str, str],
        spawn: Sequence[float],
    ) -> None: ...
    def command(self, speeds: npt.ArrayLike) -> None: ...
    def step(self, n: int = ...) -> None: ...
    def set_state(self, state: Any) -> None: ...
    def snapshot(self) -> Snapshot: ...
    def restore(self, snapshot: Snapshot) -> None: ...
    def reset(self) -> None: ...
    def topic(self, name: str) -> Dict[str, float]: ...
    def _views(self) -> Dict[str, Array]: ...
    @property
    def time(self) -> float: ...
    @property
    def dt(self) -> float: ...
    @property
    def engine(self) -> str: ...
    @property
    def model(self) -> Model: ...
    @property
    def warnings(self) -> List[str]: ...
    @property
    def plugins(self) -> List[PluginInfo]: ...
    @property
    def rotor_count(self) -> int: ...
    @property
    def rotor_names(self) -> List[str]: ...
    @property
    def command_width(self) -> int: ...
    @property
    def mass(self) -> float: ...
    @property
    def center_of_mass(self) -> Array: ...
    @property
    def inertia(self) -> Array: ...
    @property
    def wrench_terms(self) -> List[str]: ...

class Flight:
    def __init__(
        self, simulation: Simulation, commands: Optional[Array], log_every: int
    ) -> None: ...
    def advance(self, n: int) -> None: ...
    @property
    def table(self) -> Array: ...
    @property
    def wrenches(self) -> Array: ...

def read_model(document: Document) -> Model: ...
def read_world(document: Document) -> World: ...
def log_columns(rotor_count: int) -> List[str]: ...
def load_plugin_path(folder: Union[str, os.PathLike[str]]) -> None: ...
def plugin_folders() -> List[str]: ...
def engines() -> List[Tuple[str, str]]: ...
