"""Multirotor simulator and controller test bench.

quadcore simulates multirotors from their URDF, without Gazebo. Its default engine is
bit-identical to Gazebo 11, including the bugs of Gazebo. The engines "ode" and "eigen" simulate
the same files without these bugs.

>>> import quadcore as qc
>>> sim = qc.Simulation("quadrotor", engine="eigen", spawn=(0, 0, 10), xacro_args={"sim_slow": 1})
>>> log = sim.run(5.0, controller="geometric", reference="hover")
>>> print(log.position[-1, 2].round(3), "m")
10.0 m
"""

import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any, List

from .support import core_library  # noqa: F401, for it explains which library is missing

# isort: split
from ._core import (
    FlightError,
    InputError,
    Model,
    Odometry,
    QuadcoreError,
    Reference,
    Rotor,
    Snapshot,
    World,
    engines,
    load_plugin_path,
    plugin_folders,
)
from .control import controllers, gains, references
from .control.compiled_controller import CompiledController
from .control.controller import Controller
from .control.inner_loop import AttitudeThrust, InnerLoop, RatesThrust, WrenchThrust
from .control.keywords import ControllerName, ReferenceName
from .control.vehicle import Vehicle
from .model.description import read_model, read_world
from .model.resources import cmake_prefix
from .simulation.batch import BatchSimulation, BatchState
from .simulation.engines import AddedEngine, EngineName, add_engine
from .simulation.log import Log
from .simulation.simulation import Simulation
from .simulation.state import State
from .support.import_lock import LOCK
from .support.warning import QuadcoreWarning
from .thesis import LAGRANGE, LAGRANGE_SUMMARY

if TYPE_CHECKING:
    from . import autopilots
    from .fmu.export import export_fmu
    from .simulation.fleet import Fleet
    from .simulation.flight_plan import FlightPlan
    from .simulation.view import View, view
    from .studies.benchmark.flights import Benchmark, benchmark
    from .studies.compare.compare import compare
    from .studies.compare.result import Comparison
    from .studies.evaluate.evaluate import Evaluation, evaluate
    from .studies.evaluate.measure import measure
    from .studies.fit.fit import Fit, fit
    from .studies.sweep.sweep import Sweep, sweep
    from .studies.tune.tune import tune

__version__ = "0.1.0"

PLOT_STYLE = os.path.join(os.path.dirname(__file__), "report", "quadcore.mplstyle")
"""Style sheet of quadcore's plots, for ``matplotlib.pyplot.style.use``."""

__all__ = [
    "PLOT_STYLE",
    "AttitudeThrust",
    "BatchSimulation",
    "BatchState",
    "Benchmark",
    "Comparison",
    "CompiledController",
    "Controller",
    "ControllerName",
    "EngineName",
    "Evaluation",
    "Fit",
    "Fleet",
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
    "ReferenceName",
    "Rotor",
    "Simulation",
    "Snapshot",
    "State",
    "Sweep",
    "Vehicle",
    "View",
    "World",
    "WrenchThrust",
    "__version__",
    "autopilots",
    "benchmark",
    "cmake_prefix",
    "compare",
    "controllers",
    "engines",
    "evaluate",
    "export_fmu",
    "fit",
    "gains",
    "load_plugin_path",
    "measure",
    "plugin_folders",
    "read_model",
    "read_world",
    "references",
    "sweep",
    "tune",
    "view",
]

_LATE = {
    "Benchmark": "studies.benchmark.flights",
    "Comparison": "studies.compare.result",
    "Evaluation": "studies.evaluate.evaluate",
    "Fit": "studies.fit.fit",
    "Fleet": "simulation.fleet",
    "FlightPlan": "simulation.flight_plan",
    "Sweep": "studies.sweep.sweep",
    "View": "simulation.view",
    "benchmark": "studies.benchmark.flights",
    "compare": "studies.compare.compare",
    "evaluate": "studies.evaluate.evaluate",
    "export_fmu": "fmu.export",
    "fit": "studies.fit.fit",
    "measure": "studies.evaluate.measure",
    "sweep": "studies.sweep.sweep",
    "tune": "studies.tune.tune",
    "view": "simulation.view",
}
"""Modules of the names that are imported at first use, because a single flight needs none."""

for _module in (controllers, gains, references):
    # Makes `from quadcore.controllers import geometric` work.
    sys.modules[f"{__name__}.{_module.__name__.rpartition('.')[2]}"] = _module


def _make_plant(**options: Any) -> Simulation:
    with LOCK:
        from .thesis.chapter2.plant import Plant  # scipy is slow to import

    return Plant(**options)


def _is_stack_file(path: str) -> bool:
    with LOCK:
        from .autopilots.stack_file import is_stack_file  # yaml is slow to import

    return is_stack_file(path)


def _read_autopilot(path: str) -> Any:
    with LOCK:
        from .autopilots.stacks import read_autopilot

    return read_autopilot(path)


add_engine(LAGRANGE, AddedEngine(LAGRANGE_SUMMARY, _make_plant))
controllers.add_reader(controllers.FileReader(_is_stack_file, _read_autopilot))


if not TYPE_CHECKING:  # checkers would accept any name

    def __getattr__(name: str) -> Any:
        if name == "autopilots":
            return import_module(f"{__name__}.{name}")
        if name not in _LATE:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        with LOCK:
            value = getattr(import_module(f"{__name__}.{_LATE[name]}"), name)
        globals()[name] = value
        return value


def __dir__() -> List[str]:
    return sorted(__all__)
