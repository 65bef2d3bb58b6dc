"""Gains files."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest
from flights import quadrotor
from hooked import G
from test_controller_plugin import guide

import quadcore as qc
from quadcore.control import controllers, gains, references

SHIPPED = sorted((Path(__file__).resolve().parents[2] / "config" / "gains").glob("*/*.yaml"))


def write_gains(tmp_path, text):
    path = tmp_path / "gains.yaml"
    path.write_text(text)
    return path


def test_what_is_written_is_read_again(tmp_path):
    given = gains.Gains("lqr", "odd", 230.5, 0.0131, {"q_tilt": 1e-7, "lead": 0.0})
    gains.write(given, tmp_path / "a.yaml")
    assert gains.read(tmp_path / "a.yaml") == given
    gains_given = gains.Gains("pd", history=[{"cost": 0.1, "accepted": True}])
    gains.write(gains_given, tmp_path / "b.yaml")
    assert gains.read(tmp_path / "b.yaml") == gains.Gains("pd")
    assert "accepted: true" in (tmp_path / "b.yaml").read_text()


def test_numbers_are_read_as_people_write_them(tmp_path):
    path = write_gains(
        tmp_path, "law: geometric\nparameters:\n  kp_xy: 1e1\n  drag: false\n  ki_z: .5\n"
    )
    assert gains.read(path).parameters == {"kp_xy": 10, "drag": 0, "ki_z": 0.5}


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("law: geometrik\n", 1, "Did you mean 'geometric'"),
        ("rate: 500\n", 1, "no controller is named. Write `law: NAME`"),
        ("law: pd\nrates: 5\n", 2, "unknown key 'rates'.*Did you mean 'rate'"),
        ("law: pd\nlaw: pid\n", 2, "'law' is repeated. Keep one of them"),
        ("law: pd\nrate: fast\n", 2, "'rate' is 'fast'. Write a number"),
        ("law: pd\nrate: 0\n", 2, "'rate' is 0. Give a finite number >= 1e-06"),
        ("law: pd\ndelay: -1\n", 2, "'delay' is -1. Give a finite number >= 0, <= 10"),
        ("law: pd\nparameters:\n  kp_xy: 2\n  kp: 3\n", 4, "controller 'pd' has no parameter 'kp'"),
        ("law: pd\nparameters:\n  kp_xy: -2\n", 3, "'kp_xy' is -2. Give a finite number >= 0"),
        ("law: pd\nparameters:\n  drag: 2\n", 3, "'drag' is 2. Give true or false"),
        ("law: pd\nparameters: [1]\n", 2, "'parameters' is a list. Write lines"),
        ("law: pd\nhistory: long\n", 2, "'history' is neither"),
        ("law: pd\nrate: [\n", 3, "invalid YAML"),
        ("- pd\n", 1, "the gains file is a list"),
    ],
)
def test_a_wrong_file_is_one_line_that_tells_where(text, line, says, tmp_path):
    path = write_gains(tmp_path, text)
    with pytest.raises(qc.InputError, match=f"^{path}:{line}: .*{says}") as error:
        gains.read(path)
    assert "\n" not in str(error.value)


def test_a_missing_file_is_reported(tmp_path):
    with pytest.raises(qc.InputError, match=r"no\.yaml: the file cannot be read"):
        controllers.read_controller(tmp_path / "no.yaml")


def test_a_controller_has_the_gains_that_are_shipped_for_the_vehicle():
    own = controllers.read_controller(SHIPPED[0])
    vehicle, controller = SHIPPED[0].parent.name, SHIPPED[0].stem
    assert gains.make_for_vehicle(controller, vehicle).parameters == own.parameters != {}
    assert gains.make_for_vehicle("geometric", "of nobody").parameters == {}
    assert gains.make_for_vehicle("geometric", "..").parameters == {}


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: f"{path.parent.name} {path.stem}")
def test_every_shipped_file_names_its_controller_and_vehicle(path):
    read = gains.read(path)
    assert (read.vehicle, read.law) == (path.parent.name, path.stem)
    assert qc.read_model(read.vehicle).name == read.vehicle


def test_the_plugin_flies_the_gains_of_a_file_and_what_tags_set_wins(tmp_path, hangar):
    path = write_gains(
        tmp_path, "law: geometric\nrate: 250\ndelay: 0.004\nparameters:\n  kp_xy: 7\n  kp_z: 12\n"
    )
    tags = {"law": "geometric", "rate": 250, "delay": 0.004, "kp_xy": 7, "kp_z": 9}
    logs = []
    for controller in (tags, {"gains": path, "kp_z": 9}):
        simulation = hangar(guide(controller), G, engine="eigen", spawn=(1, 0, 10))
        logs.append(simulation.run(0.5))
    assert logs[0].table.tobytes() == logs[1].table.tobytes()


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ({}, "no controller is named. Write <law> or <gains>"),
        (
            {"law": "pd", "gains": "gains.yaml"},
            "<law> is pd, but the gains file .* is for geometric",
        ),
        ({"gains": "gains.yaml", "scale": 2}, "controller 'geometric' has no parameter 'scale'"),
    ],
)
def test_tags_that_contradict_the_file_are_refused(tags, says, tmp_path, hangar):
    write_gains(tmp_path, "law: geometric\n")
    with pytest.raises(qc.InputError, match=says):
        hangar(guide(tags), G)


def test_a_controller_of_a_file_runs_at_its_rate(tmp_path):
    path = write_gains(tmp_path, "law: geometric\nrate: 100\nparameters:\n  kp_xy: 7\n")
    controller = controllers.read_controller(path)
    assert (controller.rate, controller.delay) == (100, 0)
    hover = references.hover(x=0.1)
    one = quadrotor("eigen").run(0.5, controller=controller, reference=hover)
    other = quadrotor("eigen").run(
        0.5, controller=controllers.geometric(rate=100, kp_xy=7), reference=hover
    )
    assert one.table.tobytes() == other.table.tobytes()


def test_gains_of_another_vehicle_are_warned_of(tmp_path):
    path = write_gains(tmp_path, "law: geometric\nvehicle: hexarotor\n")
    with pytest.warns(qc.QuadcoreWarning, match="for 'hexarotor', but 'quadrotor' uses them"):
        controllers.parse(str(path), "quadrotor")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        controllers.parse(str(path), "hexarotor")
        controllers.parse(str(write_gains(tmp_path, "law: geometric\n")), "quadrotor")


def test_a_slowest_speed_that_no_rotor_attains_is_refused():
    sim = quadrotor("eigen", parameters={"motorpid_plugin.maxVelocity": 1e9})
    with pytest.raises(qc.InputError, match="'slowest' is not below the maximum speed"):
        sim.run(0.01, controller=controllers.geometric(slowest=2e6), reference="hover")
