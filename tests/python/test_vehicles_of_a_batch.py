"""What the vehicles of a batch may differ in, and how that is said."""

from __future__ import annotations

import re

import numpy as np
import pytest
import vehicles as v

import quadcore as qc
from quadcore import BatchSimulation, InputError, Simulation

TAG = "drone_plugin.rotorThrustCoeff"
COMMANDS = np.array([[471.0, -473, 480, -468], [480, -470, 475, -476], [469, -481, 470, -477]])

ODD = """<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="heavy" default="1"/>
<xacro:arg name="aside" default="0.01"/>
{}
</robot>"""

TWO_OR_FOUR = """<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="many" default="true"/>
<xacro:if value="$(arg many)">{}</xacro:if>
<xacro:unless value="$(arg many)">{}</xacro:unless>
</robot>"""


def _inside(urdf):
    return urdf[urdf.index(">") + 1 : -len("</robot>")]


@pytest.fixture
def odd(tmp_path):
    """A skew vehicle whose mass and centre of mass are arguments."""
    path = tmp_path / "odd.urdf.xacro"
    com = (0.77, -0.006, 0.017)
    text = v.vehicle(v.ODD, "$(arg heavy)", v.SKEW, com, {**v.LIFT, **v.DRAG}, v.MOTOR)
    path.write_text(ODD.format(_inside(text).replace('"0.77 ', '"$(arg aside) ')))
    return path


@pytest.mark.parametrize("engine", ["eigen", "gazebo11", "ode"])
def test_arguments_of_xacro_may_be_each_vehicles_own(odd, engine):
    own = {
        "xacro.heavy": np.array([0.8, 1.1, 0.8]),
        "xacro.aside": np.array([0.02, 0.01, -0.013]),
        "aerodynamic.rotorThrustCoeff": np.array([8e-6, 8.5e-6, 9e-6]),
    }
    batch = BatchSimulation(odd, 3, engine=engine, parameters={**own, "propeller2.mass": 0.012})
    batch.step(COMMANDS, 40)
    for i in range(3):
        parameters = {
            **{key: float(each[i]) for key, each in own.items()},
            "propeller2.mass": 0.012,
        }
        alone = Simulation(odd, engine=engine, parameters=parameters)
        alone.command(COMMANDS[i])
        alone.step(40)
        for name, rows in batch.state._asdict().items():
            np.testing.assert_array_equal(rows[i], getattr(alone.state, name), err_msg=name)
    assert len(np.unique(batch.state.position[:, 2])) == 3


@pytest.mark.parametrize("as_argument", [False, True])
def test_geometry_and_words_may_be_each_vehicles_own(as_argument):
    own = {"arm_length": np.array([0.1, 0.2]), "drag": np.array(["none", "all"])}
    given = (
        {"xacro_args": own}
        if as_argument
        else {"parameters": {f"xacro.{name}": each for name, each in own.items()}}
    )
    batch = BatchSimulation(n=2, **given)
    batch.step(COMMANDS[:2], 40)
    for i in range(2):
        arguments = {name: each[i] for name, each in own.items()}
        alone = Simulation(engine="eigen", xacro_args=arguments)
        alone.command(COMMANDS[i])
        alone.step(40)
        assert batch.state.angular_velocity[i].tolist() == alone.state.angular_velocity.tolist()
        assert batch.state.position[i].tolist() == alone.state.position.tolist()


def test_an_argument_that_makes_other_rotors_makes_no_batch(tmp_path):
    four, two = v.vehicle(air=v.AIR, motor=v.MOTOR), v.vehicle(v.ODD[:2], air=v.AIR, motor=v.MOTOR)
    path = tmp_path / "two_or_four.xacro"
    path.write_text(TWO_OR_FOUR.format(_inside(four), _inside(two)))
    own = {"xacro.many": np.array([True, True, False])}
    rotors = Simulation(path).rotor_count
    expected = (
        f"set xacro.many: vehicle 2 has 2 rotors, but vehicle 0 has {rotors}. Make a separate"
    )
    with pytest.raises(InputError, match=expected):
        BatchSimulation(path, 3, parameters=own)


def test_an_array_without_length_is_a_number():
    given = {
        TAG: np.array(1.2e-5),
        "frame.mass": np.array(1.1),
        "odometry.publishTf": np.array(True),
    }
    one, same = Simulation(parameters=given), BatchSimulation(parameters=given, engine="gazebo11")
    assert one.mass == pytest.approx(1.14)
    values = {tag.name: tag.value for plugin in one.plugins for tag in plugin.parameters}
    assert float(values["rotorThrustCoeff"]) == 1.2e-5
    one.command(COMMANDS[0])
    one.step(10)
    same.step(COMMANDS[:1], 10)
    assert same.state.position[0].tolist() == one.state.position.tolist()


@pytest.mark.parametrize(
    ("parameters", "expected"),
    [
        ({TAG: [1e-5, 2e-5]}, "For a value per vehicle, give an array of shape (2,)."),
        ({TAG: (1e-5, 2e-5)}, "For a value per vehicle, give an array of shape (2,)."),
        ({"frame.mass": [1, 2]}, "For a value per vehicle, give an array of shape (2,)."),
        ({"xacro.arm_length": [0.1, 0.2]}, "For a value per vehicle, give an array of shape (2,)."),
        ({"xacro.sim_slow": [1, 10]}, "For a value per vehicle, give an array of shape (2,)."),
        ({TAG: np.full((2, 1), 1e-5)}, f"set {TAG}: an array of shape (2, 1) for 2 vehicles. Give"),
        ({TAG: np.full((2, 3, 1), 1e-5)}, f"set {TAG}: an array of shape (2, 3, 1) for 2 vehicles"),
        (
            {"frame.mass": np.ones((2, 1))},
            "set frame.mass: an array of shape (2, 1) for 2 vehicles",
        ),
        ({"xacro.frame_mass": np.ones(3)}, "set xacro.frame_mass: 3 values for 2 vehicles"),
        ({TAG: np.full((2, 2), 1e-5)}, "For a value per vehicle, give an array of shape (2,)."),
    ],
)
def test_values_that_are_not_one_for_each_vehicle_are_refused(parameters, expected):
    with pytest.raises(InputError, match=re.escape(expected)) as refusal:
        BatchSimulation(n=2, parameters=parameters)
    assert "\n" not in str(refusal.value)
    arguments = {key[6:]: value for key, value in parameters.items() if key.startswith("xacro.")}
    if arguments:
        with pytest.raises(InputError, match=re.escape(expected)):
            BatchSimulation(n=2, xacro_args=arguments)


def test_rows_of_numbers_are_one_of_each_vehicle(relays, toy):
    from relays import element

    relays(element("one", publishes="push", own="1 2"))
    own = np.array([[3.0, 4.0], [5.0, 6.0]])
    batch = BatchSimulation(toy / "toy.urdf", 2, parameters={"one.own": own})
    assert batch.n == 2
    with pytest.raises(qc.InputError, match="set one"):
        BatchSimulation(toy / "toy.urdf", 2, parameters={"one.own": np.ones((2, 3))})
