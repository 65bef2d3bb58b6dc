"""The engine eigen: exact, of fourth order, and honest about what it cannot fly."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from gyrostat import Gyrostat, angle_between
from scipy.spatial.transform import Rotation
from vehicles import (
    AIR,
    CROSS,
    DRAG,
    FLAPPING,
    MOTOR,
    ODD,
    ROUND,
    SKEW,
    Rotor,
    start,
    vehicle,
)

import quadcore as qc
from quadcore.cli import main

DATA = Path(__file__).resolve().parents[1] / "data"
ENGINES = [name for name, _ in qc.engines()]
GRAVITY = (0, 0, -9.8)
CHAPTER2 = {**AIR, **DRAG, "dragModel": "chapter2"}
HOVER = np.sqrt(1.04 * 9.8 / 4 / 1.1487e-5)
BALANCED = HOVER * np.array([1, -1, 1, -1])
DOUBLET = np.column_stack(
    [
        [0, 0.2, 0.4, 0.6],
        1.02 * BALANCED * [[1, 1, 1, 1], [0.98, 1, 1.02, 1], [1.02, 0.99, 0.98, 1.01], [1] * 4],
    ]
)
# A frame that leans each rotor by 10 degrees, in turn to either side.
TILTED = tuple(
    rotor._replace(rpy=(0.17 * way * rotor.xyz[0] / 0.2, 0.17 * way * rotor.xyz[1] / 0.2, 0))
    for rotor, way in zip(CROSS, (1, -1, 1, -1))
)


@pytest.mark.parametrize("name", ["E1_doublet_all", "E3_doublet_nodrag"])
def test_flies_the_exact_trajectories_to_1e_10(hangar, name):
    """By DOP853 at rtol 1e-13, from an implementation apart from this one."""
    case = json.loads((DATA / "exact" / f"{name}.json").read_text())
    p = case["parameters"]
    rotors = tuple(Rotor(r, mass=p["mp"], inertia=p["Jp"]) for r in p["r"])
    frame = np.array(p["Jf"])
    air = {
        "rotorThrustCoeff": p["k"],
        "rotorTorqueCoeff": p["b"],
        "inducedDragCoeff": p["KI"],
        "translationalDragCoeff": p["KT"],
        "profileDragCoeff": p["KP"],
        "parasiticDragCoeff": p["Kpar"],
        "dragModel": "chapter2",
    }
    urdf = vehicle(rotors, p["mf"], (*np.diag(frame), 0, 0, 0), p["cf"], air, {"kp": p["kp"]})
    simulation = hangar(urdf, (0, 0, -p["g"]), spawn=(0, 0, 10), engine="eigen", dt=1e-3)
    start(simulation, rotor_velocity=case["initial"]["rotor_velocity"])
    commands = [[row["t"], *row["w"]] for row in case["commands"]]
    log = simulation.run(case["states"][-1]["t"], commands, log_every=1000)
    for row, exact in enumerate(case["states"], start=1):
        assert log.time[row] == pytest.approx(exact["t"])
        assert np.abs(log.position[row] - exact["position"]).max() < 1e-10
        assert np.abs(log.linear_velocity[row] - exact["linear_velocity"]).max() < 1e-10
        assert np.abs(log.angular_velocity[row] - exact["angular_velocity"]).max() < 1e-10
        assert angle_between(log.orientation[row : row + 1], [exact["orientation_xyzw"]]) < 1e-10
        assert np.abs(log.rotor_velocity[row] - exact["rotor_velocity"]).max() < 1e-7


def test_a_step_half_as_long_makes_a_sixteenth_of_the_error(hangar):
    def end(dt):
        urdf = vehicle(ODD, 1, SKEW, (0.004, -0.003, 0.005), {**CHAPTER2, **FLAPPING}, MOTOR)
        simulation = hangar(urdf, GRAVITY, (2, -1, 0.5), engine="eigen", dt=dt)
        start(simulation, rotor_velocity=BALANCED, angular_velocity=[1, -2, 1.5])
        return simulation.run(1.2, DOUBLET).table[-1, 1:14]

    exact = end(1e-4)
    errors = [np.linalg.norm(end(dt) - exact) for dt in (4e-3, 2e-3, 1e-3)]
    orders = np.log2(errors[:-1] / np.array(errors[1:]))
    assert np.abs(orders - 4).max() < 0.1


@pytest.mark.parametrize(
    ("rotors", "inertia", "com", "spin"),
    [
        pytest.param(CROSS, ROUND, (0, 0, 0), [1, -1, 1, -1], id="balanced"),
        pytest.param(CROSS, ROUND, (0, 0, 0), [1, 1, 1, 1], id="unbalanced"),
        pytest.param(ODD, SKEW, (0.01, -0.02, 0.015), [0.5, 1, -0.2, 0.7], id="odd"),
    ],
)
def test_a_minute_without_torque_keeps_energy_and_momentum(hangar, rotors, inertia, com, spin):
    simulation = hangar(vehicle(rotors, 1, inertia, com), engine="eigen")
    rate = np.array([3.0, -2.0, 3.4])  # 5 rad/s in all
    start(simulation, angular_velocity=rate, rotor_velocity=HOVER * np.array(spin))
    log = simulation.run(60, log_every=100)
    true = Gyrostat(rotors, 1, inertia, com)
    rates = list(zip(log.angular_velocity, log.rotor_velocity))
    energy = np.array([true.energy(*r) for r in rates])
    momentum = Rotation.from_quat(log.orientation).apply([true.momentum(*r) for r in rates])
    assert np.abs(energy / energy[0] - 1).max() < 1e-10
    size = np.linalg.norm(momentum[0])
    assert np.linalg.norm(momentum - momentum[0], axis=1).max() < 1e-10 * size


@pytest.mark.parametrize("engine", ENGINES)
def test_joint_angles_wrap_at_half_a_turn(hangar, engine):
    spin = np.array([300, -410, 55, -3.5])
    simulation = start(hangar(vehicle(ODD), engine=engine), rotor_velocity=spin)
    wrapped = np.zeros(4, dtype=bool)
    before = simulation.state.rotor_angle.copy()
    for _ in range(1500):
        simulation.step()
        angle = simulation.state.rotor_angle.copy()
        assert (np.abs(angle) <= np.pi).all()
        turned = (angle - before + np.pi) % (2 * np.pi) - np.pi
        assert np.allclose(turned, simulation.state.rotor_velocity * 1e-3, rtol=0.03, atol=1e-3)
        wrapped |= np.abs(angle - before) > np.pi
        before = angle
    assert wrapped.all()


@pytest.mark.parametrize("drag", ["appendix", "chapter2"])
def test_upright_rotors_fly_bit_for_bit_as_rotors_at_any_angle_do(hangar, drag):
    """A breeze that no sum feels has the step compiled for all vehicles taken."""
    upright = [rotor._replace(rpy=(0, 0, rotor.rpy[2])) for rotor in ODD]
    tags = {**AIR, **DRAG, **FLAPPING, "dragModel": drag}
    urdf = vehicle(upright, inertia=SKEW, com=(0.004, -0.003, 0.005), air=tags, motor=MOTOR)

    def fly(wind):
        simulation = hangar(urdf, gravity=GRAVITY, wind=wind, engine="eigen")
        start(simulation, linear_velocity=[3, -2, 1], angular_velocity=[1, 2, -3])
        return simulation.run(1.0, commands=DOUBLET * [1, 1.01, 0.99, 1.02, 1])

    assert fly((0, 0, 0)).table.tobytes() == fly((1e-300, 0, 0)).table.tobytes()


def test_a_flight_turns_with_the_world(hangar):
    """Gravity, wind and start turned by any rotation turn the flight."""
    urdf = vehicle(ODD, 1, SKEW, (0.004, -0.003, 0.005), {**CHAPTER2, **FLAPPING}, MOTOR)
    wind, speed = np.array([2.0, 1.0, -1.0]), np.array([1.0, 2.0, 3.0])

    def fly(turn):
        world = {"gravity": turn.apply(GRAVITY), "wind": turn.apply(wind)}
        simulation = hangar(urdf, **world, engine="eigen", dt=2.5e-4)
        members = {"orientation": turn.as_quat(), "linear_velocity": turn.apply(speed)}
        start(simulation, rotor_velocity=BALANCED, **members)
        return simulation.run(2, DOUBLET)

    plain = fly(Rotation.identity())
    for turn in Rotation.random(4, random_state=np.random.RandomState(4)):
        turned = fly(turn)
        assert np.abs(turn.inv().apply(turned.position) - plain.position).max() < 1e-10
        attitude = turn.inv() * Rotation.from_quat(turned.orientation)
        assert angle_between(attitude.as_quat(), plain.orientation).max() < 1e-10


@pytest.mark.parametrize(
    "spin", [pytest.param([1, -1, 1, -1], id="balanced"), pytest.param([1, 1, 1, 1], id="alike")]
)
@pytest.mark.parametrize("rotors", [CROSS, TILTED], ids=["upright", "tilted"])
def test_ode_comes_to_eigen_as_the_step_shrinks(hangar, rotors, spin):
    def fly(engine, dt):
        # No reaction torque: with all rotors alike it would spin the vehicle up.
        air = {**CHAPTER2, "rotorTorqueCoeff": 0}
        simulation = hangar(vehicle(rotors, air=air, motor=MOTOR), GRAVITY, engine=engine, dt=dt)
        start(simulation, rotor_velocity=HOVER * np.array(spin), angular_velocity=[0.2, -0.1, 0.3])
        commands = DOUBLET.copy()
        commands[:, 1:] = np.abs(DOUBLET[:, 1:]) * spin
        return simulation.run(2, commands, log_every=round(0.01 / dt))

    exact = fly("eigen", 1e-3)
    steps = (1e-3, 2.5e-4, 6.25e-5)
    apart = [np.abs(fly("ode", dt).position - exact.position).max() for dt in steps]
    assert apart[0] < 0.1
    assert apart[1] < apart[0] / 2
    assert apart[2] < min(apart[1] / 2, 2e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_hexarotor_flies(engine):
    case = DATA / "gazebo11" / "cases" / "B1_hexa_hover"
    flights = [
        qc.Simulation(case / "model.urdf", engine=e, world=case / "case.world", spawn=(0, 0, 10))
        for e in (engine, "eigen")
    ]
    near = {"gazebo11": 1, "ode": 0.01, "eigen": 0}
    log, exact = (flight.run(2, case / "commands.csv") for flight in flights)
    assert log.rotor_velocity.shape[1] == 6
    assert log.position[-1, 2] > 6  # from rest: it falls until the rotors have come up
    assert np.abs(log.position - exact.position).max() <= near[engine]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_quadrotor_with_tilted_rotors_hovers(hangar, engine):
    urdf = vehicle(TILTED, air=CHAPTER2, motor=MOTOR)
    simulation = hangar(urdf, GRAVITY, engine=engine)
    speeds = BALANCED / np.sqrt(np.cos(0.17))
    start(simulation, rotor_velocity=speeds).command(speeds)
    log = simulation.run(2)
    assert np.abs(log.position).max() < 1e-6


NESTED = (
    '<link name="blade"><inertial><mass value="0.001"/><inertia ixx="1e-6" ixy="0" ixz="0" '
    'iyy="1e-6" iyz="0" izz="2e-6"/></inertial></link><joint name="flap" type="continuous">'
    '<parent link="propeller1"/><child link="blade"/><axis xyz="0 0 1"/></joint></robot>'
)


OFF_AXIS = '<link name="propeller1"><inertial><origin xyz="{} 0.0 0.0"/>'


@pytest.mark.parametrize(
    ("old", "new", "joint", "why"),
    [
        (
            OFF_AXIS.format(0.0),
            OFF_AXIS.format(0.001),
            "rotor1",
            "of 'propeller1' lies off the axis",
        ),
        (
            '<axis xyz="0 0 1"/>',
            '<axis xyz="0 0.6 0.8"/>',
            "rotor1",
            "not symmetric about the axis",
        ),
        ("</robot>", NESTED, "flap", "its parent is the moving link 'propeller1'"),
    ],
    ids=["off its axis", "leaning axis", "nested"],
)
def test_refuses_what_is_no_gyrostat_and_says_what_flies_it(hangar, old, new, joint, why):
    urdf = vehicle(air=AIR, motor=MOTOR)
    assert old in urdf
    urdf = urdf.replace(old, new, 1)
    with pytest.raises(qc.InputError) as refused:
        hangar(urdf, engine="eigen")
    for part in (f"joint '{joint}'", why, "Use the engine ode"):
        assert part in str(refused.value)
    hangar(urdf, engine="ode").step(10)


def test_a_flight_that_begins_in_the_ground_ends_at_once_and_says_where_to_begin(capsys):
    # The disc of the frame is 0.0125 m deep below its middle.
    flight = ["run", "quadrotor", "--engine", "eigen", "--world", "default"]
    assert main([*flight, "--spawn", "0,0,0"]) == 3
    said = capsys.readouterr().err
    assert "0.0125 m deep in the ground" in said
    assert "Start at z = 0.0125 or above" in said
