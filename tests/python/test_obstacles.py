"""Obstacles of a world: what is read, who refuses them, and that they cost nothing from afar."""

from __future__ import annotations

import numpy as np
import pytest

import quadcore as qc
from quadcore.model.obstacles import draw_world

BOX = "<box><size>0.4 0.6 0.8</size></box>"


def write_world(folder, *models):
    file = folder / "case.world"
    file.write_text(f'<sdf version="1.6"><world name="w">{"".join(models)}</world></sdf>')
    return file


def solid(geometry, pose, name="solid"):
    return (
        f'<model name="{name}"><static>1</static><pose>{pose}</pose><link name="link">'
        f'<collision name="shape"><geometry>{geometry}</geometry></collision></link></model>'
    )


def fall(world, engine="gazebo11", steps=700, **options):
    simulation = qc.Simulation("quadrotor", engine=engine, world=world, spawn=(0, 0, 2), **options)
    simulation.step(steps)
    return simulation


def test_obstacles_of_a_world_are_listed_with_their_poses(tmp_path):
    cylinder = "<cylinder><radius>0.1</radius><length>3</length></cylinder>"
    sphere = "<sphere><radius>0.3</radius></sphere>"
    world = qc.Simulation(
        "quadrotor",
        world=write_world(
            tmp_path,
            solid(BOX, "1 2 3 0 0 1.5707963267948966", "crate"),
            solid(cylinder, "4 0 0 0 0 0", "post"),
            solid(sphere, "0 5 0 0 0 0", "ball"),
            solid("<plane><normal>1 0 0</normal></plane>", "7 7 0.5 0 0 0", "wall"),
            "<include><uri>model://ground_plane</uri></include>",
        ),
    ).world
    assert world.ground_plane
    assert [o.kind for o in world.obstacles] == ["box", "cylinder", "sphere", "plane"]
    crate, post, ball, wall = world.obstacles
    assert (crate.model, crate.name) == ("crate", "link::shape")
    assert crate.where.endswith("case.world:1")
    assert crate.position.tolist() == [1, 2, 3]
    assert crate.distance_to((1, 2.5, 3)) == pytest.approx(0.3)
    assert post.distance_to((4.5, 0, 1)) == pytest.approx(0.4)
    assert ball.distance_to((0, 5, 1)) == pytest.approx(0.7)
    assert wall.distance_to((2, 9, 9)) == pytest.approx(1.5)
    drawn = draw_world(world)
    assert drawn.ground
    assert [(s.kind, s.size) for s in drawn.obstacles] == [
        ("box", (0.4, 0.6, 0.8)),
        ("cylinder", (0.1, 3)),
        ("sphere", (0.3,)),
    ]
    assert drawn.obstacles[0].pose[:3] == pytest.approx(
        np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3]])
    )


def test_eigen_refuses_a_mesh_that_it_would_fly_through(tmp_path):
    prism = "<polyline><point>0 0</point><point>1 0</point><point>0 1</point></polyline>"
    world = write_world(tmp_path, solid(prism, "9 9 9 0 0 0", "crate"))
    with pytest.raises(
        qc.InputError, match=r"case\.world:1: the engine eigen does not model .*'crate'.* Use the"
    ):
        qc.Simulation("quadrotor", engine="eigen", world=world)


@pytest.mark.parametrize("engine", ["gazebo11", "ode", "eigen"])
def test_a_vehicle_lands_on_a_box_as_on_ground_of_the_same_height(engine, tmp_path):
    roof = "<box><size>4 4 1</size></box>"
    resting = [
        fall(write_world(tmp_path, model), engine, 2000).state.position
        for model in (
            solid(roof, "0 0 0.5 0 0 0"),
            solid("<plane><normal>0 0 1</normal></plane>", "0 0 1 0 0 0"),
        )
    ]
    assert resting[0][2] > 1
    assert resting[0] == pytest.approx(resting[1], abs=1e-3)


@pytest.mark.parametrize("engine", ["gazebo11", "ode", "eigen"])
def test_obstacles_far_away_change_no_byte(engine, tmp_path):
    (empty, far) = (tmp_path / "empty", tmp_path / "far")
    empty.mkdir()
    far.mkdir()
    crates = [solid(BOX, f"{10 + i} {i} {i} 0.1 0.2 {i}", f"crate{i}") for i in range(20)]
    flights = [fall(write_world(empty), engine), fall(write_world(far, *crates), engine)]
    assert flights[0].state.position.tolist() == flights[1].state.position.tolist()
    assert flights[0].state.orientation.tolist() == flights[1].state.orientation.tolist()


@pytest.mark.parametrize("engine", ["gazebo11", "ode", "eigen"])
def test_a_batch_among_obstacles_is_bit_identical_to_single_flights(engine, tmp_path):
    # Two vehicles fall on a box, one falls past it, and one touches nothing.
    world = write_world(tmp_path, solid(BOX, "0.1 0 1 0.3 0.2 0.1"))
    spawns = np.array(
        [[0, 0, 2, 0.1, 0, 0], [0.3, 0.1, 6, 0, 0, 0], [2, 1, 3, 0, 0.2, 0], [9, 9, 9, 0, 0, 0]]
    )
    batch = qc.BatchSimulation("quadrotor", 4, engine=engine, world=world, spawn=spawns)
    speeds = np.full((4, 4), 200.0) * [1, -1, 1, -1]
    singles = [
        qc.Simulation("quadrotor", engine=engine, world=world, spawn=spawn) for spawn in spawns
    ]
    for steps in (1, 700, 1, 900):
        batch.step(speeds, steps)
        for i, single in enumerate(singles):
            single.command(speeds[i])
            single.step(steps)
            assert batch.state.position[i].tolist() == single.state.position.tolist()
            assert batch.state.orientation[i].tolist() == single.state.orientation.tolist()


@pytest.mark.parametrize("engine", ["gazebo11", "eigen"])
def test_controllers_fly_a_batch_through_a_slalom_bit_identical_to_single_flights(engine):
    batch = qc.BatchSimulation("quadrotor", 9, engine=engine, world="slalom", seed=np.arange(9))
    logs = batch.run(4.0, log=[0, 8], controller="geometric", reference="eight")
    for of_batch, i in zip(logs, (0, 8)):
        single = qc.Simulation("quadrotor", engine=engine, world="slalom", seed=i)
        log = single.run(4.0, controller="geometric", reference="eight")
        assert of_batch.position.tolist() == log.position.tolist()


def test_a_snapshot_on_an_obstacle_restores_exactly(tmp_path):
    world = write_world(tmp_path, solid(BOX, "0.1 0 1 0.3 0.2 0.1"))
    simulation = fall(world)
    assert simulation.state.position[2] > 0.5  # in free fall it would be below zero
    snapshot = simulation.snapshot()
    simulation.step(300)
    other = fall(world, steps=0)
    other.restore(snapshot)
    other.step(300)
    assert other.state.position.tolist() == simulation.state.position.tolist()
