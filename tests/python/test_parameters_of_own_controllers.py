"""Parameters of user-defined controllers: on the command line, varied, and tuned."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

import quadcore as qc
from quadcore.cli import main

OWN = """
import numpy as np
import quadcore as qc

class Lee:
    rate = 250.0
    tilt = 0.5

    def __init__(self, kx=4, kv: float = 3.0, flip=False):
        self.kx, self.kv = kx, kv
        assert isinstance(flip, bool)
        self.floor = kx / 2  # a value that the constructor derives

    def __call__(self, t, state, reference):
        assert self.floor == self.kx / 2
        a = self.kx * (reference.position - state.position)
        a += self.kv * (reference.velocity - state.linear_velocity)
        lift = a + reference.acceleration + [0, 0, 9.8]
        x, y, z = lift / np.linalg.norm(lift)
        half = np.array([-y, x, 0, 1 + z])
        return qc.AttitudeThrust(half / np.linalg.norm(half), 1.04 * np.linalg.norm(lift))

gain = 1.0

def level(t, state, reference):
    return qc.RatesThrust([0, 0, 0], 10.192 * level.share)
level.share = 1.0
"""

FLIGHT = ["--duration", "1", "--spawn", "0,0,9", "--xacro", "sim_slow:=1", "--quiet", "--no-plots"]


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(OWN)
    for name in [name for name in sys.modules if name == "mine" or name.endswith("mine.py")]:
        monkeypatch.delitem(sys.modules, name)


def evaluate(*controllers, **options):
    labelled = isinstance(controllers[0], dict)
    return qc.evaluate(
        controllers[0] if labelled else list(controllers), "hover:height=10", duration=1.0,
        spawn=(0, 0, 9), xacro_args={"sim_slow": 1}, **options,
    ).table  # fmt: skip


def test_parameters_in_the_name_reach_constructor_attributes_and_timing():
    parsed = qc.controllers.parse
    lee = parsed("mine:Lee:kx=6,kv=4.5,flip=true,tilt=0.25,rate=100,delay=0.02")
    assert (lee.kx, lee.kv, lee.tilt, lee.rate, lee.delay) == (6, 4.5, 0.25, 100, 0.02)
    assert isinstance(lee.kx, int)
    assert parsed("mine.py:Lee:kx=6.5").kx == 6.5
    assert parsed("mine:level:share=0.9").share == 0.9
    assert parsed("mine.py:Lee", values={"kx": 8}).kx == 8


def test_rows_with_parameters_are_those_of_an_object_with_them(tmp_path, monkeypatch):
    named = evaluate("mine:Lee:kx=9,kv=5", "mine.py:Lee")
    monkeypatch.syspath_prepend(tmp_path)
    import mine

    other = evaluate({"one": mine.Lee(9, 5.0), "other": mine.Lee()})
    for one, same in zip(named, other):
        assert one["failure"] == same["failure"] == ""
        assert one["rms_position"] == same["rms_position"]
    assert named[0]["rms_position"] != named[1]["rms_position"]
    varied = evaluate("mine:Lee:kv=5", vary={"controller.kx": [4, 9]})
    assert [row["scenario"] for row in varied] == ["controller.kx=4", "controller.kx=9"]
    assert varied[1]["rms_position"] == named[0]["rms_position"]


def test_the_command_line_varies_a_parameter_in_evaluate_and_sweep():
    command = ["evaluate", "--controller", "mine.py:Lee:kv=5,kx=2,geometric", "--reference"]
    command += ["hover:height=10", "--vary", "controller.rate=200,250", "--out", "out", *FLIGHT]
    assert main(command) == 0
    with open("out/table.csv") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["controller"] for row in rows} == {"mine.py:Lee:kv=5,kx=2", "geometric"}
    sweep = ["sweep", "--controller", "mine.py:Lee", "--reference", "hover:height=10"]
    sweep += ["--vary", "controller.kx=2,4,8", "--out", "swept", *FLIGHT]
    assert main(sweep) == 0
    with open("swept/table.csv") as stream:
        errors = [float(row["rms_position"]) for row in csv.DictReader(stream)]
    assert len(set(errors)) == 3
    assert "mine.py:Lee:kx=8.0" in Path("swept/report.html").read_text()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("mine:Lee:tilts=6", "has no parameter 'tilts'. Did you mean 'tilt'? Use some of kx,"),
        ("mine:Lee:mass=6", "has no parameter 'mass'. Use some of kx, kv, flip"),
        ("mine:Lee:kx=fast", "'kx=fast' is not of the form KEY=NUMBER"),
        ("mine:level:thrust=2", "has no parameter 'thrust'. Use some of share."),
        ("mine:kx=6", "no name is given. Write MODULE:NAME or FILE.py."),
    ],
)
def test_an_unknown_parameter_is_refused_with_those_that_exist(text, says, capsys):
    assert main(["run", "quadrotor", "--controller", text, "--quiet"]) == 2
    assert says in capsys.readouterr().err


def test_tune_finds_parameters_and_the_gains_file_flies_like_the_controller_itself(capsys):
    pytest.importorskip("cma")
    command = ["tune", "mine.py:Lee:kx=0.5,kv=2", "--free", "kx,kv", "-o", "lee.yaml"]
    command += ["--budget", "12", "--duration", "2", "--xacro", "sim_slow:=1", "--seed", "1"]
    command += ["--reference", "step", "--hold-out", "circle", "--quiet"]
    assert main(command) == 0
    first = Path("lee.yaml").read_bytes()
    written = yaml.safe_load(first)
    assert (written["law"], written["rate"]) == ("mine.py:Lee", 250)
    history, found = written["history"], written["parameters"]
    assert history["start"] == {"kx": 0.5, "kv": 2.0}
    assert history["best"] < history["evaluations"][0]
    assert main([*command[:-1], "--quiet", "--jobs", "1"]) == 0
    assert Path("lee.yaml").read_bytes() == first
    text = f"mine.py:Lee:kx={found['kx']!r},kv={found['kv']!r}"
    by_file, by_name = evaluate("lee.yaml", text)
    assert by_file["failure"] == ""
    assert np.isclose(by_file["rms_position"], by_name["rms_position"], rtol=1e-12)
    assert main(["tune", "mine.py:Lee", "-o", "x.yaml", "--quiet"]) == 2
    assert "is your own. Name its parameters with --free." in capsys.readouterr().err
