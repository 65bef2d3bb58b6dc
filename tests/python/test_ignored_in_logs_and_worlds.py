"""What of a world made for Gazebo is passed over, and what logs and commands tell of it."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from faults import MODEL, PUSHER, UNFELT, WORLD, at, refusal

import quadcore as qc
from quadcore.cli import main

SCENERY = (
    "<gui/>\n<scene><sky/></scene>\n<light name='sun'/>\n"
    "<audio/>\n"
    "<plugin name='ros' filename='librotors_gazebo_ros_interface_plugin.so'><a><b/></a></plugin>\n"
)


def test_what_nothing_feels_of_a_world_is_named_in_one_warning(flown):
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = flown(world=SCENERY).warnings
    assert warning.startswith(f"{UNFELT}<gui> ({at('toy.world', '<gui')}), <scene> (toy.world:")
    for name in ("<light>", "<audio>", "librotors_gazebo_ros"):
        assert f", {name}" in warning


STORM = '<plugin name="storm" filename="libstorm.so"><force>1</force></plugin>'
WIND = '<plugin name="wind" filename="libWindPlugin.so"/>'
HOUSE = "<include><uri>model://house</uri><pose>1 0 0 0 0 0</pose></include>"
WALL = (
    '<model name="wall"><static>0</static><pose>1 0 0 0 0 0</pose><link name="a">'
    "<kinematic>1</kinematic>"
    '<collision name="b"><surface/><geometry><box/></geometry></collision></link></model>'
)


@pytest.mark.parametrize(
    ("foreign", "names"),
    [(WIND, ["libWindPlugin.so", "wind"]), (WALL, ["wall"])],
    ids=["plugin", "model"],
)
def test_what_is_foreign_in_a_world_is_left_out_on_request(flown, foreign, names):
    message = refusal(flown, world=foreign)
    assert message.startswith(at("toy.world", foreign[:9]))
    assert message.count("--ignore") == 1 and message.endswith(f"--ignore {names[0]}.")
    for name in names:
        assert flown(world=foreign, ignore=[name]).ignored == [name]


@pytest.mark.parametrize(("model", "name"), [(HOUSE, "model://house"), (WALL, "wall")])
def test_a_flight_without_an_obstacle_of_its_world_says_so(flown, capsys, model, name):
    missing = f"the vehicle passes through {name}, because"
    with pytest.warns(qc.QuadcoreWarning, match=missing):
        simulation = flown(world=model, ignore=[name])
    assert simulation.world.ignored_models == [name]
    command = ["run", "toy.urdf", "--world", "toy.world", "--duration", "0.01", "--no-plots"]
    assert main([*command, "--ignore", name, "--out", "out"]) == 0
    shown = capsys.readouterr()
    assert missing in shown.err
    assert f"{name}: the vehicle passes through" in shown.out
    assert f"{name}: the vehicle passes through" in Path("out/report.html").read_text()
    assert json.loads(Path("out/run.json").read_text())["ignore"] == [name]
    assert f"# ignored: {name}" in Path("out/log.csv").read_text()


HILL = (
    '<model name="hill"><static>1</static>{}<link name="a"><collision name="b">{}'
    "<geometry><{}</geometry></collision></link></model>"
)
PATCH = (
    "<surface><friction><torsional><patch_radius>1</patch_radius></torsional></friction></surface>"
)
UNSIMULATED = {
    "a plugin of the world": (STORM, "libstorm.so"),
    "a plugin of a model": (HILL.format(STORM, "", "box/>"), "libstorm.so of hill"),
    "a missing model": (HOUSE, "the missing model model://house"),
    "an include without uri": ("<include/>", "an <include> without <uri>"),
    "a heightmap": (HILL.format("", "", "heightmap/>"), "the heightmap of hill"),
    "a missing mesh": (
        HILL.format("", "", "mesh><uri>model://hill/a.dae</uri></mesh>"),
        "the missing mesh model://hill/a.dae of hill",
    ),
    "torsional friction": (HILL.format("", PATCH, "box/>"), "torsional friction of hill"),
    "rescaled inertia": (
        '<physics default="1"><ode><solver><use_dynamic_moi_rescaling>1</use_dynamic_moi_rescaling>'
        "</solver></ode></physics>",
        "use_dynamic_moi_rescaling",
    ),
}


@pytest.mark.parametrize(("world", "name"), UNSIMULATED.values(), ids=UNSIMULATED)
def test_what_gazebo_would_simulate_is_named_wherever_a_flight_is_shown(flown, capsys, world, name):
    said = "not simulated, though it may affect the motion: "
    with pytest.warns(qc.QuadcoreWarning, match=said):
        simulation = flown(world=world)
    place = at("toy.world", "<use_dyn" if "dyn" in name else world[:9])
    assert f"{said}{name} ({place}" in "".join(simulation.warnings)
    assert simulation.world.ignored_elements.unsimulated == [name]
    assert simulation.ignored == [name]
    command = ["run", "toy.urdf", "--world", "toy.world", "--duration", "0.01", "--no-plots"]
    assert main([*command, "--out", "out"]) == 0
    shown = capsys.readouterr()
    assert said in shown.err
    assert "not simulated" in shown.out and name.split(" ")[-1] in shown.out
    assert "not simulated" in Path("out/report.html").read_text()
    assert json.loads(Path("out/run.json").read_text())["unsimulated"] == [name]
    assert f"# ignored: {name}" in Path("out/log.csv").read_text()


@pytest.mark.parametrize(
    "command",
    ["evaluate --controller geometric --reference hover --engine eigen", "compare other.urdf"],
)
def test_the_pages_of_studies_name_what_is_not_simulated(toy, command):
    (toy / "toy.world").write_text(WORLD.replace("  </world>", f"{HOUSE}</world>"))
    flight = ["--world", "toy.world", "--duration", "0.1", "--out", "out", "--no-plots"]
    name, *options = command.split()
    (toy / "other.urdf").write_text(MODEL)
    models = ["toy.urdf"] if name == "compare" else []
    assert main([name, *models, *options, *flight]) == 0
    page = next(Path("out").glob("*.html")).read_text()
    assert "the missing model model://house" in page


def test_what_a_world_makes_felt_is_refused_whatever_is_to_be_ignored(flown):
    solver = "<ode><solver><friction_model>cone_model</friction_model></solver></ode>"
    message = refusal(flown, world=f'<physics default="1">{solver}</physics>')
    assert "<friction_model> is 'cone_model'" in message and "--ignore" not in message


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


def test_pandas_reads_such_a_log_with_its_comments(log, tmp_path):
    pandas = pytest.importorskip("pandas")
    log.to_csv(tmp_path / "log.csv")
    table = pandas.read_csv(tmp_path / "log.csv", comment="#")
    # Its own reader of numbers may miss the last bit.
    np.testing.assert_allclose(table.to_numpy(), log.table, rtol=1e-15, atol=0)
    assert list(table.columns) == log.columns


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
    assert "Did you mean 'pusher'?" in capsys.readouterr().err


def test_a_gazebo_file_is_expanded_and_its_lines_are_named(toy):
    sensor = '<gazebo reference="${part}">\n<sensor name="eye" type="camera"/></gazebo>'
    (toy / "toy.gazebo").write_text(
        MODEL.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ').replace(
            "</robot>", f'<xacro:property name="part" value="frame"/>{sensor}</robot>'
        )
    )
    with pytest.warns(qc.QuadcoreWarning):
        (warning,) = qc.Simulation("toy.gazebo").warnings
    assert warning == f"{UNFELT}<sensor> ({at('toy.gazebo', '<sensor')})."
