"""Contact with the ground: against recordings of real Gazebo 11, and what must hold by itself."""

from __future__ import annotations

import re

import numpy as np
import pytest
from flights import ENGINES
from test_gazebo_recordings import DATA, FOLDERS, measure_distances, name_of

import quadcore as qc

CASES = [path for folder in FOLDERS for path in sorted(folder.glob("cases/C*"))]
DROP, TAKE_OFF = DATA / "cases" / "C1_drop", DATA / "cases" / "C2_takeoff_land"
RESTING_HEIGHT = 0.0125  # half the frame's height
CLOSE = 0.03  # m: the frame counts as landed below


def make_simulation(case, engine="gazebo11", **options):
    lines = (case / "params.txt").read_text().splitlines()
    spawn = next(line.split()[1:] for line in lines if line.startswith("spawn "))
    return qc.Simulation(
        case / "model.urdf", engine=engine, world=case / "case.world", spawn=spawn, **options
    )


def fly_case(case, duration, engine="gazebo11"):
    return make_simulation(case, engine).run(duration, commands=case / "commands.csv")


def tilt(log):
    """Angle between the frame's z and the world's, degrees."""
    return np.degrees(2 * np.arcsin(np.linalg.norm(log.orientation[:, :2], axis=1)))


@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_touching_the_ground_goes_as_recorded(case):
    apart, angle = measure_distances(
        make_simulation(case), case / "commands.csv", case / "record.csv.gz"
    )
    assert apart < 1e-9
    assert angle < 1e-7


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_a_drop_lands_without_a_bounce_and_rests(engine):
    log = fly_case(DROP, 2.0, engine)
    z = log.position[:, 2]
    touchdown = log.time[np.argmax(z < 0.0125 + 1e-5)]
    assert touchdown == pytest.approx(0.135, abs=1.1e-3)
    after = z[log.time > touchdown + 0.002]
    assert after.max() < RESTING_HEIGHT + 1e-6
    assert after.min() > RESTING_HEIGHT - 2e-5
    assert tilt(log)[-1] < 0.005


def test_take_off_apex_and_landing_come_when_they_came_in_gazebo():
    log = fly_case(TAKE_OFF, 10.0)
    z, t = log.position[:, 2], log.time
    rising = np.flatnonzero((z[:-1] < 0.0126) & (z[1:] >= 0.0126) & (t[1:] > 1))[0]
    assert t[rising + 1] == pytest.approx(2.204, abs=1.1e-3)
    apex = np.argmax(z)
    assert t[apex] == pytest.approx(5.021, abs=1e-9)
    assert z[apex] == pytest.approx(2.5499, abs=1e-4)
    landed = apex + np.argmax(z[apex:] < CLOSE)
    assert t[landed] == pytest.approx(6.674, abs=1e-9)
    assert z[-200:] == pytest.approx(RESTING_HEIGHT, abs=2e-5)


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
@pytest.mark.parametrize(
    # Tumbling over the ground multiplies the rounding of the flight before; another order of the
    # rows would be 1e-9 and 1e-1 apart.
    ("spawn", "apart"),
    [((0, 0, 0.1, 0, 0, 0), 1e-13), ((0, 0, 0.3, 0.3, -0.2, 1), 1e-8)],
)
def test_the_order_of_links_and_joints_in_the_file_does_not_matter(engine, spawn, apart, tmp_path):
    text = (DROP / "model.urdf").read_text()
    rotors = re.findall(r'  <link name="propeller.*?</joint>\n', text, flags=re.DOTALL)
    order = [2, 0, 3, 1]
    start = text.index(rotors[0])
    rest = text[start + len("".join(rotors)) :]
    model = tmp_path / "permuted.urdf"
    model.write_text(text[:start] + "".join(rotors[i] for i in order) + rest)
    speeds = np.array([40, -50, 45, -30])

    def fly_numbered(path, columns):
        sim = qc.Simulation(path, engine=engine, world=DROP / "case.world", spawn=spawn)
        assert sim.rotor_names == [f"rotor{1 + i}" for i in columns]
        log = sim.run(1.0, commands=[[0, *speeds]])
        rates = log.rotor_velocity[:, np.argsort(columns)]
        return np.hstack([log.position, log.orientation, log.linear_velocity, rates])

    permuted, original = fly_numbered(model, order), fly_numbered(DROP / "model.urdf", [0, 1, 2, 3])
    assert np.abs(permuted - original).max() < apart


@pytest.mark.parametrize("engine", ENGINES)
def test_a_tilted_drop_comes_to_rest_and_does_not_slide(engine):
    sim = qc.Simulation(
        "quadrotor", engine=engine, world="default", spawn=(0, 0, 0.3, 0.3, -0.2, 1)
    )
    sim.step(6000)
    before = sim.state.copy()
    sim.step(1000)
    assert np.linalg.norm(sim.state.position[:2] - before.position[:2]) < 1e-3
    assert np.linalg.norm(sim.state.linear_velocity) < 0.02
    lowest = sim.state.position[2] - RESTING_HEIGHT
    assert -1e-4 < lowest < 0.1


@pytest.mark.parametrize("engine", ENGINES)
def test_restoring_on_the_ground_repeats_the_bytes(engine):
    sim = make_simulation(DROP, engine)
    sim.step(140)  # just landed: hinge forces are carried over from step to step
    snapshot = sim.snapshot()
    first = sim.run(0.5).table
    sim.restore(snapshot)
    assert sim.run(0.5).table.tobytes() == first.tobytes()


def test_a_mesh_cannot_touch_the_ground_and_is_named(tmp_path):
    text = (DROP / "model.urdf").read_text()
    mesh = text.replace(
        '<cylinder radius="0.1" length="0.025"/></geometry></collision>',
        '<mesh filename="frame.stl"/></geometry></collision>',
    )
    assert mesh != text
    model = tmp_path / "mesh.urdf"
    model.write_text(mesh)
    qc.Simulation(model)
    for engine in ENGINES:
        with pytest.raises(qc.InputError, match=r"mesh\.urdf:5: .*box, cylinder or sphere"):
            qc.Simulation(model, engine=engine, world="default")


BOX = """
<robot name="box">
  <link name="frame">
    <inertial>
      <mass value="1"/>
      <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <collision><geometry><box size="1 1 0.02"/></geometry></collision>
  </link>
</robot>
"""


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
@pytest.mark.parametrize(("heading", "share"), [(0, 1), (30, 1.3660254), (45, 2**0.5), (90, 1)])
def test_friction_is_a_pyramid_along_the_axes_of_the_world(tmp_path, engine, heading, share):
    (tmp_path / "box.urdf").write_text(BOX)
    simulation = qc.Simulation(
        tmp_path / "box.urdf", engine=engine, world="default", spawn=(0, 0, 0.01)
    )
    simulation.step(500)
    state = simulation.state.copy()
    way = np.array([np.cos(np.radians(heading)), np.sin(np.radians(heading)), 0])
    state.linear_velocity[:] = 5 * way
    simulation.set_state(state)
    before, after = simulation.run(0.01).linear_velocity[[0, -1]]
    # mu is 1; along each axis of the world along which it slides the body is slowed by mu g.
    assert (before - after) @ way / 0.01 == pytest.approx(share * 9.8, rel=1e-3)


def test_eigen_warns_of_tags_of_contact_that_it_does_not_feel(tmp_path):
    def warnings_of(tags):
        text = BOX.replace("</robot>", f'<gazebo reference="frame">{tags}</gazebo></robot>')
        (tmp_path / "box.urdf").write_text(text)
        simulation = qc.Simulation(
            tmp_path / "box.urdf", engine="eigen", world="default", spawn=(0, 0, 0.01)
        )
        return [warning for warning in simulation.warnings if "eigen ignores" in warning]

    assert warnings_of("<mu1>0.3</mu1><fdir1>1 0 0</fdir1><kp>1e5</kp>") == []
    (warning,) = warnings_of("<kd>7</kd>")
    assert "box.urdf:8: " in warning
    assert "the engine eigen ignores <kd>" in warning
