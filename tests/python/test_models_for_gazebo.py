"""Models made for Gazebo: what is only sensed is passed over, what is foreign is if asked."""

from __future__ import annotations

import csv
import io
import shutil
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from faults import MODEL, WORLD, refusal

import quadcore as qc
from quadcore.cli import main

PUSHER = '<plugin name="pusher" filename="libpusher.so"><force>1<n>2</n></force></plugin>'
UNFELT = "passed over, since nothing that flies feels it: "


@pytest.fixture
def flown(toy):
    """Maker of simulations of the toy with more in its model's end, or its world's."""

    def make(more="", world="", **options):
        (toy / "toy.urdf").write_text(MODEL.replace("</robot>", f"{more}</robot>"))
        (toy / "toy.world").write_text(WORLD.replace("  </world>", f"{world}</world>"))
        return qc.Simulation("toy.urdf", world="toy.world", **options)

    return make


def at(name, part):
    """FILE:LINE of the first line of a written file that holds a part."""
    text = Path(name).read_text()
    return f"{name}:{1 + text.count(chr(10), 0, text.index(part))}"


def test_what_is_sensed_is_named_in_one_warning_with_its_lines(flown):
    with pytest.warns(qc.QuadcoreWarning, match="nothing that flies feels it"):
        simulation = flown(
            '<gazebo reference="propeller"><material>Red</material>\n'
            '<sensor name="eye" type="camera"><pose>1 2 3</pose><plugin filename="libx.so"/>'
            "</sensor></gazebo>\n"
            '<transmission name="a"><type>T</type></transmission>\n'
            '<properties kf="1e-9"/>\n'
            '<transmission name="b"/>\n'
            '<gazebo>\n<plugin name="odometry" filename="libgazebo_ros_p3d.so">of its own'
            "<ros><topic>x</topic></ros></plugin></gazebo>"
        )
    (warning,) = simulation.warnings
    first, second = (at("toy.urdf", f'<transmission name="{name}"') for name in "ab")
    assert warning == (
        f"{UNFELT}<transmission> ({first}, {second}), "
        f"<properties> ({at('toy.urdf', '<properties')}), "
        f"<sensor> ({at('toy.urdf', '<sensor')}), "
        f"libgazebo_ros_p3d.so ({at('toy.urdf', 'libgazebo_ros_p3d')})"
    )
    simulation.step(3)


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('<link name="frame">', '<link name="frame"><pose>0 0 1</pose>', "<pose>"),
        ("<collision>", "<collision><max_contacts>4</max_contacts>", "<max_contacts>"),
        ("<gazebo>", "<gazebo><provideFeedback>1</provideFeedback>", "<provideFeedback>"),
        ("<robot ", '<robot xsi:schemaLocation="a b" ', "attribute xsi:schemaLocation"),
        ('<link name="mount"/>', '<link name="mount"/>-->', "text in <robot>"),
    ],
)
def test_what_gazebo_passes_over_is_passed_over(toy, old, new, what):
    (toy / "toy.urdf").write_text(MODEL.replace(old, new, 1))
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = qc.Simulation("toy.urdf").warnings
    assert warning == f"{UNFELT}{what} ({at('toy.urdf', new)})"


def test_the_motion_is_that_without_what_is_sensed(flown):
    states = []
    for more in ("", '<gazebo reference="frame"><sensor name="eye" type="camera"/></gazebo>'):
        simulation = flown(more)
        simulation.command([300])
        simulation.step(200)
        states.append(simulation.state.copy())
    assert np.array_equal(states[0].position, states[1].position)
    assert np.array_equal(states[0].rotor_velocity, states[1].rotor_velocity)


def test_a_module_that_is_there_is_loaded_whatever_gazebo_makes_of_its_name(toy, monkeypatch):
    own = Path(qc.plugin_folders()[-1]) / "libodometry_plugin.so"
    shutil.copy(own, toy / "libgazebo_ros_p3d.so")
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(toy))
    (toy / "toy.urdf").write_text(MODEL.replace("libodometry_plugin.so", "libgazebo_ros_p3d.so"))
    simulation = qc.Simulation("toy.urdf")
    assert simulation.warnings == []
    assert simulation.plugins[2].path == str(toy / "libgazebo_ros_p3d.so")


def test_a_foreign_module_is_refused_with_its_remedy(flown):
    message = refusal(flown, f"\n<gazebo>{PUSHER}</gazebo>")
    assert message.startswith(f"{at('toy.urdf', 'pusher')}: plugin 'pusher': libpusher.so was not")
    assert message.endswith("; to fly without it: --ignore libpusher.so")


@pytest.mark.parametrize("name", ["pusher", "libpusher.so"])
def test_a_foreign_module_is_left_out_by_its_name_or_file_whatever_it_holds(flown, name):
    simulation = flown(f"<gazebo>{PUSHER}</gazebo>", ignore=[name])
    assert simulation.ignored == [name]
    assert [plugin.name for plugin in simulation.plugins] == ["air", "motor", "odometry"]
    assert simulation.warnings == []


def test_one_file_name_leaves_out_every_plugin_of_that_module(flown):
    more = "".join(f"<gazebo>{PUSHER.replace('pusher', name, 1)}</gazebo>" for name in "ab")
    assert flown(more, ignore=["libpusher.so"]).ignored == ["libpusher.so"]
    assert "plugin 'b': libpusher.so was not found" in refusal(flown, more, ignore=["a"])


def test_two_plugins_may_share_a_name_if_one_is_left_out(flown):
    more = f"<gazebo>{PUSHER.replace('pusher', 'motor', 1)}</gazebo>"
    assert len(flown(more, ignore=["libpusher.so"]).plugins) == 3


def test_a_plugin_that_is_left_out_takes_no_values(flown):
    message = refusal(
        flown, f"<gazebo>{PUSHER}</gazebo>", ignore=["pusher"], parameters={"pusher.force": 1}
    )
    assert "the model has no plugin 'pusher'" in message


def test_a_misspelt_library_names_the_right_one(toy):
    (toy / "toy.urdf").write_text(MODEL.replace("libodometry_", "libodometri_"))
    message = refusal(qc.Simulation, "toy.urdf")
    assert " (did you mean 'libodometry_plugin.so'?); correct the filename" in message
    (toy / "toy.urdf").write_text(MODEL.replace("libodometry_plugin", "librotors_gazebo_motor"))
    assert "did you mean" not in refusal(qc.Simulation, "toy.urdf")


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("</robot>", "<frame/></robot>", "frame"),
        ('<link name="mount"/>', '<link name="mount"><hook><a/></hook></link>', "hook"),
        ("<dynamics", "<calibration/><dynamics", "calibration"),
        ("<gazebo>", "<gazebo><static>1</static>", "static"),
    ],
)
def test_a_foreign_element_is_left_out_on_request(toy, old, new, name):
    (toy / "toy.urdf").write_text(MODEL.replace(old, new, 1))
    message = refusal(qc.Simulation, "toy.urdf")
    assert message.startswith(at("toy.urdf", f"<{name}")) and f"<{name}> in <" in message
    assert message.endswith(f"; to fly without it: --ignore {name}")
    assert qc.Simulation("toy.urdf", ignore=[name]).ignored == [name]


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("<dynamics", '<mimic joint="weld"/><dynamics', "mimic"),
        ("<mass ", '<density value="1"/><mass ', "density"),
        ('type="continuous"', 'type="prismatic"', "rotor"),
        ('    <inertial>\n      <mass value="0.01"/>', "    <inertial>", "mass"),
    ],
)
def test_what_is_felt_is_refused_whatever_is_to_be_ignored(toy, old, new, name):
    (toy / "toy.urdf").write_text(MODEL.replace(old, new, 1))
    message = refusal(qc.Simulation, "toy.urdf")
    assert "--ignore" not in message
    assert refusal(qc.Simulation, "toy.urdf", ignore=[name]) == message


@pytest.mark.parametrize("name", ["pushr", "*", "", "link", "gazebo", "propeller"])
def test_a_name_that_nothing_goes_by_is_refused_and_told_what_there_is(flown, name):
    message = refusal(flown, f"<gazebo>{PUSHER}</gazebo>", ignore=["pusher", name])
    assert message.startswith(f"ignore {name}: nothing goes by that name")
    assert "libpusher.so" in message and "motor" in message
    assert ("did you mean 'pusher'?" in message) == (name == "pushr")


@pytest.mark.parametrize("names", ["pusher", [1], [None]])
def test_names_to_ignore_are_a_list_of_texts(flown, names):
    assert "give a list of names" in refusal(flown, ignore=names)


def test_an_inertia_that_breaks_the_triangle_inequality_warns_and_flies(toy):
    (toy / "toy.urdf").write_text(MODEL.replace('izz="0.04"', 'izz="0.0400002"'))
    for engine in ("gazebo11", "ode", "eigen"):
        with pytest.warns(qc.QuadcoreWarning, match="no rigid body can have"):
            simulation = qc.Simulation("toy.urdf", engine=engine)
        (warning,) = simulation.warnings
        assert warning.startswith(f"{at('toy.urdf', '0.0400002')}: link 'frame' has an inertia")
        simulation.command([300])
        simulation.step(100)
        assert simulation.state.rotor_velocity[0] > 10


def test_a_model_that_nothing_pushes_warns(toy):
    air = MODEL[MODEL.index('    <plugin name="air"') : MODEL.index('    <plugin name="motor"')]
    (toy / "toy.urdf").write_text(MODEL.replace(air, ""))
    with pytest.warns(qc.QuadcoreWarning, match="'toy' has no plugin that reports a force"):
        qc.Simulation("toy.urdf")


def test_a_model_without_rotors_warns(toy):
    (toy / "toy.urdf").write_text(
        '<robot name="stone"><link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" '
        'ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>'
    )
    with pytest.warns(qc.QuadcoreWarning, match="'stone' has no rotors: no joint of it is cont"):
        qc.Simulation("toy.urdf")


SCENERY = (
    "<gui/>\n<scene><sky/></scene>\n<light name='sun'/>\n<spherical_coordinates/>\n"
    "<magnetic_field>1 0 0</magnetic_field>\n"
    "<plugin name='ros' filename='librotors_gazebo_ros_interface_plugin.so'><a><b/></a></plugin>\n"
)


def test_what_nothing_feels_of_a_world_is_named_in_one_warning(flown):
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = flown(world=SCENERY).warnings
    assert warning.startswith(f"{UNFELT}<gui> ({at('toy.world', '<gui')}), <scene> (toy.world:")
    for name in ("<light>", "<spherical_coordinates>", "<magnetic_field>", "librotors_gazebo_ros"):
        assert f", {name}" in warning


STORM = '<plugin name="storm" filename="libstorm.so"><force>1</force></plugin>'
HOUSE = "<include><uri>model://house</uri><pose>1 0 0 0 0 0</pose></include>"
WALL = (
    '<model name="wall"><static>1</static><pose>1 0 0 0 0 0</pose><link name="a">'
    '<collision name="b"><surface/><geometry><box/></geometry></collision></link></model>'
)


@pytest.mark.parametrize(
    ("foreign", "names"),
    [(STORM, ["libstorm.so", "storm"]), (HOUSE, ["model://house"]), (WALL, ["wall"])],
    ids=["plugin", "include", "model"],
)
def test_what_is_foreign_in_a_world_is_left_out_on_request(flown, foreign, names):
    message = refusal(flown, world=foreign)
    assert message.startswith(at("toy.world", foreign[:9]))
    assert message.count("--ignore") == 1 and message.endswith(f"--ignore {names[0]}")
    for name in names:
        assert flown(world=foreign, ignore=[name]).ignored == [name]


def test_what_a_world_makes_felt_is_refused_whatever_is_to_be_ignored(flown):
    message = refusal(flown, world="<wind/>")
    assert "a second <wind>" in message and "--ignore" not in message


@pytest.fixture
def log(flown):
    simulation = flown(f"<gazebo>{PUSHER}</gazebo>", world=STORM, ignore=["libpusher.so", "storm"])
    return simulation.run(0.01)


def test_a_csv_log_tells_below_its_header_what_was_ignored(log, tmp_path):
    log.to_csv(tmp_path / "log.csv")
    first, second, *_ = (tmp_path / "log.csv").read_text().splitlines()
    assert first == ",".join(log.columns)
    assert second == "# ignored: libpusher.so, storm"


def test_the_usual_readers_read_such_a_log(log, tmp_path):
    log.to_csv(tmp_path / "log.csv")
    assert np.array_equal(np.loadtxt(tmp_path / "log.csv", delimiter=",", skiprows=1), log.table)
    named = np.genfromtxt(tmp_path / "log.csv", delimiter=",", names=True)
    assert list(named.dtype.names) == log.columns
    assert np.array_equal(named["z"], log.position[:, 2])
    text = (tmp_path / "log.csv").read_text()
    rows = csv.DictReader(line for line in io.StringIO(text) if not line.startswith("#"))
    assert [float(row["z"]) for row in rows] == log.position[:, 2].tolist()


def test_pandas_reads_such_a_log_when_told_of_comments(log, tmp_path):
    pandas = pytest.importorskip("pandas")
    log.to_csv(tmp_path / "log.csv")
    table = pandas.read_csv(tmp_path / "log.csv", comment="#", float_precision="round_trip")
    assert np.array_equal(table.to_numpy(), log.table)


def test_a_mat_log_holds_what_was_ignored(log, tmp_path):
    log.to_mat(tmp_path / "log.mat")
    names = scipy.io.loadmat(tmp_path / "log.mat")["ignored"]
    assert [str(name[0]) for name in names.ravel()] == ["libpusher.so", "storm"]


def test_a_log_of_a_whole_model_tells_nothing(flown, tmp_path):
    log = flown().run(0.01)
    log.to_csv(tmp_path / "log.csv")
    log.to_mat(tmp_path / "log.mat")
    assert "#" not in (tmp_path / "log.csv").read_text()
    assert "ignored" not in scipy.io.loadmat(tmp_path / "log.mat")


@pytest.fixture
def two(toy):
    """A toy with a foreign module, and one without."""
    (toy / "plain.urdf").write_text(MODEL)
    (toy / "toy.urdf").write_text(MODEL.replace("</robot>", f"<gazebo>{PUSHER}</gazebo></robot>"))
    return toy


def test_every_command_takes_names_to_ignore(two, capsys):
    assert main(["info", "toy.urdf"]) == 2
    assert "--ignore libpusher.so" in capsys.readouterr().err
    ignore = ["--ignore", "libpusher.so"]
    assert main(["info", "toy.urdf", *ignore]) == 0
    assert "ignored: libpusher.so" in capsys.readouterr().out
    flight = ["--duration", "0.05", "--quiet", *ignore]
    assert main(["run", "toy.urdf", *flight, "--log", "log.csv"]) == 0
    assert "# ignored: libpusher.so" in Path("log.csv").read_text()
    assert main(["validate", "toy.urdf", *flight]) != 0
    assert "libpusher" not in capsys.readouterr().err
    twice = ["--ignore", "pusher", "--ignore", "libpusher.so"]
    assert main(["info", "toy.urdf", *twice]) == 0
    assert "ignored: pusher, libpusher.so" in capsys.readouterr().out


def test_of_compared_models_one_may_hold_what_is_ignored(two, capsys):
    command = ["compare", "plain.urdf", "toy.urdf", "--duration", "0.05", "--out", "out"]
    assert main([*command, "--no-plots", "--ignore", "pusher"]) == 0
    assert "# ignored" not in Path("out/logs/1.csv").read_text()
    assert "# ignored: pusher" in Path("out/logs/2.csv").read_text()
    assert "pusher" in Path("out/comparison.json").read_text()
    assert main([*command, "--ignore", "pushr"]) == 2
    assert "did you mean 'pusher'?" in capsys.readouterr().err


def test_a_gazebo_file_is_expanded_and_its_lines_are_named(toy):
    sensor = '<gazebo reference="${part}">\n<sensor name="eye" type="camera"/></gazebo>'
    (toy / "toy.gazebo").write_text(
        MODEL.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ').replace(
            "</robot>", f'<xacro:property name="part" value="frame"/>{sensor}</robot>'
        )
    )
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = qc.Simulation("toy.gazebo").warnings
    assert warning == f"{UNFELT}<sensor> ({at('toy.gazebo', '<sensor')})"
