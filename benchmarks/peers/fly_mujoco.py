"""MuJoCo: a frame with four hinges, motors as its actuators, all forces of the air in C++."""

import ctypes
import subprocess
import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np
from flight import judge, phases, vehicle
from mujoco_model import DT, document

V = vehicle()
HERE, PACKAGE = Path(__file__).parent, Path(mujoco.__file__).parent


def build(folder):
    library = folder / "fly_mujoco.so"
    core = next(PACKAGE.glob("libmujoco.so*"))
    options = ["-O3", "-shared", "-fPIC", f"-I{PACKAGE / 'include'}", f"-Wl,-rpath,{PACKAGE}"]
    subprocess.run(["g++", *options, HERE / "fly_mujoco.cpp", core, "-o", library], check=True)
    return ctypes.CDLL(str(library)).fly


def fly(native, path):
    speeds, counts = zip(*phases(V["hover"], DT))
    end = np.empty(3)
    numbers = [
        np.array(speeds) * V["spins"],
        np.array(counts, np.int32),
        np.array(V["spins"], float),
    ]
    commands, steps, spins = (ctypes.c_void_p(array.ctypes.data) for array in numbers)
    failed = native(
        bytes(path),
        len(counts),
        commands,
        steps,
        spins,
        ctypes.c_double(V["thrust"]),
        ctypes.c_double(V["torque"]),
        ctypes.c_void_p(end.ctypes.data),
    )
    if failed:
        sys.exit("the model cannot be read")
    return end.tolist()


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    native = build(folder)
    for integrator in ("Euler", "RK4"):
        path = folder / f"{integrator}.xml"
        path.write_text(document(integrator))
        judge(f"{integrator}, forces in C++", DT, 1, lambda path=path: fly(native, path))
