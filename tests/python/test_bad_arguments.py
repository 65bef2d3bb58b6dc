"""Arguments that are refused, each in one line of quadcore's own that says what to give."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from faults import refusal
from flights import quadrotor

import quadcore as qc

pytestmark = pytest.mark.usefixtures("toy")


@pytest.mark.parametrize(
    ("parameters", "says"),
    [
        ({"air.sim_slow": "ten"}, "set air.sim_slow: plugin 'air': <sim_slow> 'ten' is not a fin"),
        ({"air.sim_slow": math.nan}, "set air.sim_slow: plugin 'air': <sim_slow> 'nan' is not"),
        ({"air.sim_slow": -1}, "set air.sim_slow: plugin 'air': <sim_slow> '-1' is out of range"),
        ({"air.rotorThrustCoeff": None}, "set air.rotorThrustCoeff: plugin 'air'"),
        ({"air.rotorRadios": 1}, "unknown tag <rotorRadios>. Did you mean 'rotorRadius'?"),
        ({"air.rotorJoints": ["rotr"]}, "set air.rotorJoints: plugin 'air': <rotorJoints> names"),
        ({"ar.sim_slow": 1}, "set ar.sim_slow: the model has no plugin 'ar'. Did you mean 'air'?"),
        (
            {"sim_slow": 1},
            "set sim_slow: the name is not of the form PLUGIN.TAG. Write, for example, air.",
        ),
        ({"air.": 1}, "set air.: the name is not of the form PLUGIN.TAG"),
        ({"air.sim_slow": 1}, "toy.urdf:37: <sim_slow> is 1 in 'air' (set) but 10.0 in 'motor'"),
        ({"air.sim_slow": 1, "motor.sim_slow": 2}, "1 in 'air' (set) but 2 in 'motor' (set)"),
    ],
)
def test_parameters_that_are_wrong(parameters, says):
    assert says in refusal(qc.Simulation, "toy.urdf", parameters=parameters)


@pytest.mark.parametrize(
    ("option", "value", "says"),
    [
        ("dt", 0, "dt is 0 s. Use a step of at least 1e-09 s."),
        ("dt", -0.001, "dt is -0.001 s. Use a step of at least 1e-09 s."),
        ("dt", 5e-324, "dt is 4.94066e-324 s. Use a step of at least 1e-09 s."),
        ("dt", 0.99e-9, "dt is 9.9e-10 s. Use a step of at least 1e-09 s."),
        ("dt", math.nan, "dt is nan s. Use a step of at least 1e-09 s."),
        ("dt", math.inf, "dt is inf s. Use a step of at least 1e-09 s."),
        ("spawn", (0, 0), "spawn is (0, 0). Give x, y, z[, roll, pitch, yaw] in m and rad"),
        ("spawn", (0, 0, 0, 0), "Give x, y, z[, roll, pitch, yaw] in m and rad"),
        ("spawn", (0, 0, "up"), "Give x, y, z[, roll, pitch, yaw] in m and rad"),
        ("spawn", (0, 0, math.nan), "Write x,y,z[,roll,pitch,yaw]"),
        ("spawn", (0, 0, 1e12), "spawn: the distance from the origin is 1e+12 m, but a flight"),
        ("engine", "gazebo", "engine 'gazebo' does not exist. Did you mean 'gazebo11'?"),
        (
            "engine",
            "lagrange",
            "Engine 'lagrange' is available in quadcore.FlightPlan",
        ),
        ("seed", -1, "seed is -1. Give a whole number from 0"),
        ("seed", 1.5, "seed is 1.5. Give a whole number from 0"),
        ("seed", 2**64, "Give a whole number from 0 to 2^64 - 1"),
        ("xacro_args", {"a": 1}, "toy.urdf: takes no xacro arguments"),
        ("world", "nowhere.world", "nowhere.world: neither a file"),
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
        (lambda s: s.command([]), "the command has 0 rotor speeds. Give 1."),
        (lambda s: s.command([1, 2]), "the command has 2 rotor speeds. Give 1."),
        (
            lambda s: s.command([math.nan]),
            "the command for rotor 1 is not a finite number. Give a speed",
        ),
        (
            lambda s: s.command([math.inf]),
            "the command for rotor 1 is not a finite number. Give a speed",
        ),
        (lambda s: s.command([[1]]), "command is not a 1-dimensional array of numbers"),
        (lambda s: s.command("x"), "command is not a 1-dimensional array of numbers"),
        (lambda s: s.step(-1), "the step count is -1. Give a whole number >= 0."),
        (lambda s: s.run(-1), "duration is -1. Give seconds, from 0 to 1e+09"),
        (lambda s: s.run(math.nan), "duration is nan. Give seconds, from 0 to 1e+09"),
        (lambda s: s.run(1, log_every=0), "log_every is 0. Give a whole number >= 1"),
        (lambda s: s.run(1, commands=[[0, math.nan]]), "w1 is nan. Write a finite number."),
        (lambda s: s.run(1, commands=[[0, 1, 2]]), "Give (rows, 2): t,w1"),
        (lambda s: s.run(1, commands=np.zeros((0, 2))), "commands: holds no commands"),
        (lambda s: s.run(1, commands=[[0, 1], [0, 2]]), "is not later than"),
        (lambda s: s.set_state(state_of(s, position=[0, 0])), "state.position has 2 numbers"),
        (lambda s: s.set_state(state_of(s, position=[0, 0, math.nan])), "not a finite number"),
        (lambda s: s.set_state(state_of(s, orientation=[0, 0, 0, 0])), "is not a unit quaternion"),
        (lambda s: s.set_state(state_of(s, rotor_velocity=[1, 2])), "this vehicle has 1 rotors"),
        (lambda s: s.set_state(state_of(s, rotor_velocity=[1e7])), "rotor is 1e+07 rad/s, but a"),
        (lambda s: s.set_state(state_of(s, linear_velocity=[0, 2e6, 0])), "velocity is 2e+06 m/s"),
        (lambda s: s.set_state(state_of(s, position=[0, 0, 1e9])), "origin is 1e+09 m, but a"),
        (lambda s: s.set_state(state_of(s, time=math.inf)), "not a finite number"),
        (lambda s: s.set_state(state_of(s, time="now")), "state.time is not a number"),
        (
            lambda s: s.restore(qc.Simulation("quadrotor").snapshot()),
            "it was taken with a different",
        ),
        (lambda s: s.restore(like_it("toy.urdf", mass="1.01")), "it was taken with a different"),
        (
            lambda s: s.restore(like_it("toy.urdf", rotor="spinner")),
            "it was taken with a different",
        ),
        (lambda s: s.topic("odometry"), "topic 'odometry' does not exist."),
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


# What each argument refuses; its proper kinds, None among them, are left out.
TEXTS = (b"x", "nonsense")
NUMBERS = (3, 1.5, float("nan"))
LISTS = ([3], [None], (1, 2), np.eye(3))
OTHERS = ({3: 1}, {"a": None}, object(), len)
NO_NAME = (b"x", *NUMBERS, *LISTS, *OTHERS)
NO_NAMES = ("nonsense", b"x", *NUMBERS, *LISTS, {3: 1}, object(), len, None)
NO_MAPPING = (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object(), len)
NO_WHOLE = (*TEXTS, 1.5, float("nan"), *LISTS, *OTHERS, None)
NO_NUMBERS = (*TEXTS, 3, [None], *OTHERS)

OF_BOTH = {
    "model": (*NO_NAME, None),
    "engine": (*NO_NAME, None),
    "world": NO_NAME,
    "dt": (*TEXTS, *LISTS, *OTHERS),
    "parameters": NO_MAPPING,
    "xacro_args": NO_MAPPING,
    "ignore": NO_NAMES,
}
CALLS = {
    "simulation": (qc.Simulation, {**OF_BOTH, "seed": NO_WHOLE, "spawn": NO_NUMBERS}),
    "batch": (qc.BatchSimulation, {**OF_BOTH, "n": NO_WHOLE, "seed": (*TEXTS, *OTHERS)}),
    "read_model": (
        qc.read_model,
        {name: OF_BOTH[name] for name in ("model", "xacro_args", "ignore")},
    ),
    "read_world": (qc.read_world, {name: OF_BOTH[name] for name in ("world", "ignore")}),
    "run": (
        lambda **given: quadrotor("eigen").run(**{"duration": 0.01, **given}),
        {
            "duration": (*TEXTS, *LISTS, *OTHERS, None),
            "commands": (*TEXTS, *NUMBERS, *LISTS, *OTHERS),
            "log_every": NO_WHOLE,
            "progress": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
            "topics": NO_NAMES,
            "controller": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
            "reference": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
        },
    ),
    "step": (lambda **given: quadrotor("eigen").step(**given), {"n": NO_WHOLE}),
    "reset": (lambda **given: quadrotor("eigen").reset(**given), {"seed": NO_WHOLE[:-1]}),
    "log": (qc.Log, {"table": (*TEXTS, *NUMBERS, *LISTS, *OTHERS, None)}),
    "set_state": (lambda **given: quadrotor("eigen").set_state(**given), {"state": NO_NAME}),
    "restore": (
        lambda snapshot=None, allow=(): quadrotor("eigen").restore(
            quadrotor("eigen").snapshot() if snapshot is None else snapshot, allow=allow
        ),
        {"snapshot": NO_NAME, "allow": NO_NAMES},
    ),
    "topic": (lambda **given: quadrotor("eigen").topic(**given), {"name": NO_NAME}),
    "publish": (
        lambda topic, values=(1,): quadrotor("eigen").publish(topic, values),
        {"topic": NO_NAME},
    ),
    "states of a batch": (
        lambda **given: qc.BatchSimulation("quadrotor", n=2).set_state(**given),
        {"rows": (*TEXTS, *NUMBERS, *LISTS, *OTHERS, None)},
    ),
    "a log read": (qc.Log.of_file, {"path": (*NO_NAME, None)}),
    "a log written": (
        lambda **given: quadrotor("eigen").run(0.01).to_file(**given),
        {"path": (*NO_NAME, None)},
    ),
    "a log drawn": (
        lambda **given: quadrotor("eigen").run(0.01).plot(**given),
        {"directory": (*NO_NAME, None)},
    ),
    "compare": (
        lambda **given: qc.compare(**{"models": "quadrotor", "duration": 0.01, **given}),
        {
            "models": (*NUMBERS, *LISTS, *OTHERS, None),
            "vary": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, {"a": None}, object(), len),
            "duration": (*TEXTS, *LISTS, *OTHERS, None),
            "log_every": NO_WHOLE,
            "processes": (*TEXTS, 1.5, *LISTS, *OTHERS),
            "progress": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
            "enigne": ("ode", 3),
            "dt": (*TEXTS, *LISTS, *OTHERS),
            "engine": (*NO_NAME, None),
            "parameters": NO_MAPPING,
            "ignore": NO_NAMES,
        },
    ),
}


@pytest.mark.parametrize(
    ("call", "argument"), [(call, name) for call, (_, names) in CALLS.items() for name in names]
)
def test_an_argument_of_a_wrong_type_is_refused_in_one_line(call, argument):
    function, arguments = CALLS[call]
    for value in arguments[argument]:
        with pytest.raises(qc.InputError) as refusal:
            function(**{argument: value})
        message = str(refusal.value)
        assert "\n" not in message and len(message) < 250, value
        assert "supported" not in message and "has no attribute" not in message, value


def test_lists_that_come_one_by_one_are_read_once():
    assert len(qc.compare((name for name in ["quadrotor", "iris"]), duration=0.01).table) == 2
    with pytest.raises(qc.InputError, match="nonsense"):
        qc.Simulation("quadrotor", ignore=(name for name in ["nonsense"]))
    log = quadrotor("eigen").run(0.01, topics=(name for name in ["odom"]))
    assert list(log.topics) == ["odom"]
    with pytest.raises(qc.InputError, match=r"vary is .*Give a mapping of names to lists"):
        qc.compare("quadrotor", {"motorpid_plugin.kp": (kp for kp in [1e-3])})
    with pytest.raises(qc.InputError, match=r"models is \[\]. Give a name, or several"):
        qc.compare([])


def test_impossible_numbers_and_names_are_reported():
    with pytest.raises(qc.InputError, match=r"^steps must be a whole number below 2\^63\.$"):
        quadrotor("eigen").step(2**63)
    with pytest.raises(qc.InputError, match=r"^topic must be a name in UTF-8\.$"):
        quadrotor("eigen").topic("\udc80")


def test_what_reading_a_state_raises_is_seen():
    class Late:
        @property
        def time(self):
            raise RuntimeError("not yet")

    with pytest.raises(RuntimeError, match="not yet"):
        quadrotor("eigen").set_state(Late())


def test_a_long_value_is_shortened_in_what_is_said_of_it():
    with pytest.raises(qc.InputError) as refusal:
        qc.Simulation("quadrotor", parameters=np.arange(10000.0).reshape(-1, 10))
    message = str(refusal.value)
    assert (
        message.startswith("parameters is array([[") and len(message) < 250 and "\n" not in message
    )
    assert message.endswith("Give a mapping of names to values.")


def test_an_option_that_there_is_not_is_refused_with_the_nearest():
    with pytest.raises(qc.InputError, match=r"'enigne' does not exist\. Did you mean 'engine'"):
        qc.compare("quadrotor", enigne="ode")
