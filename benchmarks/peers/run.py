"""Flies the same flights in quadcore and in its peers, each in an environment of its own.

Prints, for each way to fly, vehicle-steps per second of processor time, how far from the exact end
the flight in open loop ends, and how well the flight in closed loop tracks the spiral.
"""

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

import numpy as np
import spiral
from flight import DURATION, phases
from rich.console import Console
from rich.table import Table
from scipy.spatial.transform import Rotation

import quadcore as qc

HERE = Path(__file__).parent
BUILD = HERE.parent.parent / "build" / "peers"
PEERS = {  # and what they need besides
    "mujoco": (),
    "pybullet": ("numpy",),
    "rotorpy": (),
    "crazyflow": (),
    "l2f": ("numpy",),
}
SIMULATION = {
    "xacro_args": {"sim_slow": "1", "drag": "none"},
    "parameters": {"drone_plugin.reactionTorque": "opposing"},
    "world": str(HERE / "peers.world"),
}
ALTITUDE = 20.0  # m
EXACT_DT = 1e-4  # s


def vehicle():
    """Numbers of the vehicle that every program is told."""
    sim = qc.Simulation("quadrotor", engine="eigen", **SIMULATION)
    tags = {(p.name, t.name): t.value for p in sim.plugins for t in p.parameters}

    def number(name):
        return next(float(value) for (_, tag), value in tags.items() if tag == name)

    rotors = sim.model.links[1:]
    centres = [j.xyz + r.center_of_mass for j, r in zip(sim.model.joints, rotors)]
    gravity = -sim.world.gravity[2]
    height = sim.center_of_mass[2]
    thrust, inertia = number("rotorThrustCoeff"), rotors[0].inertia[2, 2]
    return {
        "simulation": SIMULATION,
        "spawn": [0, 0, ALTITUDE],
        "height": height,  # of the centre of mass over the frame's origin, m
        "start": [0, 0, ALTITUDE + height],  # of the centre of mass, m
        "mass": sim.mass,
        "inertia": sim.inertia.tolist(),  # about the centre of mass, kg m^2
        "rotors": [(centre - sim.center_of_mass).tolist() for centre in centres],
        "spins": [1, -1, 1, -1],
        "places": [joint.xyz.tolist() for joint in sim.model.joints],  # in the frame, m
        "frame_mass": sim.model.links[0].mass,
        "frame_moments": sim.model.links[0].inertia.diagonal().tolist(),
        "rotor_mass": rotors[0].mass,
        "rotor_moments": rotors[0].inertia.diagonal().tolist(),
        "thrust": thrust,
        "torque": number("rotorTorqueCoeff"),
        "gain": number("kp"),  # of the motors, N m s/rad
        "lag": inertia / number("kp"),
        "rotor_inertia": inertia,
        "gravity": gravity,
        "hover": float(np.sqrt(sim.mass * gravity / 4 / thrust)),
    }


def end(numbers):
    """Where the centre of mass ends, m: in steps so short that 1e-11 m is left."""
    sim = qc.Simulation(
        "quadrotor",
        engine="eigen",
        spawn=numbers["spawn"],
        dt=EXACT_DT,
        **SIMULATION,
    )
    for speeds, count in phases(numbers["hover"], EXACT_DT):
        sim.command(np.array(speeds) * numbers["spins"])
        sim.step(count)
    up_W = Rotation.from_quat(sim.state.orientation).as_matrix()[:, 2]
    return (sim.state.position + numbers["height"] * up_W).tolist()


def python_of(peer):
    """The interpreter of an environment that has the peer, and which release; None if it cannot."""
    python = BUILD / peer / "bin" / "python"
    if not python.exists():
        venv.create(python.parent.parent, with_pip=True)
    install = [python, "-m", "pip", "install", "--quiet", peer, *PEERS[peer]]
    done = subprocess.run(install, capture_output=True, text=True)
    if done.returncode:
        print(f"{peer} cannot be installed: {last_line(done.stderr)}", file=sys.stderr)
        return None, ""
    ask = f"import importlib.metadata as m; print(m.version({peer!r}))"
    return python, subprocess.check_output([python, "-c", ask], text=True).strip()


def last_line(text):
    return (text.strip().splitlines() or [""])[-1]


def fly(python, script, numbers):
    """Rows that a program prints; none if it fails, which is said."""
    command = [python, HERE / script, json.dumps(numbers)]
    one_core = {
        **os.environ,
        "OMP_NUM_THREADS": "1",
    }  # threads that wait by spinning take time, too
    done = subprocess.run(command, cwd=BUILD, env=one_core, capture_output=True, text=True)
    if done.returncode:
        print(f"{script}: {last_line(done.stderr)}", file=sys.stderr)
        return []
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def main(chosen):
    numbers = vehicle()
    numbers["end"] = end(numbers)
    programs = {"quadcore": (sys.executable, qc.__version__)}
    programs.update((peer, python_of(peer)) for peer in chosen or PEERS)
    title = f"The same flight of {DURATION:g} s; s: of processor time"
    print_table(title, "off at the end", "fly", programs, numbers)
    title = f"The spiral of {spiral.DURATION:g} s, each with its own controller"
    print_table(title, "RMS error", "track", programs, numbers)


def print_table(title, error, task, programs, numbers):
    """Fly a task in all programs that have it, and print the rows."""
    table = Table(title=title)
    for heading in ("", "how"):
        table.add_column(heading)
    for heading in ("step", "vehicles", "vehicle-steps/s", "flown s/s", error):
        table.add_column(heading, justify="right")
    for program, (python, version) in programs.items():
        script = f"{task}_{program}.py"
        has_it = python and (HERE / script).exists()
        for row in fly(python, script, numbers) if has_it else []:
            table.add_row(
                f"{program} {version}",
                row["way"],
                f"{row['dt'] * 1e3:g} ms",
                str(row["vehicles"]),
                f"{row['rate']:,.0f}",
                f"{row['rate'] * row['dt']:,.0f}",
                f"{row['error']:.1e} m",
            )
    Console(width=110).print(table)


if __name__ == "__main__":
    main(sys.argv[1:])
