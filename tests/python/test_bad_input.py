"""Plugin tags, plugin files and arguments that are refused, each with what to give instead."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from faults import assert_refused, fault, refusal

import quadcore as qc

pytestmark = pytest.mark.usefixtures("toy")

K = "<rotorThrustCoeff>1e-5</rotorThrustCoeff>"
KP = "<kp>5e-4</kp>"
AIR = '<plugin name="air" filename="libaerodynamic_plugin.so">'
MOTOR = '<plugin name="motor" filename="libmotorpid_plugin.so">'
ODOMETRY = '<plugin name="odometry" filename="libodometry_plugin.so">'
RATE = "<rate>100</rate>"
AIR_SLOW = "<sim_slow>10</sim_slow>"
MOTOR_SLOW = "<sim_slow>10.0</sim_slow>"


def k(value):
    return f"<rotorThrustCoeff>{value}</rotorThrustCoeff>"


@pytest.mark.parametrize(
    "broken",
    [
        *(
            fault(K, k(value), f"'air': <rotorThrustCoeff> '{value}'", "plain number in N s^2")
            for value in ("nan", "inf", "-inf", "1e999", "1e-5 N", "1e-5 1e-5", "0x1", "k", "")
        ),
        fault(K, k("-1"), "'air': <rotorThrustCoeff> '-1'", "write a number >= 0"),
        fault(K, "", "'air': required tag <rotorThrustCoeff>", "add", "in N s^2/rad^2", at=AIR),
        fault(KP, "", "'motor': required tag <kp>", "add <kp>", "N m s/rad", at=MOTOR),
        fault(K, K + "\n" + k(2), "<rotorThrustCoeff>", "toy.urdf:31", "keep one", at=k(2)),
        fault(K, "<rotorTrustCoeff>1</rotorTrustCoeff>", "'air'", "mean 'rotorThrustCoeff'?"),
        fault(KP, f"{KP}<kI>1</kI>", "'motor': unknown tag <kI>", "did you mean 'ki'?"),
        fault(K, k("<b>1</b>"), "unknown tag <rotorThrustCoeff/b>", "mean 'rotorThrustCoeff'"),
        fault(K, f"{K}1", "stray text '1'", 'name="air"', "<tag>value</tag>", at=AIR),
        fault(AIR_SLOW, "<sim_slow>0</sim_slow>", "'air': <sim_slow> '0'", "write a number > 0"),
        fault(K, f"{K}<rotorRadius>0</rotorRadius>", "<rotorRadius> '0'", "a number > 0"),
        fault(K, f"{K}<dragModel>none</dragModel>", "'none'", "write appendix | chapter2"),
        fault(K, f"{K}<reactionTorque>-1</reactionTorque>", "'-1'", "write thesis | opposing"),
        fault(K, f"{K}<publishTf>yes</publishTf>", "<publishTf> 'yes'", "write true | false"),
        fault(KP, f"{KP}<iMax>-1</iMax>", "'motor': <iMax> '-1'", "a number >= 0"),
        fault(KP, f"{KP}<iMin>1</iMin>", "'motor': <iMin> '1'", "a number <= 0"),
        fault(KP, f"{KP}<kd>-1</kd>", "'motor': <kd> '-1'", "a number >= 0"),
        fault(KP, f"{KP}<maxVelocity>0</maxVelocity>", "<maxVelocity> '0'", "a number > 0"),
        fault(KP, f"{KP}<commandTimeout>off</commandTimeout>", "'off'", "number in s, > 0"),
        fault(RATE, "<rate>0</rate>", "'odometry': <rate> '0'", "a number > 0"),
        fault(RATE, f"{RATE}<updateRate>1</updateRate>", "<updateRate>", "second", "keep one"),
        fault(RATE, "<positionNoise>-1</positionNoise>", "<positionNoise> '-1'", ">= 0"),
        fault(RATE, "<twistFrame>drone</twistFrame>", "'drone'", "write world | body"),
        fault(RATE, "<seed>-1</seed>", "'odometry': <seed> '-1'", "a number >= 0"),
        fault(RATE, "<seed>1.5</seed>", "<seed> is not a whole number; write one", at=ODOMETRY),
    ],
    ids=str,
)
def test_a_tag_that_is_wrong(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(K, f"{K}<frameLink>fram</frameLink>", "'air': <frameLink> 'fram'", "'frame'?"),
        fault(K, f"{K}<frameLink>propeller</frameLink>", "'propeller'", "name the root link"),
        fault(K, f"{K}<rotorJoints>rotr</rotorJoints>", "'rotr'", "did you mean 'rotor'?"),
        fault(K, f"{K}<rotorJoints>weld</rotorJoints>", "'weld'", "the model has rotor"),
        fault(K, f"{K}<rotorJoints>rotor rotor</rotorJoints>", "'rotor' twice", "name it once"),
        fault(K, f"{K}<rotorJoints> </rotorJoints>", "<rotorJoints>", "name at least one"),
    ],
    ids=str,
)
def test_a_tag_that_names_what_is_not_there(broken):
    assert_refused("toy.urdf", broken)


@pytest.mark.parametrize(
    "broken",
    [
        fault(MOTOR_SLOW, "<sim_slow>8</sim_slow>", "10 in 'air'", "8 in 'motor'", "same value"),
        fault(MOTOR_SLOW, "", "10 in 'air'", "1 in 'motor' (default)", "same", at=AIR_SLOW),
        fault(AIR_SLOW, "", "1 in 'air' (default)", "10.0 in 'motor'", "same", at=MOTOR_SLOW),
    ],
    ids=str,
)
def test_two_sim_slow_that_disagree(broken):
    assert_refused("toy.urdf", broken)


GALE = '<plugin name="gale" filename="libaerodynamic_plugin.so">'


@pytest.mark.parametrize(
    "broken",
    [
        fault(MOTOR, '<plugin filename="a.so">', '<plugin> needs the attribute name="..."'),
        fault(MOTOR, '<plugin name="motor">', '<plugin> needs the attribute filename="..."'),
        fault(MOTOR, MOTOR.replace("motor", "air", 1), "second plugin named 'air'", "another name"),
        fault(MOTOR, MOTOR.replace("lib", "../lib"), "'motor'", "is a path", "file name alone"),
        fault(MOTOR, MOTOR.replace("lib", "/lib/lib"), "'motor'", "is a path", "file name alone"),
        fault("<gazebo>", f"{MOTOR}</plugin><gazebo>", "<plugin> stands outside", "wrap it in"),
        fault(AIR, f"<static/>{AIR}", "<static> in <gazebo> is not supported", "takes plugin"),
        fault(
            ODOMETRY,
            f"{GALE}{K}<rotorTorqueCoeff>0</rotorTorqueCoeff>{AIR_SLOW}</plugin>{ODOMETRY}",
            "plugin 'gale' reports the wrench 'thrust'",
            "load only one of them",
        ),
    ],
    ids=str,
)
def test_a_plugin_element_that_is_wrong(broken):
    assert_refused("toy.urdf", broken)


def test_a_plugin_that_is_not_found_names_every_folder_searched(toy, monkeypatch):
    for name in ("first", "second", "third"):
        (toy / name).mkdir()
    qc.load_plugin_path(str(toy / "first"))
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", f"{toy}/second::{toy}/third")
    folders = qc.plugin_folders()
    assert folders[0] == str(toy / "first")
    assert folders[-3:-1] == [f"{toy}/second", f"{toy}/third"]
    assert (Path(folders[-1]) / "libmotorpid_plugin.so").is_file()
    absent = fault(
        "libmotorpid_plugin.so",
        "libmotor.so",
        "'motor'",
        f"libmotor.so was not found in {', '.join(folders)}; correct the filename or add its "
        "folder to QUADCORE_PLUGIN_PATH",
    )
    assert_refused("toy.urdf", absent)


def test_a_file_that_is_no_plugin_is_refused_by_what_it_lacks(toy, monkeypatch):
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(toy))
    (toy / "libtext.so").write_text("no library")
    text = fault("libodometry_plugin.so", "libtext.so", "'odometry'", "cannot be loaded", "rebuild")
    assert_refused("toy.urdf", text)
    (library,) = Path(qc.plugin_folders()[-1]).glob("libquadcore.so*")
    core = fault("libtext.so", library.name, "is not a quadcore plugin", "REGISTER_PLUGIN")
    assert_refused("toy.urdf", core)


def test_a_folder_of_plugins_that_is_none():
    for path in ("nowhere", "toy.urdf"):
        assert refusal(qc.load_plugin_path, path).startswith(f"{path}: is not a folder; give")


@pytest.mark.parametrize(
    ("parameters", "says"),
    [
        ({"air.sim_slow": "ten"}, "set air.sim_slow: plugin 'air': <sim_slow> 'ten' is not a fin"),
        ({"air.sim_slow": math.nan}, "set air.sim_slow: plugin 'air': <sim_slow> 'nan' is not"),
        ({"air.sim_slow": -1}, "set air.sim_slow: plugin 'air': <sim_slow> '-1' is out of range"),
        ({"air.rotorThrustCoeff": None}, "set air.rotorThrustCoeff: plugin 'air'"),
        ({"air.rotorRadios": 1}, "unknown tag <rotorRadios> (did you mean 'rotorRadius'?)"),
        ({"air.rotorJoints": ["rotr"]}, "set air.rotorJoints: plugin 'air': <rotorJoints> names"),
        ({"ar.sim_slow": 1}, "set ar.sim_slow: the model has no plugin 'ar' (did you mean 'air'?)"),
        ({"sim_slow": 1}, "set sim_slow: is not PLUGIN.TAG; write, for example, air.sim_slow"),
        ({"air.": 1}, "set air.: is not PLUGIN.TAG"),
        ({"air.sim_slow": 1}, "toy.urdf:37: <sim_slow> is 1 in 'air' (set) but 10.0 in 'motor'"),
        ({"air.sim_slow": 1, "motor.sim_slow": 2}, "1 in 'air' (set) but 2 in 'motor' (set)"),
    ],
)
def test_parameters_that_are_wrong(parameters, says):
    assert says in refusal(qc.Simulation, "toy.urdf", parameters=parameters)


@pytest.mark.parametrize(
    ("option", "value", "says"),
    [
        ("dt", 0, "dt is 0; write a step in s, from 1e-09 up"),
        ("dt", -0.001, "dt is -0.001; write a step in s, from 1e-09 up"),
        ("dt", 5e-324, "dt is 4.94066e-324; write a step in s, from 1e-09 up"),
        ("dt", 0.99e-9, "dt is 9.9e-10; write a step in s, from 1e-09 up"),
        ("dt", math.nan, "dt is nan; write a step in s, from 1e-09 up"),
        ("dt", math.inf, "dt is inf; write a step in s, from 1e-09 up"),
        ("spawn", (0, 0), "spawn is (0, 0); give x, y, z[, roll, pitch, yaw] in m and rad"),
        ("spawn", (0, 0, 0, 0), "give x, y, z[, roll, pitch, yaw] in m and rad"),
        ("spawn", (0, 0, "up"), "give x, y, z[, roll, pitch, yaw] in m and rad"),
        ("spawn", (0, 0, math.nan), "write x,y,z[,roll,pitch,yaw]"),
        ("spawn", (0, 0, 1e12), "spawn: the distance from the origin is 1e+12 m, but a flight"),
        ("engine", "gazebo", "engine 'gazebo' is not there (did you mean 'gazebo11'?)"),
        (
            "engine",
            "lagrange",
            "Engine 'lagrange' is available in quadcore.FlightPlan",
        ),
        ("seed", -1, "seed is -1; give a whole number from 0"),
        ("seed", 1.5, "seed is 1.5; give a whole number from 0"),
        ("seed", 2**64, "give a whole number from 0 to 2^64 - 1"),
        ("xacro_args", {"a": 1}, "toy.urdf: takes no xacro arguments"),
        ("world", "nowhere.world", "nowhere.world: no such file"),
    ],
)
def test_arguments_that_are_wrong(option, value, says):
    assert says in refusal(qc.Simulation, "toy.urdf", **{option: value})


def like_it(path, mass="1", rotor="rotor"):
    """A snapshot of a vehicle with as many bodies, plugins and topics."""
    text = Path(path).read_text().replace('mass value="1"', f'mass value="{mass}"')
    Path("like_it.urdf").write_text(text.replace('name="rotor"', f'name="{rotor}"'))
    return qc.Simulation("like_it.urdf").snapshot()


def state_of(simulation, **changed):
    state = simulation.state.copy()
    for name, value in changed.items():
        setattr(state, name, value)
    return state


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda s: s.command([]), "command holds 0 rotor speeds; give 1"),
        (lambda s: s.command([1, 2]), "command holds 2 rotor speeds; give 1"),
        (lambda s: s.command([math.nan]), "command for rotor 1 is not a finite number; give rad/s"),
        (lambda s: s.command([math.inf]), "command for rotor 1 is not a finite number; give rad/s"),
        (lambda s: s.command([[1]]), "command is not a 1-dimensional array of numbers"),
        (lambda s: s.command("x"), "command is not a 1-dimensional array of numbers"),
        (lambda s: s.step(-1), "step count is -1; give one >= 0"),
        (lambda s: s.run(-1), "duration is -1; give seconds, from 0 to 1e+09"),
        (lambda s: s.run(math.nan), "duration is nan; give seconds, from 0 to 1e+09"),
        (lambda s: s.run(1, log_every=0), "log_every is 0; give a whole number >= 1"),
        (lambda s: s.run(1, commands=[[0, math.nan]]), "w1 is nan; write a finite number"),
        (lambda s: s.run(1, commands=[[0, 1, 2]]), "takes (rows, 2): t,w1"),
        (lambda s: s.run(1, commands=np.zeros((0, 2))), "commands: holds no commands"),
        (lambda s: s.run(1, commands=[[0, 1], [0, 2]]), "does not come after"),
        (lambda s: s.set_state(state_of(s, position=[0, 0])), "state.position holds 2 numbers"),
        (lambda s: s.set_state(state_of(s, position=[0, 0, math.nan])), "not a finite number"),
        (lambda s: s.set_state(state_of(s, orientation=[0, 0, 0, 0])), "is no quaternion"),
        (lambda s: s.set_state(state_of(s, rotor_velocity=[1, 2])), "this vehicle has 1 rotors"),
        (lambda s: s.set_state(state_of(s, rotor_velocity=[1e7])), "rotor is 1e+07 rad/s, but a"),
        (lambda s: s.set_state(state_of(s, linear_velocity=[0, 2e6, 0])), "velocity is 2e+06 m/s"),
        (lambda s: s.set_state(state_of(s, position=[0, 0, 1e9])), "origin is 1e+09 m, but a"),
        (lambda s: s.set_state(state_of(s, time=math.inf)), "not a finite number"),
        (lambda s: s.set_state(state_of(s, time="now")), "state.time is not a number"),
        (lambda s: s.restore(qc.Simulation("quadrotor").snapshot()), "was taken from another"),
        (lambda s: s.restore(like_it("toy.urdf", mass="1.01")), "was taken from another"),
        (lambda s: s.restore(like_it("toy.urdf", rotor="spinner")), "was taken from another"),
        (lambda s: s.topic("odometry"), "topic 'odometry' is not declared by any plugin"),
    ],
)
def test_a_refused_call_changes_nothing(call, says):
    def fly(refused):
        simulation = qc.Simulation("toy.urdf")
        simulation.command([300])
        simulation.step(10)
        if refused:
            assert says in refusal(call, simulation)
        return simulation.run(0.1).table

    assert np.array_equal(fly(True), fly(False))


def test_a_model_without_motor_cannot_be_commanded(toy):
    text = (toy / "toy.urdf").read_text()
    start, end = text.index(MOTOR), text.index(ODOMETRY)
    (toy / "toy.urdf").write_text(text[:start] + text[end:])
    simulation = qc.Simulation("toy.urdf", parameters={"air.sim_slow": 1})
    assert "add libmotorpid_plugin.so" in refusal(simulation.command, [1])


def test_an_integral_gain_without_limits_is_warned_of():
    with pytest.warns(qc.QuadcoreWarning) as shown:
        simulation = qc.Simulation("toy.urdf", parameters={"motor.ki": 1})
    (warning,) = simulation.warnings
    assert warning.startswith("toy.urdf:35: plugin 'motor': <ki> has no effect while <iMax> and")
    assert [(str(w.message), w.filename) for w in shown] == [(warning, __file__)]
    assert qc.Simulation("toy.urdf", parameters={"motor.ki": 1, "motor.iMax": 1}).warnings == []


def test_effort_limits_of_a_joint_are_warned_of(toy):
    text = (toy / "toy.urdf").read_text()
    limit = '<limit effort="1" velocity="1"/>'
    (toy / "toy.urdf").write_text(text.replace('<dynamics damping="1e-6"/>', limit))
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = qc.Simulation("toy.urdf").warnings
    assert warning.startswith("toy.urdf:27: joint 'rotor': effort and velocity limits")
