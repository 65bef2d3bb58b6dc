"""Models of a world that are not static: they fall, collide, hang on joints and sleep."""

from __future__ import annotations

import numpy as np
import pytest

import quadcore as qc

GROUND = "<include><uri>model://ground_plane</uri></include>"
BOX = "<box><size>0.4 0.4 0.4</size></box>"
INERTIA = "<inertia><ixx>0.05</ixx><iyy>0.05</iyy><izz>0.05</izz></inertia>"


def write_world(folder, *inside, gravity="0 0 -9.8"):
    file = folder / "case.world"
    file.write_text(
        f'<sdf version="1.6"><world name="w"><gravity>{gravity}</gravity>{"".join(inside)}'
        "</world></sdf>"
    )
    return file


def link(name="link", pose="0 0 0 0 0 0", mass=2, shape=BOX, inertia=INERTIA, more=""):
    collision = f'<collision name="c"><geometry>{shape}</geometry></collision>' if shape else ""
    return (
        f'<link name="{name}"><pose>{pose}</pose><inertial><mass>{mass}</mass>{inertia}</inertial>'
        f"{collision}{more}</link>"
    )


def body(pose, *links, name="crate"):
    return f'<model name="{name}"><pose>{pose}</pose>{"".join(links or [link()])}</model>'


def simulate(world, engine="gazebo11", **options):
    return qc.Simulation("quadrotor", engine=engine, world=world, **options)


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_a_free_body_falls_lands_and_sleeps(engine, tmp_path):
    simulation = simulate(
        write_world(tmp_path, GROUND, body("3 0 1 0 0 0")), engine, spawn=(0, 0, 50)
    )
    steps, dt = 300, simulation.dt
    simulation.step(steps)
    (crate,) = simulation.free_bodies
    assert crate.name == "crate::link"
    # Semi-implicit Euler in free fall.
    assert crate.position[2] == pytest.approx(1 - 9.8 * dt**2 * steps * (steps + 1) / 2, abs=1e-12)
    simulation.step(2200)
    (crate,) = simulation.free_bodies
    assert crate.position == pytest.approx([3, 0, 0.2], abs=2e-4)
    assert not np.any(crate.linear_velocity) and not np.any(crate.angular_velocity)


def test_a_body_far_away_does_not_change_the_flight(tmp_path):
    alone = simulate(write_world(tmp_path, GROUND), spawn=(0, 0, 0.3)).run(1.0)
    beside = simulate(write_world(tmp_path, GROUND, body("5 0 0.3 0 0 0")), spawn=(0, 0, 0.3)).run(
        1.0
    )
    np.testing.assert_array_equal(alone.position, beside.position)
    np.testing.assert_array_equal(alone.angular_velocity, beside.angular_velocity)


def test_two_bodies_that_collide_keep_their_momentum(tmp_path):
    """Without gravity, a moving box (state of a saved world) pushes another."""
    moving = (
        '<state world_name="w"><model name="a"><link name="link"><pose>2 0 5 0 0 0</pose>'
        "<velocity>1 0 0 0 0 0</velocity></link></model></state>"
    )
    simulation = simulate(
        write_world(
            tmp_path,
            body("2 0 5 0 0 0", link(mass=1), name="a"),
            body("2.6 0.1 5 0 0 0.2", link(mass=3), name="b"),
            moving,
            gravity="0 0 0",
        )
    )
    simulation.step(600)
    a, b = simulation.free_bodies
    assert b.linear_velocity[0] > 0.1
    momentum = 1 * a.linear_velocity + 3 * b.linear_velocity
    assert momentum == pytest.approx([1, 0, 0], abs=1e-9)


def test_a_pendulum_swings_with_its_period(tmp_path):
    """Compound pendulum: T = 2 pi sqrt((I + m l^2) / (m g l)) for small angles."""
    mass, length, inertia = 2.0, 0.5, 0.05
    pivot = (
        '<joint name="pivot" type="revolute"><parent>world</parent><child>link</child>'
        f"<pose>0 0 {length} 0 0 0</pose><axis><xyz>0 1 0</xyz></axis></joint>"
    )
    tilt = 0.02
    pose = f"{3 - length * np.sin(tilt)} 0 {5 - length * np.cos(tilt)} 0 {tilt} 0"
    simulation = simulate(write_world(tmp_path, body(pose, link(mass=mass), pivot)))
    offsets = []
    for _ in range(4000):
        simulation.step(1)
        offsets.append(simulation.free_bodies[0].position[0] - 3)
    crossings = np.flatnonzero(np.diff(np.sign(offsets)) > 0)
    period = 2 * np.pi * np.sqrt((inertia + mass * length**2) / (mass * 9.8 * length))
    assert np.diff(crossings) * simulation.dt == pytest.approx(period, rel=3e-3)


def test_joints_hold_their_limits(tmp_path):
    """A slider on the world falls to its lower limit, and a welded link stays where it is."""
    slider = (
        '<joint name="slide" type="prismatic"><parent>world</parent><child>link</child>'
        "<axis><xyz>0 0 1</xyz><limit><lower>-0.1</lower><upper>0.1</upper></limit></axis></joint>"
        '<joint name="weld" type="fixed"><parent>link</parent><child>side</child></joint>'
    )
    simulation = simulate(
        write_world(
            tmp_path, body("3 0 5 0 0 0", link(), link("side", "0.5 0 0 0 0 0", 0.1), slider)
        )
    )
    simulation.step(1500)
    center, side = simulation.free_bodies
    assert center.position == pytest.approx([3, 0, 4.9], abs=1e-3)
    assert side.position - center.position == pytest.approx([0.5, 0, 0], abs=1e-3)


def test_a_snapshot_contains_the_free_bodies(tmp_path):
    world = write_world(tmp_path, GROUND, body("0.1 0 0.6 0.2 0.1 0"))
    simulation = simulate(world, spawn=(0, 0, 1.5))
    simulation.step(200)
    snapshot = simulation.snapshot()

    def go_on():
        simulation.step(400)
        motions = [(b.position, b.orientation, b.linear_velocity) for b in simulation.free_bodies]
        return np.concatenate([simulation.state.position, *map(np.ravel, motions[0])])

    first = go_on()
    simulation.restore(snapshot)
    np.testing.assert_array_equal(go_on(), first)
    simulation.reset()
    simulation.step(200)
    np.testing.assert_array_equal(go_on(), first)


def test_a_body_that_the_vehicle_lands_on_wakes(tmp_path):
    simulation = simulate(
        write_world(tmp_path, GROUND, body("0 0 0.2 0 0 0", link(mass=0.2))), spawn=(0.15, 0, 12)
    )
    simulation.step(1400)
    rested = simulation.free_bodies[0].position
    simulation.step(600)
    assert np.linalg.norm(simulation.free_bodies[0].position - rested) > 1e-4


@pytest.mark.parametrize(
    "model, complaint",
    [
        (body("0 0 1 0 0 0", link(mass=0)), "the mass or a moment of inertia of the link 'link'"),
        (
            body("0 0 1 0 0 0", link(inertia="<inertia><ixx>-1</ixx></inertia>")),
            "the mass or a moment of inertia of the link 'link'",
        ),
        (body("0 0 nan 0 0 0"), "<pose> is '0 0 nan 0 0 0'"),
        (
            body(
                "0 0 1 0 0 0",
                link(),
                '<joint name="j" type="screw"><parent>world</parent><child>link</child></joint>',
            ),
            "a joint of type 'screw' is not supported",
        ),
        (
            body(
                "0 0 1 0 0 0",
                link(),
                '<joint name="j" type="fixed"><parent>nil</parent><child>link</child></joint>',
            ),
            "the joint 'j' has the parent 'nil'",
        ),
        (
            body(
                "0 0 1 0 0 0",
                link(),
                '<joint name="j" type="fixed"><parent>link</parent><child>link</child></joint>',
            ),
            "a joint has one link at both ends",
        ),
        (
            body(
                "0 0 1 0 0 0",
                link(),
                '<joint name="j" type="revolute"><parent>world</parent><child>link</child>'
                "<axis><limit><lower>2</lower><upper>1</upper></limit></axis></joint>",
            ),
            "<lower> exceeds <upper>",
        ),
        (
            body("0 0 1 0 0 0", link(more="<kinematic>1</kinematic>")),
            "a kinematic link is not supported",
        ),
    ],
)
def test_what_no_body_is_gets_one_line(model, complaint, tmp_path):
    with pytest.raises(qc.InputError, match=r"^\S*case\.world:1: .*--ignore crate\.$") as refusal:
        simulate(write_world(tmp_path, model))
    assert complaint in str(refusal.value)
    assert simulate(write_world(tmp_path, model), ignore=["crate"]).free_bodies == []


def test_eigen_names_the_free_body_that_it_does_not_model(tmp_path):
    with pytest.raises(qc.InputError, match="eigen does not model the free body 'crate'"):
        simulate(write_world(tmp_path, body("0 0 1 0 0 0")), "eigen")
