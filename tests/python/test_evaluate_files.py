"""What an evaluation writes, and what is kept of one that is interrupted."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from evaluations import FLY, rows
from test_own_controllers import here as here

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.evaluate.evaluate import fly_plan
from quadcore.studies.evaluate.overview import describe_best
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.options import EvaluateOptions


def test_everything_is_written_and_reproducible():
    command = [*FLY, "--controller", "pd,geometric", "--reference", "circle,step:dx=1,time=0.2"]
    for folder in ("out", "again"):
        assert main([*command, "--seeds", "2", "--quiet", "--out", folder]) == 0
    found = rows()
    assert [row["controller"] for row in found[::4]] == ["pd", "geometric"]
    head = ["controller", "reference", "engine", "model", "scenario", "seed", "failure"]
    assert list(found[0])[:10] == [*head, "rms_position", "max_position", "final_position"]
    assert found[2]["reference"] == "step:dx=1,time=0.2"
    for name in ("table.csv", "evaluation.json", "seeds.png"):
        assert Path("out", name).read_bytes() == Path("again", name).read_bytes(), name
    # The head of a page has the command line and the date.
    page, again = (Path(folder, "report.html").read_text() for folder in ("out", "again"))
    assert page.partition("</header>")[2] == again.partition("</header>")[2] != ""
    assert "--out out" in page and "--out again" in again
    content = json.loads(Path("out/evaluation.json").read_text())
    assert len(content["combinations"]) == 4
    timing = rows("out/timing.csv")
    assert all(float(row["seconds"]) > 0 for row in timing)
    page = Path("out/report.html").read_text()
    for text in (
        "step:dx=1,time=0.2",
        "Controller settings",
        "Poles of",
        'class="quadcore-player"',
        '<figure class="plot"><svg ',
    ):
        assert text in page
    assert 'src="http' not in page


def test_the_page_says_why_the_printed_gains_are_lost(capsys):
    command = [*FLY, "--controller", "pid_thesis,pid_thesis:kd_xy=2.5", "--reference", "spiral"]
    assert main([*command, "--no-plots", "--out", "out"]) == 0
    page = Path("out/report.html").read_text()
    texts = page + capsys.readouterr().out
    for text in (
        "pid_thesis (eigen), x, y: pole at 0.231 +- 1.63i 1/s; cause: Kd Kp = 0.3 is not above Ki",
        "pid_thesis (eigen), yaw: pole at 10.4 +- 11.4i 1/s; cause: the zero at 2 b w0 sim_slow",
        "pid_thesis:kd_xy=2.5 (eigen), yaw: pole at 10.4 +- 11.4i 1/s; cause: the zero at 2 b w0",
    ):
        assert text in page
        assert texts.count(text) == 2
    assert "pid_thesis:kd_xy=2.5 (eigen), x, y" not in page


def test_the_file_tells_all_that_flew():
    command = [*FLY, "--controller", "geometric:kp_xy=7", "--reference", "hover", "--no-plots"]
    more = ["--controller-rate", "250", "--delay", "0.004", "--world", "default.world"]
    assert main([*command, *more, "--dt", "0.002", "--quiet", "--out", "out"]) == 0
    content = json.loads(Path("out/evaluation.json").read_text())
    (controller,) = content["laws"]
    assert (controller["law"], controller["model"], controller["rate"], controller["delay"]) == (
        "geometric", "quadrotor", 250, 0.004
    )  # fmt: skip
    assert controller["parameters"]["kp_xy"] == 7
    assert {"kp_z", "lead", "believed_thrust"} <= set(controller["parameters"])
    plan = content["plan"]
    assert (plan["world"], plan["dt"], plan["log_every"]) == ("default.world", 0.002, 5)
    assert (plan["seeds"], plan["duration"], plan["xacro"]) == ([0], 1, {"sim_slow": "1"})
    assert content["quadcore"] == qc.__version__
    assert (content["flights"][0]["rate"], content["flights"][0]["updates"]) == (250, 250)
    (timing,) = rows("out/timing.csv")
    assert 0 < float(timing["update_median"]) <= float(timing["update_p99"]) < 1


def test_pictures_of_an_evaluation_before_are_gone_and_others_stay():
    command = [*FLY, "--controller", "pd", "--reference", "hover", "--quiet", "--out", "out"]
    Path("out").mkdir()
    foreign = ["engines.png", "margins.png", "tracks_7.png"]
    for name in foreign:
        Path("out", name).write_bytes(b"of somebody else")
    assert main(command) == 0
    listed = json.loads(Path("out/evaluation.json").read_text())["pictures"]
    found = {path.name for path in Path("out").glob("*.png")}
    assert len(listed) > 1 and found == {*foreign, *listed}
    assert main([*command, "--no-plots"]) == 0
    assert sorted(path.name for path in Path("out").glob("*.png")) == foreign
    assert all(Path("out", name).read_bytes() == b"of somebody else" for name in foreign)


def test_a_document_cannot_make_an_evaluation_remove_other_files():
    names = ["../mine.png", "/tmp/x", "mine.txt", 3, "rates.png/../mine.png"]
    Path("out").mkdir()
    Path("mine.png").write_bytes(b"")
    Path("out/evaluation.json").write_text(json.dumps({"pictures": names}))
    command = [*FLY, "--controller", "pd", "--reference", "hover", "--quiet", "--out", "out"]
    assert main([*command, "--no-plots"]) == 0
    assert Path("mine.png").exists()


@pytest.mark.parametrize("name", ["table.csv", "evaluation.json", "timing.csv", "report.html"])
def test_an_unwritable_output_is_refused_before_any_flight(name, capsys):
    Path("out", name).mkdir(parents=True)
    command = [*FLY, "--controller", "own:Never", "--reference", "hover", "--out", "out"]
    assert main(command) == 2
    assert f"{name}: is a folder" in capsys.readouterr().err


def test_an_interrupted_evaluation_keeps_what_was_flown():
    command = [sys.executable, "-m", "quadcore", *FLY, "--controller", "pd,own:Never"]
    options = ["--reference", "hover", "--jobs", "1", "--out", "out", "--time-limit", "100"]
    process = subprocess.Popen([*command, *options], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and process.poll() is None:
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        busy = [Path(f"/proc/{child}/stat").read_text().split()[13] for child in children]
        if any(int(ticks) > 300 for ticks in busy):  # 3 s of work: the second flight hangs
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130
    found = rows()
    assert found[0]["failure"] == ""
    assert found[1]["failure"] == "not flown: interrupted"
    assert float(found[0]["rms_position"]) < 0.1


def test_an_interrupt_carries_the_evaluation():
    def progress(done, total):
        raise KeyboardInterrupt

    options = EvaluateOptions(seeds=3, duration=0.2, processes=1)
    plan = Plan("pd", "hover", ["eigen"], ["quadrotor"], {}, options)
    with pytest.raises(KeyboardInterrupt) as raised:
        fly_plan(plan, progress)
    assert raised.value.evaluation.table[0]["failure"] == ""


@pytest.mark.parametrize(
    "varied, values, expected",
    [
        ("reference", ("circle", "eight"), "On circle, a has the lowest final error."),
        ("scenario", ("none", "gusty"), "With scenario none, a has the lowest final error."),
    ],
)
def test_the_result_names_the_cell_and_its_best_controller(varied, values, expected):
    cell = {"reference": "hover", "engine": "eigen", "model": "quadrotor", "scenario": "none"}
    groups = [
        {**cell, varied: value, "controller": name, "mean_rms_position": 1.0, "failure_rate": 0.0,
         "flights": 2, "is_best": name == "a"}
        for value in values
        for name in "ab"
    ]  # fmt: skip
    assert describe_best(groups)[0] == expected
