"""``quadcore doctor``: check the installation."""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata as metadata
import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Callable, Iterator, List, NamedTuple

from .. import __version__, _core
from .._core import InputError, QuadcoreError
from ..simulation.simulation import Simulation
from . import options, terminal
from .parser import add_command

_OK, _ABSENT, _WRONG = "ok", "absent", "wrong"

_NEEDED = ("numpy", "scipy", "rich", "xacro", "rospkg", "yaml", "jinja2")
"""Modules that quadcore requires."""

_PACKAGES = {"collada": "pycollada", "yaml": "pyyaml"}
"""Package names that differ from the module names."""

_OPTIONAL = {
    "rosbags": ("bag", "reads and writes .bag files"),
    "pymavlink": ("px4", "exchanges messages with PX4"),
    "pygeomag": ("px4", "computes the magnetic field of the Earth"),
    "pyulog": ("ulog", "reads .ulg files of PX4"),
    "gymnasium": ("gym", "runs reinforcement learning environments"),
    "h5py": ("matlab", "reads .mat files of version 7.3"),
    "trimesh": ("mesh", "draws the meshes of a model"),
    "collada": ("mesh", "draws COLLADA meshes"),
    "cma": ("tune", "searches in quadcore tune"),
    "pyarrow": ("sweep", "writes .parquet files"),
    "SALib": ("sweep", "draws Sobol and Morris designs"),
    "distributed": ("dask", "runs sweeps on a Dask cluster"),
    "pandas": ("pandas", "makes data frames of logs"),
    "numba": ("numba", "compiles controllers that the core calls without Python"),
    "onnxruntime": ("onnx", "runs neural networks in .onnx files as controllers"),
    "argcomplete": ("completion", "completes commands in a shell"),
}
"""Modules of the extras, with their extra and their use."""

_COMPILER = 9  # minimum major version of g++


class Finding(NamedTuple):
    """Result of one check."""

    what: str
    state: str
    text: str
    """Version and location, or the problem and the remedy."""


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "doctor",
        "Check the installation, and print the remedy for each problem.",
        check_installation,
        "quadcore doctor",
    )
    options.add_json(parser)


def check_installation(arguments: argparse.Namespace) -> None:
    """Print every finding; raise `InputError` if there is a problem."""
    findings = [finding for check in _CHECKS for finding in check()]
    if arguments.json:
        terminal.print_json([finding._asdict() for finding in findings])
    else:
        table = terminal.make_table("", "", "", show_header=False)
        for finding in findings:
            table.add_row(finding.state, finding.what, finding.text)
        terminal.make_console().print(table)
    wrong = [finding.what for finding in findings if finding.state == _WRONG]
    if wrong:
        raise InputError(f"wrong: {', '.join(wrong)}. Follow the remedies above.")


def _check_python() -> Iterator[Finding]:
    yield Finding("Python", _OK, f"{platform.python_version()}, {sys.executable}")


def _check_quadcore() -> Iterator[Finding]:
    package = Path(__file__).resolve().parents[1]
    yield Finding("quadcore", _OK, f"{__version__}, {package}")
    core = Path(_core.__file__).resolve()
    files = [Path(entry or ".") / "quadcore" / "__init__.py" for entry in sys.path]
    found = {file.resolve().parent for file in files if file.is_file()}
    others = sorted(str(folder) for folder in found - {package})
    if others:
        text = f"hidden behind {package}: {', '.join(others)}. Remove one of the installations."
        yield Finding("quadcore", _WRONG, text)
    yield Finding("core", _OK, str(core))


def _check_needed() -> Iterator[Finding]:
    for module in _NEEDED:
        remedy = f"Run '{sys.executable} -m pip install {_PACKAGES.get(module, module)}'."
        yield _try_import(module, _WRONG, remedy)


def _check_plots() -> Iterator[Finding]:
    remedy = f"Run '{sys.executable} -m pip install matplotlib'."
    found = _try_import("matplotlib", _WRONG, remedy)
    if found.state == _OK:
        try:
            importlib.import_module("quadcore.report.plots")
        except InputError as error:  # two installations are mixed
            found = Finding("matplotlib", _WRONG, str(error))
    yield found


def _check_optional() -> Iterator[Finding]:
    for module, (extra, use) in _OPTIONAL.items():
        yield _try_import(module, _ABSENT, f"{use}: pip install 'quadcore[{extra}]'")


def _try_import(module: str, state: str, remedy: str) -> Finding:
    try:
        found = importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            return Finding(module, _WRONG, f"{error}. {remedy}")
        return Finding(module, state, remedy)
    except Exception as error:  # a damaged installation, or one for another version of NumPy
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        return Finding(module, _WRONG, f"{reason}. Install it again: {remedy}")
    place = (getattr(found, "__path__", None) or [""])[0]
    try:
        version = metadata.version(_PACKAGES.get(module, module))
    except metadata.PackageNotFoundError:  # installed without pip or apt
        version = str(getattr(found, "__version__", "unknown version"))
    return Finding(module, _OK, f"{version}, {place}")


def _check_engines() -> Iterator[Finding]:
    for engine, _ in _core.engines():
        try:
            simulation = Simulation("quadrotor", engine=engine)
            simulation.step(1)
        except QuadcoreError as error:
            yield Finding(f"engine {engine}", _WRONG, f"{error}. Install quadcore again.")
        else:
            yield Finding(f"engine {engine}", _OK, simulation.method)


def _check_plugin_folders() -> Iterator[Finding]:
    given = os.environ.get("QUADCORE_PLUGIN_PATH", "")
    for folder in filter(None, given.split(os.pathsep)):
        if not os.path.isdir(folder):
            text = f"{folder} does not exist. Correct QUADCORE_PLUGIN_PATH."
            yield Finding("plugin folder", _WRONG, text)
        elif not any(Path(folder).glob("*.so")):
            text = f"{folder} holds no plugin (.so). Build one, or correct QUADCORE_PLUGIN_PATH."
            yield Finding("plugin folder", _WRONG, text)
        else:
            yield Finding("plugin folder", _OK, folder)


def _check_compiler() -> Iterator[Finding]:
    compiler = shutil.which(os.environ.get("CXX") or "g++") or shutil.which("c++")
    remedy = "builds your own plugins: apt install g++ cmake"
    if compiler is None:
        yield Finding("C++ compiler", _ABSENT, remedy)
    else:
        version = _read_version([compiler, "-dumpfullversion", "-dumpversion"])
        is_old = "g++" in compiler and version.split(".")[0] in map(str, range(_COMPILER))
        text = f"{compiler} is version {version}. Install g++ {_COMPILER} or newer."
        yield Finding("C++ compiler", _WRONG if is_old else _OK, text if is_old else
                      f"{version}, {compiler}")  # fmt: skip
    cmake = shutil.which("cmake")
    if cmake is None:
        yield Finding("CMake", _ABSENT, remedy)
    else:
        yield Finding("CMake", _OK, f"{_read_version([cmake, '--version'])}, {cmake}")


def _read_version(command: List[str]) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=20)
    except (OSError, subprocess.TimeoutExpired):
        return "unknown version"
    match = re.search(r"[0-9]+(\.[0-9]+)*", done.stdout)
    return match[0] if match else "unknown version"


def _check_ros() -> Iterator[Finding]:
    distribution = os.environ.get("ROS_DISTRO", "")
    if not distribution or os.environ.get("ROS_VERSION") == "2":
        text = "runs quadcore_node: source /opt/ros/noetic/setup.bash"
        yield Finding("ROS 1", _ABSENT, text)
    elif shutil.which("roslaunch") is None:
        text = f"ROS_DISTRO is {distribution}, but roslaunch is not on PATH. Source its setup.bash."
        yield Finding("ROS 1", _WRONG, text)
    else:
        yield Finding("ROS 1", _OK, distribution)


_CHECKS: List[Callable[[], Iterator[Finding]]] = [
    _check_python,
    _check_quadcore,
    _check_needed,
    _check_plots,
    _check_engines,
    _check_plugin_folders,
    _check_optional,
    _check_compiler,
    _check_ros,
]
