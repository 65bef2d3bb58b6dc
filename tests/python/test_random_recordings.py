"""The engine gazebo11 against real Gazebo 11 with vehicles, tags and worlds made by chance.

Each folder is named for what it shows (``shows`` in its params.txt). Where the environment variable
QUADCORE_RECORDINGS names a folder with more of them, those are flown too.
"""

from __future__ import annotations

import numpy as np
import pytest
from test_gazebo_recordings import FOLDERS, name_of

import quadcore as qc

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

IN_FLIGHT, IN_CONTACT = 1e-9, 1e-6  # m
CLOSER = {"C_damp_3102": 1e-10}  # m
# A vehicle that tumbles over the ground multiplies any difference: comparable until then, s.
CHAOTIC = {"C_names_02": 1.0}

FLOWN, LOST = [], []
for case in (case for folder in FOLDERS for case in sorted(folder.glob("random/*/"))):
    (FLOWN if (case / "record.csv.gz").exists() else LOST).append(case)


def parameters(case):
    lines = (case / "params.txt").read_text().splitlines()
    return {name: values for name, *values in map(str.split, lines)}


def make_simulation(case, engine="gazebo11"):
    given = parameters(case)
    simulation = qc.Simulation(
        case / "model.urdf", engine=engine, world=case / "case.world", spawn=given["spawn"]
    )
    if "twist" in given:
        twist = np.array(given["twist"], dtype=float)
        state = simulation.state.copy()
        state.linear_velocity, state.angular_velocity = twist[:3], twist[3:]
        simulation.set_state(state)
    return simulation


@pytest.mark.parametrize("case", FLOWN, ids=name_of)
def test_a_vehicle_of_any_kind_flies_and_lands_as_recorded(case):
    simulation = make_simulation(case)
    if parameters(case)["solver"] == ["world"] and simulation.world.ground_plane:
        # Gazebo's direct solver fails on the ground.
        assert any("solver type world" in warning for warning in simulation.warnings)
        return
    recorded = np.loadtxt(case / "record.csv.gz", delimiter=",", skiprows=1)
    recorded = recorded[recorded[:, 0] <= CHAOTIC.get(case.name, np.inf)]
    log = simulation.run(recorded[-1, 0], commands=case / "commands.csv")
    rows = np.rint(recorded[:, 0] / simulation.dt).astype(int)
    apart = np.linalg.norm(log.position[rows] - recorded[:, 1:4], axis=1)
    bar = IN_CONTACT if simulation.world.ground_plane else IN_FLIGHT
    assert apart.max() < CLOSER.get(case.name, bar)


@pytest.mark.parametrize("case", LOST, ids=name_of)
def test_a_vehicle_of_which_gazebo_loses_a_rotor_is_refused(case):
    with pytest.raises(
        qc.InputError, match=r"Gazebo silently drops it .* or use the engine ode or eigen"
    ):
        make_simulation(case)
    make_simulation(case, "ode").step(10)


def test_self_collide_of_a_model_is_warned_of():
    case = next(case for case in FLOWN if case.name == "C_selfcol_3100")
    (warning,) = (w for w in make_simulation(case).warnings if "self_collide" in w)
    assert "does not affect the motion: <self_collide> (" in warning
    assert "model.urdf:25" in warning


@pytest.mark.parametrize("name", ["F_onrotor_03", "F_twoblade_04c"])
def test_fifty_sweeps_that_do_not_converge_are_reported(name):
    case = next(case for case in FLOWN if case.name == name)
    assert "50 iterations of Gazebo's solver, which leave" in make_simulation(case).method
    assert "direct solver" in make_simulation(case, "ode").method


@pytest.mark.parametrize("name", ["C_crash_05", "s_fdir45"])
def test_restoring_beside_a_contact_repeats_the_bytes(name):
    case = next(case for case in FLOWN if case.name == name)
    simulation = make_simulation(case)
    after = 0
    while after < 10:  # steps in the air after an impact are Gazebo's sweeps
        simulation.step()
        touches = simulation.state.linear_velocity[2] > 0 or simulation.time > 1
        after = after + 1 if touches else 0
    snapshot = simulation.snapshot()
    first = simulation.run(0.3).table
    other = make_simulation(case)
    other.restore(snapshot)
    assert other.run(0.3).table.tobytes() == first.tobytes()


@pytest.mark.parametrize("ground", ["", "<include><uri>model://ground_plane</uri></include>"])
def test_a_batch_caps_the_corrections_of_hinges_as_single_flights_do(ground, tmp_path):
    case = next(case for case in FLOWN if case.name == "F_cmv_3100")
    world, uncapped = tmp_path / "case.world", tmp_path / "uncapped.world"
    text = (case / "case.world").read_text().replace("</world>", f"{ground}</world>")
    world.write_text(text)
    uncapped.write_text(text.replace(">10.0<", ">1e6<"))
    n, spawn, twist = 9, (0, 0, 200), np.array(parameters(case)["twist"], dtype=float)
    commands = 404 * np.linspace(0.99, 1.01, n)[:, None] * [1, -1, 1]

    def single(i, world):
        simulation = qc.Simulation(case / "model.urdf", world=world, spawn=spawn)
        state = simulation.state.copy()
        state.linear_velocity, state.angular_velocity = twist[:3], (1 + 0.01 * i) * twist[3:]
        simulation.set_state(state)
        simulation.command(commands[i])
        return simulation

    batch = qc.BatchSimulation(case / "model.urdf", n, engine="gazebo11", world=world, spawn=spawn)
    rows = batch.read_state()
    singles = [single(i, world) for i in range(n)]
    for row, simulation in zip(rows, singles):
        row[7:13] = [*simulation.state.linear_velocity, *simulation.state.angular_velocity]
    batch.set_state(rows)
    for steps in (1, 1, 900, 200, *20 * [1], 200):
        batch.step(commands, steps)
        for simulation in singles:
            simulation.step(steps)
        for i, simulation in enumerate(singles):
            assert batch.state.position[i].tolist() == simulation.state.position.tolist()
            assert batch.state.rotor_angle[i].tolist() == simulation.state.rotor_angle.tolist()
    free = single(0, uncapped)
    free.step(1322)
    assert np.linalg.norm(free.state.position - singles[0].state.position) > 1e-6


def test_friction_that_depends_on_the_direction_turns_with_the_vehicle():
    """Sliding along fdir1 is braked by mu1, across it by mu2, whatever the heading."""
    case = next(case for case in FLOWN if case.name == "s_fdir45")

    def measure_slowdown(heading, along):
        # fdir1 1 1 0 has the length 1.41, by which it multiplies both frictions.
        simulation = qc.Simulation(
            case / "model.urdf", world=case / "case.world", spawn=(0, 0, 0.05, 0, 0, heading)
        )
        simulation.step(200)
        state = simulation.state.copy()
        direction = heading + (np.pi / 4 if along else 3 * np.pi / 4)
        v = np.array([np.cos(direction), np.sin(direction), 0])
        state.linear_velocity, state.angular_velocity = v, (0, 0, 0)
        simulation.set_state(state)
        simulation.step(50)
        return (1 - simulation.state.linear_velocity @ v) / 0.05

    for heading in (0.0, 0.7, 2.5):
        assert measure_slowdown(heading, True) == pytest.approx(0.2 * 2**0.5 * 9.8, rel=0.1)
        assert measure_slowdown(heading, False) == pytest.approx(0.8 * 2**0.5 * 9.8, rel=0.1)


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_tags_act_as_they_say(engine, tmp_path):
    """A ball in free fall, with its rotor: gravity, damping, friction, implicit damping."""
    model = tmp_path / "ball.urdf"

    def fly_ball(tags="", dynamics="", steps=500, **start):
        model.write_text(
            '<robot name="ball"><link name="frame"><inertial><origin xyz="0.01 0 0"/>'
            '<mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.012" iyz="0" izz="0.02"/>'
            '</inertial></link><link name="rotor"><inertial><mass value="0.1"/>'
            '<inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="2e-4"/></inertial></link>'
            '<joint name="turn" type="continuous"><parent link="frame"/><child link="rotor"/>'
            f'<axis xyz="0 0 1"/><dynamics {dynamics}/></joint>{tags}</robot>'
        )
        simulation = qc.Simulation(model, engine=engine, spawn=(0, 0, 100))
        state = simulation.state.copy()
        for name, value in start.items():
            setattr(state, name, value)
        simulation.set_state(state)
        simulation.step(steps)
        return simulation.state

    def reference(name, inside):
        return f'<gazebo reference="{name}">{inside}</gazebo>'

    off = "<turnGravityOff>true</turnGravityOff>"
    assert fly_ball().linear_velocity[2] == pytest.approx(-4.9)
    weightless = fly_ball(reference("frame", off) + reference("rotor", off))
    assert weightless.linear_velocity[2] == pytest.approx(0, abs=1e-12)

    damped = fly_ball(
        reference("frame", off + "<dampingFactor>0.01</dampingFactor>")
        + reference("rotor", off + "<dampingFactor>0.01</dampingFactor>"),
        steps=100,
        linear_velocity=(1, 2, 3),
    )
    assert damped.linear_velocity == pytest.approx(np.array([1, 2, 3]) * 0.99**100, rel=1e-6)

    # The frame takes what the rotor loses: 1/J = 1/0.02 + 1/0.0002, about their common axis.
    spin = {"rotor_velocity": np.array([50.0]), "steps": 100}
    inverse = 1 / 2e-4 + 1 / 0.02
    rubbed = fly_ball(dynamics='friction="0.01"', **spin)
    assert rubbed.rotor_velocity[0] == pytest.approx(50 - 0.1 * 0.01 * inverse, rel=1e-2)
    implicit = reference("turn", "<implicitSpringDamper>true</implicitSpringDamper>")
    stiff = fly_ball(implicit, dynamics='damping="0.1"', **spin)
    # Backward Euler: w' = w / (1 + dt c / J), stable where the explicit torque would be doubtful.
    assert abs(stiff.rotor_velocity[0]) < 50 / (1 + 1e-3 * 0.1 * inverse) ** 90
    soft = fly_ball(implicit, dynamics='damping="1e-4"', **spin).rotor_velocity[0]
    assert soft == pytest.approx(50 / (1 + 1e-3 * 1e-4 * inverse) ** 100, rel=1e-3)
