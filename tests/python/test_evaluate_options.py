"""Options of an evaluation: from files, the command line, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from evaluations import FLY, rows

import quadcore as qc
from quadcore.cli import main, make_parser
from quadcore.cli.options_file import OptionsFile
from quadcore.support.parse import several_calls


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_options_come_from_a_file_and_the_command_line_wins(capsys):
    Path("fly.yaml").write_text(
        "controller: [pd, 'geometric:kp_xy=7,lead=0']\n"
        "reference: circle\n"
        "xacro: {sim_slow: 1}\n"
        "set: {odometry.positionNoise: 0.001}\n"
        "vary:\n  controller.delay: [0, 0.004]\n"
        "duration: 0.5\nseeds: 1\nquiet: true\nno-plots: true\n"
    )
    assert main(["evaluate", "fly.yaml", "--out", "out", "--seeds", "2"]) == 0
    found = rows()
    assert len(found) == 8
    assert found[-1]["controller"] == "geometric:kp_xy=7,lead=0"
    assert found[-1]["scenario"] == "controller.delay=0.004"
    assert {row["seed"] for row in found} == {"0", "1"}


def test_the_command_line_wins_key_by_key_and_lists_hold_what_both_say():
    Path("fly.yaml").write_text(
        "controller: pd\nreference: hover\nduration: 0.1\nengine: [eigen]\n"
        "set: {odometry.positionNoise: 0.001, odometry.orientationNoise: 0.002}\n"
        "xacro: {sim_slow: 10}\nvary: {frame.mass: [1.0, 1.2]}\nignore: [nobody]\n"
        "no-plots: yes\nmargins: false\n"
    )
    given = ["--set", "odometry.positionNoise=0", "--xacro", "sim_slow:=1", "--ignore", "neither"]
    arguments = make_parser().parse_args(["evaluate", "fly.yaml", *given, "--vary", "frame.mass=1"])
    arguments.words = ["evaluate", "fly.yaml", *given, "--vary", "frame.mass=1"]
    both = OptionsFile(Path("fly.yaml"), arguments.parser).put_beneath(arguments)
    assert dict(both.set) == {"odometry.positionNoise": "0", "odometry.orientationNoise": "0.002"}
    assert (both.xacro, both.vary) == ([("sim_slow", "1")], [("frame.mass", "1")])
    assert both.ignore == ["nobody", "neither"]
    assert (both.no_plots, both.margins, both.duration) == (True, False, 0.1)


def test_the_file_of_the_eight_readings_is_one(capsys):
    file = Path(__file__).resolve().parents[2] / "config" / "eight_cases.yaml"
    short = ["--engine", "eigen,gazebo11", "--duration", "0.5", "--quiet"]
    assert main(["evaluate", str(file), *short, "--out", "out", "--no-plots"]) == 0
    assert len(rows()) == 8
    found = json.loads(Path("out/evaluation.json").read_text())["poles"]
    yaw = [row for row in found if row["axis"] == "yaw"]
    assert [row["engine"] for row in yaw] == ["eigen, gazebo11"] * 2
    assert [row["poles"][0][0] for row in yaw] == pytest.approx([7.34, 10.4], abs=0.05)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("controler: pd\n", "fly.yaml:1: option 'controler' does not exist"),
        ("controller: pd\nseeds: 0\n", "fly.yaml:2: argument --seeds"),
        ("controller: pd\ncontroller: pid\n", "fly.yaml:2: controller is given twice"),
        ("controller: [pd\n", "fly.yaml:2:"),
        ("- pd\n", "fly.yaml:1: write options as KEY: VALUE"),
        ("controller: {a: {b: 1}}\n", "fly.yaml:1: controller is"),
        ("controller: {a: pd}\n", "fly.yaml:1: controller is a mapping here. Write a value"),
        ("controller: pd\n[a, b]: 1\n", "fly.yaml:2: a key is not text"),
        ("controller: pd\n1: 2\n", "fly.yaml:2: option '1' does not exist"),
        ("controller: &a [pd, *a]\n", "fly.yaml:1: controller is a list here"),
        ("controller: pd\nseeds:\n", "fly.yaml:2: seeds is empty. Write a value"),
        ("controller: pd\nquiet: 3\n", "fly.yaml:2: quiet: write true or false"),
        ("set:\n  a.b: 1\n  a.b: 2\n", "fly.yaml:3: a.b is given twice"),
        ("set:\n  a.b: 1\n  ab: 2\n", "fly.yaml:3: argument --set"),
        (
            "controller:\n  - pd\n  - pdd\nreference: hover\n",
            "fly.yaml:3: controller 'pdd' does not exist",
        ),
        (
            "controller: pd\nreference: hover\nvary:\n  controller.kp: [1]\n",
            "fly.yaml:4: vary controller.kp=1: controller 'pd' has no parameter 'kp'",
        ),
        (
            "controller: pd\nreference: hover\nset:\n  odometri.rate: 1\n",
            "fly.yaml:4: ",
        ),
    ],
)
def test_a_file_that_is_wrong_is_one_line(capsys, text, says):
    Path("fly.yaml").write_text(text)
    assert main(["evaluate", "fly.yaml"]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1
    assert says in errors[0]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ("--reference spiral", "no controller is named. Name some with --controller."),
        ("--controller pd", "no reference is named. Name some with --reference."),
        ("--controller pdd --reference spiral", "controller 'pdd' does not exist"),
        ("--controller pd,pd --reference spiral", "controller 'pd' is named twice"),
        ("--controller pd --reference spirl", "reference 'spirl' does not exist"),
        ("--controller pd --reference spiral --engine bullet", "'bullet' does not exist"),
        ("--controller pd --reference spiral --model nope", "nope: neither a file"),
        ("--controller pd --reference spiral --vary engine=ode", "engines are not an axis here"),
        ("--controller pd --reference spiral --vary controller.rate=x", "not a finite number"),
        ("--controller pd --reference spiral --vary a.b=1", "a.b"),
        ("--controller pd --reference spiral --seeds 100001", "100001 flights are more than"),
        ("--controller pd:kp=2 --reference spiral", "controller 'pd' has no parameter 'kp'"),
        ("--controller pd:rate=-2 --reference spiral", "its rate is -2.0. Give calls per second"),
        ("--controller pd,lqr --reference hover --vary controller.kp_xy=2", "no parameter 'kp_xy'"),
        (
            "--controller pd --reference hover --duration 0.005",
            "log_every is 10 but the flight has",
        ),
        ("--controller pd --reference hover --log-every 5000", "log_every is 5000 but the flight"),
        (
            "--controller pd --reference hover --vary odometry.positionNoise=0,x",
            "plugin 'odometry': <positionNoise> 'x' is not a finite number",
        ),
        ("--controller pd --reference hover --time-limit 1e300", "Give seconds, more than 0 and"),
        ("--controller pd:spins=1 --reference hover", "controller 'pd' has no parameter 'spins'"),
        ("--controller pd --reference hover:name=3", "'hover' has no parameter 'name'"),
        ("--controller pd --reference hover:rows=3", "'hover' has no parameter 'rows'"),
        ("--controller pd, --reference hover", "'pd,' has an empty name. Write names"),
        ("--controller pd --reference hover --engine eigen,,ode", "'' does not exist"),
        ("--controller pd --reference hover --model ,", "',' has an empty name"),
        ("--controller pd:kp_xy=1,kp_xy=2 --reference hover", "'kp_xy' is given twice. Keep one."),
    ],
)
def test_what_cannot_be_evaluated_is_one_line(capsys, arguments, says):
    assert main([*FLY, *arguments.split(" ")]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1
    assert says in errors[0]


def test_names_with_commas_and_parameters_are_distinguished():
    text = "pd,geometric:kp_xy=4,lead=0,own:Law,circle:rate=1,g.yaml"
    names = ["pd", "geometric:kp_xy=4,lead=0", "own:Law", "circle:rate=1", "g.yaml"]
    assert several_calls(text) == names


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"controllers": 5}, "controller is 5. Give a name"),
        ({"references": 5}, "reference is 5. Give a name"),
        ({"engines": 5}, "engines is 5. Give a name, or several"),
        ({"models": 5}, "models is 5. Give a name, or several"),
        ({"models": [5]}, r"models is \[5\]. Give a name, or several"),
        ({"references": [None]}, "reference is None. Give one of quadcore.references, or"),
        ({"vary": {"frame.mass": 5}}, "Give a mapping of names to lists of values"),
        ({"vary": {"frame.mass": "1,2"}}, "Give a mapping of names to lists of values"),
        ({"vary": {5: [1]}}, r"vary is \{5: \[1\]\}. Give a mapping"),
        ({"time_limit": -1}, "time_limit is -1. Give seconds, more than 0 and at most 1e"),
        ({"time_limit": float("inf")}, "time_limit is inf. Give seconds"),
        ({"margins": "no"}, "margins is 'no'. Give True or False"),
        ({"processes": 0}, "processes is 0. Give a whole number from 1 on"),
        ({"processes": 1.5}, "processes is 1.5. Give a whole number"),
        ({"progress": 5}, "progress is 5. Give a function"),
        ({"dt": "x"}, "dt is 'x'. Give a step in s"),
        ({"parameters": 5}, "parameters is 5. Give a mapping of names to values"),
        ({"xacro_args": {5: 5}}, r"xacro_args is \{5: 5\}. Give a mapping"),
        ({"ignore": 5}, "ignore is 5. Give a list of names"),
        (
            {"controller": "pd"},
            r"option 'controller' does not exist\. Did you mean 'controllers'\? Use those",
        ),
        (
            {"commands": [[0, 1, 1, 1, 1]]},
            "option 'commands' does not exist.* one of world, dt",
        ),
        ({"seeds": "3"}, "seeds is '3'. Give a whole number"),
        ({"seed": 0.5}, "seed is 0.5. Give a whole number"),
        ({"vary": [1]}, r"vary is \[1\]. Give a mapping"),
        ({"duration": "long"}, "duration is 'long'. Give seconds"),
        ({"time_limit": None}, "time_limit is None. Give seconds"),
        ({"log_every": 0}, "log_every is 0. Give a whole number >= 1"),
        ({"log_every": 2000}, "log_every is 2000 but the flight has 1000 steps"),
    ],
)
def test_arguments_of_other_types_are_reported(arguments, says):
    given = {"controllers": "pd", "references": "hover", "duration": 1.0, **arguments}
    with pytest.raises(qc.InputError, match=says):
        qc.evaluate(**given)
