"""What `quadcore compare` refuses, and what it writes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from compared import FLIGHT, commands, line_of, rows  # noqa: F401

import quadcore as qc
from quadcore.cli import main


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ("toy.urdf", "nothing is varied"),
        ("toy.urdf nope.urdf", "nope.urdf: neither a file"),
        (
            "toy.urdf --vary motor.kq=1",
            "vary motor.kq: model toy has no 'motor.kq'. Did you mean 'motor.kp'?",
        ),
        ("toy.urdf --vary engin=ode", "Did you mean 'engine'?"),
        (
            "toy.urdf --vary engine=eigne",
            "vary engine: 'eigne' does not exist. Did you mean 'eigen'?",
        ),
        ("toy.urdf --vary world=nope", "nope: neither a file nor a built-in world"),
        ("toy.urdf --vary motor.kp=", "motor.kp: no values are given"),
        ("toy.urdf --vary motor.kp=1:2:0", "the range '1:2:0' is empty"),
        ("toy.urdf --vary motor.kp=1:x:3", "'1:x:3' is not a range"),
        ("toy.urdf --vary motor.kp=1:2", "'1:2' is not a range"),
        ("toy.urdf --vary motor.kp=log:0:1:3", "is not a geometric range"),
        ("toy.urdf --vary motor.kp=1 --vary motor.kp=2", "motor.kp is given twice"),
        ("toy.urdf --vary motor.kp=1 --vary motor.kp,motor.ki=2", "motor.kp is varied twice"),
        ("toy.urdf --vary motor.kp=1 --set motor.kp=2e-4", "motor.kp: it is also set"),
        ("toy.urdf --vary motor.kp=0:1:1000000000", "values make 1000000000 flights"),
        (
            "toy.urdf --vary motor.kp=0:1:1000 --vary motor.ki=0:1:1000 --vary motor.kd=0:1:1000",
            "1000 x 1000 x 1000 values make 1000000000 flights, more than 100000",
        ),
        ("toy.urdf quadrotor --commands c.csv", "quadrotor: has 4 rotors, toy.urdf has 1"),
        ("toy.urdf --vary motor.kp=1 --commands nope.csv", "nope.csv: cannot be read"),
        ("toy.urdf --vary motor.kp=1 --logs", "--logs requires a folder. Add --out."),
        ("toy.urdf --vary motor.kp=1 --wrenches", "--wrenches requires a folder. Add --out."),
        ("toy.urdf --vary motor.kp=1 --out c.csv", "c.csv: cannot be made"),
        ("toy.urdf --vary motor.kp=1 --jobs 0", "--jobs: '0' is not a whole number"),
        ("toy.urdf --vary motor.kp", "is not of the form"),
        ("toy.urdf --vary motor.kp=1 --duration 1 --log-every 1001", "the flight has 1000 steps"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_flown(capsys, monkeypatch, arguments, reason):
    monkeypatch.setattr(qc.Simulation, "step", lambda *_, **__: pytest.fail("flown"))
    monkeypatch.setattr(qc.Simulation, "run", lambda *_, **__: pytest.fail("flown"))
    assert main(["compare", *arguments.split()]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    assert reason in err


def test_from_python_too_much_is_refused():
    with pytest.raises(qc.InputError, match="the logs of 50000 flights need"):
        qc.compare("toy.urdf", {"motor.kp": np.linspace(1e-4, 1e-3, 50_000)})
    with pytest.raises(qc.InputError, match="no values are given"):
        qc.compare("toy.urdf", {"motor.kp": []})


# What is written


def test_the_page_needs_no_other_file():
    vary = ["--vary", "motor.kp=1e-4,1e-3"]
    assert main(["compare", "toy.urdf", *FLIGHT, *vary, "--quiet", "--out", "out"]) == 0
    page = Path("out/report.html").read_text()
    assert page.count('<figure class="plot"><svg ') == 6
    assert 'src="http' not in page
    assert f"5e-4 (toy.urdf:{line_of('toy.urdf', '<kp>')})" in page


def test_more_flights_than_can_be_held_leave_metrics_only():
    vary = ["--vary", "motor.kp=1e-4:1e-3:60"]
    arguments = ["compare", "toy.urdf", *FLIGHT, *vary, "--quiet", "--no-plots"]
    assert main([*arguments, "--out", "out"]) == 0
    assert len(rows()) == 60
    assert not Path("out/logs").exists()
    assert main([*arguments, "--out", "all", "--logs"]) == 0
    assert len(list(Path("all/logs").iterdir())) == 60


@pytest.mark.parametrize("name", ["table.csv", "comparison.json", "report.html"])
def test_an_unwritable_output_is_refused_before_any_flight(name, toy, capsys):
    Path("out", name).mkdir(parents=True)
    flight = ["--vary", "motor.kp=1e-4,2e-4", "--duration", "1e6"]
    assert main(["compare", "toy.urdf", *flight, "--out", "out", "--quiet"]) == 2
    assert f"{name}: is a folder" in capsys.readouterr().err
