"""Small vehicles as URDF text, and worlds for them."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import NamedTuple, Sequence

import numpy as np

import quadcore as qc


class Rotor(NamedTuple):
    """A propeller on a continuous joint of the frame that turns about its own z."""

    xyz: Sequence[float]
    rpy: Sequence[float] = (0, 0, 0)
    mass: float = 0.01
    inertia: Sequence[float] = (1.40625e-5, 1.40625e-5, 2.8125e-5)
    damping: float = 0
    com: Sequence[float] = (0, 0, 0)


# The thesis' quadrotor: 1 at +x, 2 at -y, 3 at -x, 4 at +y.
HEIGHT = 0.016826923076923
CROSS = tuple(Rotor((x, y, HEIGHT)) for x, y in ((0.2, 0), (0, -0.2), (-0.2, 0), (0, 0.2)))
# No symmetry left: rotors tilted, unlike, at odd places; offset and skew frame.
ODD = (
    Rotor((0.21, 0.01, 0.03), (0.1, 0.2, 0.3)),
    Rotor((0.01, -0.18, 0.02), (-0.2, 0.1, 0), 0.02, (2.0e-5, 2.0e-5, 3.5e-5)),
    Rotor((-0.19, 0.02, -0.01), (0.05, -0.15, 1)),
    Rotor((0.02, 0.22, 0.02), (0.15, 0.1, -2), 0.015, (1.5e-5, 1.5e-5, 2.9e-5)),
)
ROUND = (0.0068229166666667, 0.0068229166666667, 0.0135416666666667, 0, 0, 0)
SKEW = (0.007, 0.009, 0.0135, 0.0004, -0.0003, 0.0002)

LIFT = {"rotorThrustCoeff": 1.1487e-5, "rotorTorqueCoeff": 2.69e-7}
AIR = {**LIFT, "inducedDragCoeff": 0}  # without drag, as is meant
DRAG = {
    "inducedDragCoeff": 0.01,
    "translationalDragCoeff": 0.0025,
    "profileDragCoeff": 0.005,
    "parasiticDragCoeff": 0.003,
}
# A world, and a centre of mass, off every axis.
GRAVITY = (0, 0, -9.8)
COM = (0.004, -0.003, 0.005)
WIND = np.array([2.0, -1.0, 0.5])
HAND = {"rotorThrustCoeff": 1e-5, "rotorTorqueCoeff": 2e-7}  # for sums by hand
FLAPPING = {"flappingA1c": 0.1, "flappingA1s": 0.03, "flappingB1": 0.004, "flappingB2": 0.003}
MOTOR = {"kp": 5e-4}


def text(values):
    return " ".join(repr(float(value)) for value in values)


def body(name, mass, inertia, xyz=(0, 0, 0)):
    xx, yy, zz, xy, xz, yz = (float(moment) for moment in (*inertia, 0, 0, 0)[:6])
    return (
        f'<link name="{name}"><inertial><origin xyz="{text(xyz)}"/><mass value="{mass}"/>'
        f'<inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="{xy!r}" ixz="{xz!r}" iyz="{yz!r}"/>'
        "</inertial></link>"
    )


def joint(i, rotor):
    return (
        f'<joint name="rotor{i}" type="continuous"><parent link="frame"/>'
        f'<child link="propeller{i}"/><origin xyz="{text(rotor.xyz)}" rpy="{text(rotor.rpy)}"/>'
        f'<axis xyz="0 0 1"/><dynamics damping="{rotor.damping!r}"/></joint>'
    )


def plugin(name, tags):
    inside = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return (
        f'<gazebo><plugin name="{name}" filename="lib{name}_plugin.so">{inside}</plugin></gazebo>'
    )


def vehicle(rotors=CROSS, mass=1, inertia=ROUND, com=(0, 0, 0), air=None, motor=None):
    """URDF of a frame with rotors; without tags for a plugin, it has none."""
    parts = ['<robot name="vehicle">', body("frame", mass, inertia, com)]
    for i, rotor in enumerate(rotors, 1):
        parts += [body(f"propeller{i}", rotor.mass, rotor.inertia, rotor.com), joint(i, rotor)]
    if air is not None:
        parts.append(plugin("aerodynamic", air))
    if motor is not None:
        parts.append(plugin("motorpid", motor))
    return "\n".join([*parts, "</robot>"])


class Hangar:
    """Makes simulations of vehicles in worlds."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.names = map(str, itertools.count())

    def __call__(self, urdf, gravity=(0, 0, 0), wind=(0, 0, 0), spawn=(0, 0, 0), **options):
        name = next(self.names)
        model, world = self.folder / f"{name}.urdf", self.folder / f"{name}.world"
        model.write_text(urdf)
        world.write_text(
            f"<sdf><world><gravity>{text(gravity)}</gravity><wind><linear_velocity>{text(wind)}"
            "</linear_velocity></wind></world></sdf>"
        )
        return qc.Simulation(model, world=world, spawn=spawn, **options)


def start(simulation, **members):
    """Set some members of the state."""
    state = simulation.state.copy()
    for name, value in members.items():
        setattr(state, name, np.asarray(value, dtype=float))
    simulation.set_state(state)
    return simulation


def wrenches(simulation):
    """What each term exerts now: force, then torque about the centre of mass, frame axes."""
    return {name: rows[0] for name, rows in simulation.run(0, wrenches=True).wrenches.items()}


def upright(hangar, air, rotors=CROSS, spin=(0, 0, 0, 0), v=(0, 0, 0), w=(0, 0, 0), **options):
    """Wrenches on a vehicle that stands upright, its rotors at angle zero."""
    simulation = hangar(vehicle(rotors, air=air), **options)
    spin = np.resize(np.asarray(spin, dtype=float), len(rotors))
    return wrenches(start(simulation, rotor_velocity=spin, linear_velocity=v, angular_velocity=w))
