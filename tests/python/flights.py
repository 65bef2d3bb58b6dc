"""The flights that several tests make."""

from __future__ import annotations

import hashlib
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

import quadcore as qc
from quadcore.model import resources

ENGINES = [name for name, _ in qc.engines()]
HOVER = np.array([471, -471, 471, -471])
MANOEUVRE = np.array([[0.0, 0, 0, 0, 0], [0.02, 480, -475, 485, -470], [0.4, 470, -480, 470, -480]])

# Of the thesis' odometry.
NOISE = {"odometry.positionNoise": 0.2106e-3, "odometry.orientationNoise": 0.2e-3}

# All that a simulation has to remember: integral and derivative, noise, a timeout.
BUSY = {
    "motorpid_plugin.ki": 2e-4,
    "motorpid_plugin.kd": 1e-8,
    "motorpid_plugin.iMax": 2e-3,
    "motorpid_plugin.iMin": -2e-3,
    "motorpid_plugin.commandTimeout": 0.3,
    "odometry.rate": 400,
    "odometry.positionNoise": 0.1,
    "odometry.orientationNoise": 0.02,
    "odometry.linearVelocityNoise": 0.3,
    "odometry.angularVelocityNoise": 0.4,
}


def quadrotor(engine="gazebo11", **options):
    return qc.Simulation("quadrotor", engine=engine, **options)


def bits(simulation):
    """Every bit of state and odometry."""
    state = simulation.state.copy()
    numbers = [getattr(state, name) for name in state.__slots__]
    numbers += simulation.topic("odom").values()
    return b"".join(np.asarray(number, dtype=float).tobytes() for number in numbers)


def hold_height(simulation, steps, height=10):
    """Fly by the noisy odometry; returns every bit on the way."""
    trace = []
    for _ in range(steps):
        message = simulation.topic("odom")
        climb = 0.05 * (height - message["z"]) - 0.02 * message["vz"]
        simulation.command(HOVER * (1 + climb))
        simulation.step()
        trace.append(bits(simulation))
    return b"".join(trace)


ELSEWHERE = """
import hashlib, pickle, sys
sys.path.insert(0, sys.argv[1])
from flights import bits, hold_height
fly, *things = pickle.load(sys.stdin.buffer)
scope = {}
exec(fly, scope)
sys.stdout.write(hashlib.sha256(scope["fly"](*things)).hexdigest())
"""


def fly_in_process(fly, *things):
    """Digest of what the source `fly` returns for things that came through pickle alone."""
    here = str(Path(__file__).parent)
    ran = subprocess.run(
        [sys.executable, "-c", ELSEWHERE, here],
        input=pickle.dumps([fly, *things]),
        capture_output=True,
        cwd="/",
    )
    assert ran.returncode == 0, ran.stderr.decode()
    return ran.stdout.decode()


def digest(data):
    return hashlib.sha256(data).hexdigest()


def with_pilot(folder):
    """Copy the quadrotor with a PID, whose gains lie in a file beside it."""
    folder.mkdir()
    shutil.copy(resources.find_root() / "config/gains/quadrotor/pid.yaml", folder / "gains.yaml")
    text = (resources.find_root() / "urdf/quadrotor.urdf.xacro").read_text()
    pilot = (
        '<gazebo><plugin name="pilot" filename="libcontroller_plugin.so"><law>pid</law>'
        "<gains>gains.yaml</gains></plugin></gazebo></robot>"
    )
    model = folder / "piloted.urdf.xacro"
    model.write_text(text.replace("</robot>", pilot))
    return str(model)
