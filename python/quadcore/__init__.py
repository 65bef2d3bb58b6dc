"""Find out how well a controller flies.

quadcore flies multirotors from their URDF, without Gazebo: its default engine repeats the published
Gazebo 11 model to the last digit, faults included, two others fly the same files without those.

>>> import quadcore as qc
>>> sim = qc.Simulation("quadrotor", engine="eigen", spawn=(0, 0, 10), xacro_args={"sim_slow": 1})
>>> log = sim.run(5.0, controller="geometric", reference="hover")
>>> print(log.position[-1, 2].round(3), "m")
10.0 m
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, List

from . import core as core  # before all that needs it
from . import laws, references
from ._core import (
    FlightError,
    InputError,
    Model,
    QuadcoreError,
    Reference,
    Snapshot,
    World,
    engines,
    load_plugin_path,
    plugin_folders,
)
from .batch import BatchSimulation, BatchState
from .controller import Controller, Odometry
from .description import read_model, read_world
from .forks import LOCK
from .inner_loop import AttitudeThrust, InnerLoop, RatesThrust
from .log import Log
from .resources import cmake_prefix
from .simulation import Simulation
from .state import State
from .warning import QuadcoreWarning

if TYPE_CHECKING:
    from .comparison.compare import compare
    from .comparison.result import Comparison
    from .evaluation.evaluate import Evaluation, evaluate
    from .fitting.fit import Fit, fit
    from .flight_plan import FlightPlan
    from .fmu.export import export_fmu
    from .sweeps.sweep import Sweep, sweep
    from .tuning.tune import tune

__version__ = "0.1.0"

__all__ = [
    "AttitudeThrust",
    "BatchSimulation",
    "BatchState",
    "Comparison",
    "Controller",
    "Evaluation",
    "Fit",
    "FlightError",
    "FlightPlan",
    "InnerLoop",
    "InputError",
    "Log",
    "Model",
    "Odometry",
    "QuadcoreError",
    "QuadcoreWarning",
    "RatesThrust",
    "Reference",
    "Simulation",
    "Snapshot",
    "State",
    "Sweep",
    "World",
    "cmake_prefix",
    "compare",
    "engines",
    "evaluate",
    "export_fmu",
    "fit",
    "laws",
    "load_plugin_path",
    "plugin_folders",
    "read_model",
    "read_world",
    "references",
    "sweep",
    "tune",
]

_STUDIES = {
    "Comparison": "comparison.result",
    "Evaluation": "evaluation.evaluate",
    "Fit": "fitting.fit",
    "FlightPlan": "flight_plan",
    "Sweep": "sweeps.sweep",
    "compare": "comparison.compare",
    "evaluate": "evaluation.evaluate",
    "export_fmu": "fmu.export",
    "fit": "fitting.fit",
    "sweep": "sweeps.sweep",
    "tune": "tuning.tune",
}
"""Where names lie that are brought in when they are first asked for: flying once needs none."""


def __getattr__(name: str) -> Any:
    if name not in _STUDIES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    with LOCK:
        value = getattr(import_module(f"{__name__}.{_STUDIES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> List[str]:
    return sorted({*globals(), *__all__})
