"""Vehicles with plugins that have one hook or the other, and flights of them."""

from __future__ import annotations

from vehicles import DRAG, FLAPPING, LIFT, MOTOR, ODD, SKEW, body, vehicle

G = (0, 0, -9.8)
CHAPTER2 = {**LIFT, **DRAG, **FLAPPING, "dragModel": "chapter2"}
CARGO = {"mass": 0.23, "radius": 0.04, "x": 0.031, "y": -0.017, "z": -0.1234567}
CARGO_INERTIA = (0.4 * 0.23 * 0.04 * 0.04,) * 3


def with_plugins(urdf, *elements):
    return urdf.replace("</robot>", "\n".join([*elements, "</robot>"]))


def with_fixed_link(urdf, name, mass, inertia, xyz=(0, 0, 0), rpy=(0, 0, 0)):
    words = [" ".join(repr(float(x)) for x in triple) for triple in (xyz, rpy)]
    return urdf.replace(
        "</robot>",
        f'{body(name, mass, inertia)}<joint name="{name}" type="fixed"><parent link="frame"/>'
        f'<child link="{name}"/><origin xyz="{words[0]}" rpy="{words[1]}"/></joint></robot>',
    )


def make_motored(rotors=ODD, air=CHAPTER2, **options):
    return vehicle(rotors, inertia=SKEW, com=(0.01, -0.02, 0.03), air=air, motor=MOTOR, **options)


def fly(simulation, steps, speeds=(471, -465, 480, -475), log_every=1):
    simulation.command(speeds[: simulation.rotor_count])
    return simulation.run(steps * simulation.dt, log_every=log_every, wrenches=True)


def assert_same_bytes(one, other, without=None):
    assert one.table.tobytes() == other.table.tobytes()
    assert one.wrenches.keys() - {without} == other.wrenches.keys()
    for name, rows in other.wrenches.items():
        assert rows.tobytes() == one.wrenches[name].tobytes(), name
