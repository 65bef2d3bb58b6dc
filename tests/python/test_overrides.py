"""Values of links and of xacro arguments, given from outside like those of plugins' tags."""

from __future__ import annotations

import numpy as np
import pytest
from vehicles import AIR, MOTOR, SKEW, vehicle

import quadcore as qc
from quadcore.cli import main

ARGUMENTS = """<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="heavy" default="1"/>
{}
</robot>"""


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "odd.urdf"
    path.write_text(vehicle(mass=1.3, inertia=SKEW, com=(0.01, 0, 0.02), air=AIR, motor=MOTOR))
    return path


@pytest.fixture
def xacro_model(tmp_path):
    inside = vehicle(mass="$(arg heavy)", air=AIR, motor=MOTOR)
    path = tmp_path / "odd.urdf.xacro"
    path.write_text(ARGUMENTS.format(inside[inside.index(">") + 1 : -len("</robot>")]))
    return path


def test_values_of_links_are_those_of_a_file_that_has_them(model, tmp_path):
    given = {"frame.mass": 1.7, "frame.ixy": -0.0002, "propeller2.izz": "2.7e-5"}
    other = tmp_path / "other.urdf"
    text = model.read_text().replace('mass value="1.3"', 'mass value="1.7"')
    text = text.replace('ixy="0.0004"', 'ixy="-0.0002"')
    second = text.index('"propeller2"')
    text = text[:second] + text[second:].replace('izz="2.8125e-05"', 'izz="2.7e-5"', 1)
    other.write_text(text)
    one, same = qc.Simulation(model, parameters=given), qc.Simulation(other)
    assert one.mass == same.mass == pytest.approx(1.74)
    assert np.array_equal(one.inertia, same.inertia)
    assert np.array_equal(one.model.links[2].inertia, same.model.links[2].inertia)


@pytest.mark.parametrize("origin", ["", '<origin rpy="0 0 0"/>', "<origin xyz='0.1 -2e-1\t0.3'/>"])
def test_a_coordinate_of_the_centre_of_mass_is_that_of_a_file_that_has_it(tmp_path, origin):
    text = vehicle(com=(0.01, 0, 0.02), air=AIR, motor=MOTOR)
    begin = text.index("<origin", text.index("<inertial>"))
    end = text.index(">", begin) + 1
    (tmp_path / "a.urdf").write_text(text[:begin] + origin + text[end:])
    z = "0.3" if "xyz" in origin else "0"
    (tmp_path / "b.urdf").write_text(text[:begin] + f'<origin xyz="0.4 -0.05 {z}"/>' + text[end:])
    given = {"frame.com_x": 0.4, "frame.com_y": "-0.05"}
    one = qc.Simulation(tmp_path / "a.urdf", parameters=given)
    same = qc.Simulation(tmp_path / "b.urdf")
    assert np.array_equal(one.center_of_mass, same.center_of_mass)
    assert np.array_equal(one.inertia, same.inertia)
    batch = qc.BatchSimulation(
        tmp_path / "a.urdf", n=2, parameters={"frame.com_x": np.array([0.0, 0.4])}
    )
    batch.step(np.tile([300, -300], (2, 2)), 100)
    assert not np.array_equal(batch.state.position[0], batch.state.position[1])


def test_an_argument_of_xacro_is_one_more_parameter(xacro_model):
    one = qc.Simulation(xacro_model, parameters={"xacro.heavy": 2})
    assert one.mass == pytest.approx(2.04)
    plan = qc.FlightPlan.of(xacro_model, parameters={"xacro.heavy": 2, "propeller1.mass": 0.03})
    assert plan.parameters == {}
    assert plan.simulation().mass == pytest.approx(2.06)


def test_they_are_varied_like_tags(xacro_model):
    comparison = qc.compare(
        [xacro_model],
        {"xacro.heavy": [1, 1.5], "propeller2.mass": [0.01, 0.02]},
        duration=0.2,
        processes=1,
        engine="eigen",
        parameters={"propeller1.mass": 0.02, "motorpid.maxVelocity": 800},
    )
    assert list(comparison.table["failure"]) == [""] * 4
    assert list(comparison.table["xacro.heavy"]) == [1, 1, 1.5, 1.5]


def test_flights_of_such_plans_are_the_same_anywhere(model):
    plan = qc.FlightPlan.of(model, parameters={"frame.mass": 1.7}, duration=0.01)
    assert plan.fingerprint() != qc.FlightPlan.of(model, duration=0.01).fingerprint()
    assert plan.fly().table.shape == (11, 18)


@pytest.mark.parametrize(
    ("parameters", "says"),
    [
        ({"frame.mass": "heavy"}, "set frame.mass: 'heavy' is not a finite number"),
        ({"frame.mass": -1}, "set frame.mass: .*mass"),
        ({"fram.mass": 1}, "set fram.mass: the model has no plugin 'fram'"),
        (
            {"frame.mas": 1},
            r"set frame.mas: link 'frame' has no value 'mas'\. Did you mean 'mass'\?",
        ),
        ({"frame.size": 1}, "set frame.size: link 'frame' has no value 'size'. Set one of mass, "),
        ({"xacro.heavy": 1}, "takes no xacro arguments"),
    ],
)
def test_what_does_not_exist_is_refused(parameters, says, model):
    with pytest.raises(qc.InputError, match=says):
        qc.Simulation(model, parameters=parameters)


def test_a_link_without_inertia_has_none_to_change(tmp_path):
    path = tmp_path / "massless.urdf"
    camera = (
        '<link name="camera"/><joint name="c" type="fixed"><parent link="frame"/>'
        '<child link="camera"/></joint></robot>'
    )
    path.write_text(vehicle(air=AIR, motor=MOTOR).replace("</robot>", camera))
    with pytest.raises(qc.InputError, match=r"set camera\.mass: the link has no such <inertial>"):
        qc.Simulation(path, parameters={"camera.mass": 0.1})


def test_a_name_that_two_go_by_is_refused_with_both(tmp_path):
    path = tmp_path / "twins.urdf"
    path.write_text(vehicle(air=AIR, motor=MOTOR).replace('name="motorpid"', 'name="frame"'))
    with pytest.raises(qc.InputError, match="'frame' is the name of a link and of a plugin"):
        qc.Simulation(path, parameters={"frame.mass": 1})
    assert qc.Simulation(path, parameters={"frame.kp": 4e-4}).mass == 1.04  # no link has one


def test_a_plugin_called_xacro_is_refused_where_arguments_are_given(xacro_model):
    xacro_model.write_text(xacro_model.read_text().replace('name="motorpid"', 'name="xacro"'))
    says = "'xacro' is the name of the arguments of xacro and of a plugin"
    with pytest.raises(qc.InputError, match=says):
        qc.Simulation(xacro_model, parameters={"xacro.heavy": 2})


def test_an_argument_comes_once(xacro_model):
    with pytest.raises(qc.InputError, match="is also given as a xacro argument"):
        qc.Simulation(xacro_model, parameters={"xacro.heavy": 2}, xacro_args={"heavy": 3})


def test_a_model_that_is_read_takes_values_of_links_but_no_arguments(model):
    read = qc.read_model(model)
    assert qc.Simulation(read, parameters={"frame.mass": 2}).mass == pytest.approx(2.04)
    assert read.links[0].mass == 1.3
    with pytest.raises(qc.InputError, match="the model has already been read"):
        qc.Simulation(read, parameters={"xacro.heavy": 2})


def test_a_tag_that_goes_by_two_names_is_set_by_one_of_them(capsys):
    both = {"odometry.updateRate": 100, "odometry.rate": 50}
    says = "set odometry.updateRate: plugin 'odometry': is the same tag as <rate>, which is also"
    for make in (qc.Simulation, qc.BatchSimulation):
        with pytest.raises(qc.InputError, match=says):
            make(parameters=both)
    given = [word for name, value in both.items() for word in ("--set", f"{name}={value}")]
    assert main(["info", "quadrotor", *given]) == 2
    assert capsys.readouterr().err.startswith(f"error: {says}")
    assert main(["info", "quadrotor", *given[:2]]) == 0
