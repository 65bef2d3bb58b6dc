"""Commands that list, check and copy; JSON; and what is taken from folders and files."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from test_player import contents_of

import quadcore as qc
from quadcore.cli import doctor, list_names, main

HOVER = ["run", "quadrotor", "--engine", "eigen", "--duration", "0.05", "--quiet"]
MINE = """
class Fixed:
    rate = 100

    def reset(self, simulation):
        self.speeds = simulation.hover_speed

    def __call__(self, t, state, reference):
        return self.speeds
"""


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path, monkeypatch):
    """Run every test in a folder of its own."""
    monkeypatch.chdir(tmp_path)


def run_main(capsys, *words):
    assert main(words) == 0
    return capsys.readouterr().out


def refusal(capsys, *words):
    assert main(words) == 2
    return capsys.readouterr().err


@pytest.mark.parametrize("kind", list_names.KINDS)
def test_list_prints_names_that_other_commands_take(kind, capsys):
    entries = json.loads(run_main(capsys, "list", kind, "--json"))
    names = [entry["name"] for entry in entries]
    assert [line.split()[0] for line in run_main(capsys, "list", kind).splitlines()] == names
    examples = {
        "models": "hummingbird", "worlds": "basic", "scenarios": "gusty",
        "controllers": "geometric", "references": "spiral", "engines": "gazebo11",
    }  # fmt: skip
    assert examples[kind] in names


def test_list_has_the_parameters_of_controllers(capsys):
    entries = json.loads(run_main(capsys, "list", "controllers", "--json"))
    (geometric,) = (entry for entry in entries if entry["name"] == "geometric")
    assert "kp_xy" in [parameter["name"] for parameter in geometric["parameters"]]


def test_info_without_a_model_lists_the_models(capsys):
    assert run_main(capsys, "info") == run_main(capsys, "list", "models")
    assert "--set requires a MODEL. Name one." in refusal(capsys, "info", "--set", "frame.mass=1")


def test_info_as_json_holds_what_the_simulation_has(capsys):
    found = json.loads(run_main(capsys, "info", "quadrotor", "--set", "frame.mass=2", "--json"))
    simulation = qc.Simulation("quadrotor", parameters={"frame.mass": 2})
    assert found["mass"] == simulation.mass and found["inertia"] == simulation.inertia.tolist()
    plugins = {plugin["name"]: plugin for plugin in found["plugins"]}
    assert {"name", "value", "unit"} <= set(plugins["drone_plugin"]["parameters"][0])


def test_run_as_json_holds_the_result_and_the_files(capsys):
    words = [*HOVER[:-1], "--controller", "geometric", "--out", "out", "--json"]
    found = json.loads(run_main(capsys, *words))
    assert (found["model"], found["engine"], found["steps"]) == ("quadrotor", "eigen", 50)
    assert found["max_error"] < 0.1 and found["controller"] == "geometric"
    assert "out/report.html" in found["files"]
    assert all(Path(file).exists() for file in found["files"])


def test_validate_as_json_holds_each_flight(capsys):
    words = ["validate", "--engine", "eigen", "--sim-slow", "1", "--drag", "none", "--json"]
    found = json.loads(run_main(capsys, *words, "--duration", "0.1"))
    (flight,) = found["flights"]
    assert flight["failure"] == "" and flight["max"]["distance"] < 1e-3


def test_examples_are_copied_and_never_over_others(capsys):
    written = run_main(capsys, "examples", "here")
    assert written.splitlines() == [
        f"written here/{name}" for name in ("notebooks", "examples", "config")
    ]
    for file in ("examples/spiral.py", "config/spiral.yaml", "notebooks/tuning_a_controller.py"):
        assert Path("here", file).is_file()
    Path("here/config/spiral.yaml").write_text("mine")
    assert "here/notebooks: exists already" in refusal(capsys, "examples", "here")
    assert Path("here/config/spiral.yaml").read_text() == "mine"
    Path("other/config").mkdir(parents=True)
    assert "other/config: exists already" in refusal(capsys, "examples", "other")
    assert os.listdir("other") == ["config"]


def test_doctor_prints_every_check_with_its_remedy(capsys, monkeypatch):
    checks = [check for check in doctor._CHECKS if check is not doctor._check_quadcore]
    monkeypatch.setattr(doctor, "_CHECKS", checks)
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", "/nowhere")
    assert "error: wrong: plugin folder" in refusal(capsys, "doctor")
    monkeypatch.delenv("QUADCORE_PLUGIN_PATH")
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("CXX", raising=False)
    found = json.loads(run_main(capsys, "doctor", "--json"))
    states = {finding["what"]: finding for finding in found}
    assert states["engine gazebo11"]["state"] == states["numpy"]["state"] == "ok"
    assert states["C++ compiler"]["state"] == "absent"
    assert "apt install g++" in states["C++ compiler"]["text"]


def test_doctor_and_the_installation_page_list_every_extra():
    root = Path(__file__).resolve().parents[2]
    lines = (root / "pyproject.toml").read_text().partition("[project.optional-dependencies]")[2]
    extras = set(re.findall(r"^(\w+) = \[", lines.partition("\n[")[0], re.MULTILINE))
    extras -= {"docs", "test"}
    assert {extra for extra, _ in doctor._OPTIONAL.values()} == extras - {"all"}
    page = (root / "docs/install.md").read_text()
    assert set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)) == extras


def test_doctor_finds_damaged_packages_and_missing_ones(tmp_path, monkeypatch):
    (tmp_path / "broken.py").write_text("raise RuntimeError('built for numpy 1')")
    monkeypatch.syspath_prepend(tmp_path)
    assert doctor._try_import("broken", "absent", "remedy").state == "wrong"
    missing = doctor._try_import("no_such_module", "absent", "pip install it")
    assert missing == ("no_such_module", "absent", "pip install it")


def test_doctor_finds_a_second_quadcore(tmp_path, monkeypatch):
    (tmp_path / "quadcore").mkdir()
    (tmp_path / "quadcore" / "__init__.py").write_text("")
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    (wrong,) = (finding for finding in doctor._check_quadcore() if finding.state == "wrong")
    assert str(tmp_path / "quadcore") in wrong.text and "Remove one" in wrong.text


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_prints_code_for_each_shell(shell, capsys):
    assert "_ARGCOMPLETE" in run_main(capsys, "completion", shell)


@pytest.mark.parametrize(
    ("line", "word"),
    [
        ("quadcore eval", "evaluate"),
        ("quadcore run hummin", "hummingbird"),
        ("quadcore run quadrotor --scen", "--scenario"),
        ("quadcore run quadrotor --controller geo", "geometric"),
        ("quadcore run quadrotor --engine eig", "eigen"),
        ("quadcore list wor", "worlds"),
    ],
)
def test_commands_options_and_names_are_completed(line, word):
    environment = {
        **os.environ,
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_IFS": "\n",
        "_ARGCOMPLETE_STDOUT_FILENAME": "completions",
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
    }
    subprocess.run([sys.executable, "-m", "quadcore"], env=environment, check=True)
    assert word in [found.strip() for found in Path("completions").read_text().splitlines()]


def test_play_and_plot_take_folders_that_run_wrote(capsys):
    for model in ("quadrotor", "hexarotor"):
        words = ["--controller", "geometric", "--no-plots", "--out", f"out/{model}"]
        assert main([HOVER[0], model, *HOVER[2:], *words]) == 0
    assert run_main(capsys, "play", "out/quadrotor", "-o", "one.html") == "written one.html\n"
    # The rotors are those of each vehicle.
    main(["play", "out/quadrotor", "out/hexarotor", "-o", "both.html"])
    page = Path("both.html").read_text()
    assert '"name": "quadrotor"' in page and '"name": "hexarotor"' in page
    (content,) = contents_of(page)
    for model, vehicle in zip(("quadrotor", "hexarotor"), content["vehicles"]):
        poses = [np.reshape(body["pose"], (4, 4)) for body in vehicle["bodies"][1:]]
        places = qc.read_model(model).joint_places
        assert np.allclose([pose[:3, 3] for pose in poses], places, atol=1e-9)
    main(["plot", "out/quadrotor", "--out", "plots"])
    assert Path("plots/position.png").exists()
    Path("empty").mkdir()
    assert "empty: holds neither log.csv nor logs/" in refusal(capsys, "play", "empty")


def test_play_takes_folders_of_comparisons(capsys):
    vary = ["--vary", "frame.mass=1,1.1", "--duration", "0.05", "--quiet", "--no-plots"]
    main(["compare", "quadrotor", *vary, "--controller", "geometric", "--out", "out"])
    words = ("play", "out", "--names", "a,b", "-o", "page.html")
    assert run_main(capsys, *words) == "written page.html\n"


def test_a_log_is_not_played_with_the_model_of_another_vehicle(capsys):
    main([*HOVER, "--controller", "geometric", "--no-plots", "--out", "out"])
    for log in ("out", "out/log.csv"):
        error = refusal(capsys, "play", log, "--model", "iris")
        assert "is a flight of 'quadrotor', but --model iris is 'iris'. Leave --model out" in error
    assert main(["play", "out", "--model", "quadrotor", "-o", "page.html"]) == 0
    Path("out/run.json").write_text("{")
    assert "out/run.json: is not JSON" in refusal(capsys, "play", "out")


def test_run_describes_the_flight_in_its_folder():
    words = [*HOVER, "--seed", "3", "--world", "basic", "--set", "frame.mass=2", "--out", "out"]
    main([*words, "--controller", "geometric"])
    found = json.loads(Path("out/run.json").read_text())
    expected = {"model": "quadrotor", "engine": "eigen", "seed": 3, "world": "basic"}
    assert expected.items() <= found.items()
    assert {"quadcore", "date", "host"} <= set(found)
    assert found["command"].startswith("quadcore run quadrotor ")
    assert qc.Simulation("out/model.urdf").mass == qc.Simulation(parameters={"frame.mass": 2}).mass
    page = Path("out/report.html").read_text()
    assert (
        "--seed 3 --world basic" in page and "Tracking error" in page and "quadcore-player" in page
    )


@pytest.mark.parametrize(
    "text", ["mine.py", "mine.py:Fixed", "sub/mine.py", "sub/mine.py:Fixed", "mine:Fixed"]
)
def test_a_controller_is_taken_from_a_file(text, capsys):
    Path("sub").mkdir()
    for folder in ("", "sub"):
        Path(folder, "mine.py").write_text(MINE)
    out = run_main(capsys, *HOVER[:-1], "--controller", text)
    assert f"{text}, 100 Hz" in out
    evaluate = ["evaluate", "--reference", "hover", "--duration", "0.05", "--quiet"]
    assert main([*evaluate, "--controller", f"{text},geometric:kp_z=9"]) == 0


def test_a_function_is_a_controller_and_helpers_next_to_it_are_found(capsys):
    Path("sub").mkdir()
    Path("sub/helper.py").write_text("SPEEDS = [471, -471, 471, -471]\n")
    law = "from helper import SPEEDS\ndef law(t, state, reference):\n    return SPEEDS\n"
    Path("sub/law.py").write_text(f"{law}def _hidden(a, b, c): ...\ndef other(a): ...\n")
    assert "sub/law.py, 500 Hz" in run_main(capsys, *HOVER[:-1], "--controller", "sub/law.py")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("none.py", "none.py: cannot be read"),
        ("two.py", "two.py has 2 controllers. Name one: two.py:A, two.py:B."),
        ("empty.py", "empty.py has 0 controllers. Define a class or function"),
        ("two.py:C", "two.py has no 'C'"),
        ("bad.py", "ZeroDivisionError: division by zero"),
    ],
)
def test_a_file_without_one_controller_is_refused(text, reason, capsys):
    two = "class A:\n    def __call__(self, t, state, reference): ...\nclass B(A): ...\n"
    for name, content in {"two": two, "empty": "", "bad": "1 / 0"}.items():
        Path(f"{name}.py").write_text(content)
    assert reason in refusal(capsys, *HOVER, "--controller", text)


def test_a_constant_wind_blows_like_that_of_a_scenario():
    Path("windy.yaml").write_text("plugins: {wind: {velocity: [3, 0, 0.5]}}\n")
    words = [*HOVER, "--set", "drone_plugin.dragModel=chapter2", "--controller", "pd"]
    winds = {"none": [], "wind": ["--wind", "3,0,0.5"], "scenario": ["--scenario", "windy.yaml"]}
    for name, wind in winds.items():
        assert main([*words, *wind, "--log", f"{name}.csv"]) == 0
    none, wind, scenario = (Path(f"{name}.csv").read_bytes() for name in winds)
    assert wind == scenario != none
    # It replaces the mean wind of a scenario.
    assert main([*words, "--scenario", "windy.yaml", "--wind", "0 0 0", "--log", "still.csv"]) == 0
    assert Path("still.csv").read_bytes() == none


def test_a_constant_wind_blows_in_studies():
    tags = {"drone_plugin.dragModel": "chapter2"}
    options = {"parameters": tags, "duration": 0.5}
    still, windy = (
        qc.evaluate("pd", "hover", wind=wind, **options).table[0]["rms_position"]
        for wind in (None, (3, 0, 0))
    )
    assert windy > 2 * still
    with pytest.raises(qc.InputError, match=r"wind is \(3, 0\). Give three numbers"):
        qc.evaluate("pd", "hover", wind=(3, 0))


def test_a_spawn_may_be_written_with_spaces():
    for name, spawn in {"a": "0 0 1", "b": "0,0,1", "c": "0, 0, 1"}.items():
        assert main([*HOVER, "--spawn", spawn, "--log", f"{name}.csv"]) == 0
    assert len({Path(f"{name}.csv").read_bytes() for name in "abc"}) == 1


STUDIES = {
    "evaluate": ["evaluate", "--controller", "pd", "--reference", "hover"],
    "compare": ["compare", "quadrotor", "--controller", "pd", "--vary", "frame.mass=1,1.1"],
    "sweep": ["sweep", "--controller", "pd", "--reference", "hover"],
    "run": ["run", "quadrotor", "--controller", "pd"],
}


@pytest.mark.parametrize("study", STUDIES)
def test_a_study_replaces_its_own_results_and_nothing_else(study, capsys):
    words = [*STUDIES[study], "--duration", "0.05", "--quiet", "--no-plots"]
    Path("foreign").mkdir()
    Path("foreign/report.html").write_text("mine")
    error = refusal(capsys, *words, "--out", "foreign")
    assert "foreign/report.html: was not written by this command. Move it" in error
    assert [path.name for path in Path("foreign").iterdir()] == ["report.html"]
    assert main([*words, "--out", "out"]) == 0
    Path("out/mine.txt").write_text("mine")
    assert main([*words, "--seed", "1", "--out", "out"]) == 0
    assert Path("out/mine.txt").read_text() == "mine"
    table = Path("out", "log.csv" if study == "run" else "table.csv")
    assert table.stat().st_size > 0


def test_an_unfinished_sweep_is_neither_replaced_nor_lost(capsys):
    words = [*STUDIES["sweep"], "--duration", "0.05", "--quiet", "--no-plots", "--out", "out"]
    assert main(words) == 0
    rows = Path("out/table.csv").read_bytes()
    Path("out/sweep.json").unlink()  # is written last
    Path("out/run.json").unlink()
    Path("out/report.html").unlink()
    assert "contains rows. Add --resume" in refusal(capsys, *words)
    assert Path("out/table.csv").read_bytes() == rows
    assert main([*words, "--resume"]) == 0
