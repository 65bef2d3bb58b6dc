"""Controllers evaluated: what is flown, measured, summed and written."""

from __future__ import annotations

import csv
import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from test_guided_runs import OWN

import quadcore as qc
from quadcore import laws, references
from quadcore.cli import main
from quadcore.cli.values import several_calls
from quadcore.evaluation import measures
from quadcore.evaluation.evaluate import conduct
from quadcore.evaluation.intervals import cvar, interval
from quadcore.evaluation.plan import Plan
from quadcore.evaluation.step_response import step_response
from quadcore.log import Log

FLY = ["evaluate", "--xacro", "sim_slow:=1", "--duration", "1"]
NOISE = {"odometry.positionNoise": 0.2106e-3, "odometry.orientationNoise": 0.2e-3}
OWN_MORE = """
class Never(Hover):
    def __call__(self, t, state, reference):
        while t > 0.05:
            try:
                pass
            except Exception:
                pass
        return self.speeds
class Dies(Hover):
    def __call__(self, t, state, reference):
        import os
        os._exit(3)
class Counts(Hover):
    calls = 0
    def __call__(self, t, state, reference):
        self.calls += 1
        if self.calls > 101:
            raise ValueError("another flight's calls")
        return self.speeds
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN + OWN_MORE)
    monkeypatch.delitem(sys.modules, "own", raising=False)


def evaluate(*arguments, **options):
    given = {"xacro_args": {"sim_slow": 1}, "duration": 1.0, **options}
    return qc.evaluate(*arguments, **given)


def rows(file="out/table.csv"):
    with open(file) as stream:
        return list(csv.DictReader(stream))


# What is measured.


def log_of(time, wanted, position, rotors=None):
    """A log of a motion along x."""
    table = np.zeros((len(time), 16 if rotors is None else 14 + rotors.shape[1]))
    table[:, 0], table[:, 1], table[:, 7] = time, position, 1
    if rotors is not None:
        table[:, 14:] = rotors
    zero = np.zeros(len(time))
    topics = {
        "reference": {"x": wanted, "y": zero, "z": zero, "yaw": zero},
        "error": {"x": position - wanted, "y": zero, "z": zero},
    }
    return Log(table, {}, topics=topics)


def test_measures_are_those_of_a_motion_in_closed_form():
    time = np.linspace(0, 20, 2001)
    error = 0.3 * np.exp(-time / 4)
    rotors = np.column_stack([100 + 10 * time, np.full(2001, -50.0)])
    log = log_of(time, np.sin(time), np.sin(time) + error, rotors)
    found = measures.measure(log, 0.25, np.array([2e-6, 3e-6]))
    assert found["largest_position"] == pytest.approx(0.3)
    assert found["rms_position"] == pytest.approx(
        np.sqrt(0.09 * 2 * (1 - np.exp(-10)) / 20), rel=2e-3
    )
    assert found["tail_position"] == pytest.approx(0.3 * np.exp(-10.01 / 4))
    assert found["iae_position"] == pytest.approx(1.2 * (1 - np.exp(-5)), rel=1e-4)
    assert found["itae_position"] == pytest.approx(0.3 * 16 * (1 - 6 * np.exp(-5)), rel=1e-4)
    assert found["effort"] == pytest.approx(5)
    ramp = (300.0**4 - 100.0**4) / 40  # of (100 + 10 t)^3 over 20 s
    assert found["energy"] == pytest.approx(2e-6 * ramp + 3e-6 * 50**3 * 20, rel=1e-5)
    assert found["saturated"] == 0.25
    assert np.isnan(found["rise_time"])


def test_rise_overshoot_and_settling_are_those_of_a_second_order_system():
    w, d = 2.0, 0.4
    time = np.arange(0, 20, 1e-3)
    since = np.maximum(time - 2.0005, 0)
    root = np.sqrt(1 - d**2)
    answer = 1 - np.exp(-d * w * since) * (
        np.cos(root * w * since) + d / root * np.sin(root * w * since)
    )
    wanted = np.where(time >= 2.0005, 5.0, 3.0)
    found = measures.measure(log_of(time, wanted, 3 + 2 * answer), 0, np.zeros(2))
    assert found["overshoot"] == pytest.approx(np.exp(-np.pi * d / root), rel=1e-3)
    t = np.arange(0, 20, 1e-4)
    exact = 1 - np.exp(-d * w * t) * (np.cos(root * w * t) + d / root * np.sin(root * w * t))
    rise = t[np.argmax(exact >= 0.9)] - t[np.argmax(exact >= 0.1)]
    assert found["rise_time"] == pytest.approx(rise, abs=3e-3)
    settled = t[np.flatnonzero(np.abs(exact - 1) > 0.02)[-1]]
    assert found["settling_time"] == pytest.approx(settled, abs=3e-3)


def test_who_is_more_than_5_m_off_is_lost():
    time = np.linspace(0, 10, 101)
    assert measures.lost(log_of(time, 0 * time, 0.49 * time)) is None
    assert measures.lost(log_of(time, 0 * time, 0.7 * time)) == pytest.approx(7.2)
    assert measures.lost(log_of(time, 0 * time, np.full(101, np.nan))) == 0


def test_the_step_response_is_found_in_any_motion_that_excites_it():
    rate, lag = 100, 0.3
    time = np.arange(0, 40, 1 / rate)
    wanted = np.cumsum(np.random.default_rng(4).normal(size=len(time))) / 50
    position = np.zeros_like(wanted)
    for k in range(1, len(time)):  # a lag of first order, exactly for held inputs
        part = np.exp(-1 / rate / lag)
        position[k] = part * position[k - 1] + (1 - part) * wanted[k - 1]
    response = step_response(log_of(time, wanted - wanted[0], position - position[0]))
    expected = 1 - np.exp(-response[:, 0] / lag)
    assert np.abs(response[:, 1] - expected).max() < 0.12
    assert response[-1, 1] == pytest.approx(1, abs=0.05)
    assert step_response(log_of(time, np.cos(0.5 * time), np.cos(0.5 * time))) is None
    assert step_response(log_of(time[:300], wanted[:300], position[:300])) is None


def test_intervals_hold_the_mean_as_often_as_they_say():
    draws = np.random.default_rng(1).normal(3, 1, size=(300, 30))
    held = [low < 3 < high for low, high in map(interval, draws)]
    assert 0.89 < np.mean(held) < 0.98
    assert interval(draws[0]) == interval(draws[0])
    assert np.isnan(interval(draws[0, :1])).all()


def test_the_value_at_risk_is_the_mean_of_the_worst_tenth():
    assert cvar(np.arange(1, 21)) == pytest.approx(19.5)
    assert cvar(np.array([1.0, 7.0])) == 7
    assert np.isnan(cvar(np.array([])))


# What is flown.


def test_a_row_is_what_the_flight_by_itself_is():
    found = evaluate(["pd", "geometric"], "circle", seeds=2, parameters=NOISE, seed=3)
    circle = references.circle()
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1}, parameters=NOISE, seed=4)
    simulation.set_state(references.start(simulation, circle))
    log = simulation.run(1, controller="geometric", reference=circle, log_every=10)
    away = np.linalg.norm([log.topics["error"][axis] for axis in "xyz"], axis=0)
    row = found.table[-1]
    assert (row["controller"], row["seed"], row["failure"]) == ("geometric", 4, "")
    assert row["largest_position"] == away.max()
    assert [r["seed"] for r in found.table] == [3, 4, 3, 4]
    group = found.groups[1]
    apart = [found.table[2 + i]["rms_position"] - found.table[i]["rms_position"] for i in range(2)]
    assert group["difference_rms_position"] == pytest.approx(np.mean(apart))
    assert group["flights"] == 2


def test_the_number_of_processes_changes_nothing():
    whole = [
        evaluate(["pd", "indi"], "circle", seeds=3, parameters=NOISE, processes=n)[:3]
        for n in (1, 3)
    ]
    assert str(whole[0]) == str(whole[1])  # NaN is what it is


def test_conditions_reach_plant_world_and_controller():
    found = evaluate(
        {"mine": laws.geometric(kp_xy=7)},
        "circle",
        vary={"controller.delay": [0, 0.02], "frame.mass": [1.0, 1.3], "xacro.sim_slow": [1, 2]},
        xacro_args={},
        duration=0.5,
    )
    assert len(found.table) == 8
    assert found.table[0]["scenario"] == "controller.delay=0 frame.mass=1.0 xacro.sim_slow=1"
    assert len({row["largest_position"] for row in found.table}) == 8
    assert not any(row["failure"] for row in found.table)


def test_objects_and_functions_are_evaluated_each_flight_anew():
    class Counting:
        rate = 100
        calls = 0

        def __call__(self, t, state, reference):
            self.calls += 1
            assert self.calls <= 50
            return [471, -471, 471, -471]

    found = evaluate([Counting()], "hover", seeds=3, duration=0.5, processes=1)
    assert [row["failure"] for row in found.table] == ["", "", ""]
    assert found.table[0]["controller"] == "Counting"


def test_faults_of_a_controller_are_rows_and_the_other_flights_finish(capsys):
    own = ["Raises", "Nan", "Short", "Wrong", "Asks", "Nope", "Never", "Dies", "Counts"]
    text = ",".join(["pd", "nomodule:X", *(f"own:{name}" for name in own)])
    command = [*FLY, "--controller", text, "--reference", "hover", "--seeds", "2"]
    assert main([*command, "--time-limit", "2", "--out", "out", "--no-plots", "--quiet"]) == 3
    error = capsys.readouterr().err.splitlines()
    assert len(error) == 1
    assert "20 of 22 flights failed; the first, nomodule:X on hover in eigen, seed 0" in error[
        0
    ] or ("18 of 22" in error[0])
    told = {row["controller"]: row["failure"] for row in rows()}
    for name, says in {
        "pd": "",
        "own:Counts": "",
        "nomodule:X": "there is no module 'nomodule'",
        "own:Raises": "ValueError: no idea",
        "own:Nan": "rotor 1 is not a finite number",
        "own:Short": "holds 2 rotor speeds; give 4",
        "own:Wrong": "cannot be called as controller(t, state, reference)",
        "own:Asks": "missing 1 required positional argument",
        "own:Nope": "module 'own' has no 'Nope'",
        "own:Never": "not done within the time limit of 2 s",
        "own:Dies": "status 3",
    }.items():
        assert says in told[name] if says else told[name] == "", name


def test_a_lost_vehicle_is_a_failure_with_its_time():
    found = evaluate("pid_thesis:rate=1000", "spiral", duration=15)
    assert found.table[0]["failure"].startswith("lost at t = ")
    assert np.isnan(found.table[0]["rms_position"])
    assert found.groups[0]["failure_rate"] == 1


def test_margins_are_found(capsys):
    found = evaluate(
        ["geometric", lambda t, state, reference: [471, -471, 471, -471]], "circle",
        duration=4, margins=True,
    )  # fmt: skip
    first, own = found.margins
    assert first["gain_low"] < 0.8 < 1.3 < first["gain_high"]
    assert 0.004 < first["delay_margin"] < 0.5
    assert first["box_median"] <= first["box_worst"]
    assert first["rms_at_500_Hz"] < first["rms_at_25_Hz"] or np.isnan(first["rms_at_25_Hz"])
    assert own["controller"] == "<lambda>"
    assert np.isnan(own["box_worst"])


# What is written.


def test_everything_is_written_and_reproducible():
    command = [*FLY, "--controller", "pd,geometric", "--reference", "circle,step:dx=1,time=0.2"]
    for folder in ("out", "again"):
        assert main([*command, "--seeds", "2", "--quiet", "--out", folder]) == 0
    found = rows()
    assert [row["controller"] for row in found[::4]] == ["pd", "geometric"]
    head = ["controller", "reference", "engine", "model", "scenario", "seed", "failure"]
    assert list(found[0])[:10] == [*head, "rms_position", "largest_position", "tail_position"]
    assert found[2]["reference"] == "step:dx=1,time=0.2"
    for name in ("table.csv", "evaluation.json", "report.html", "seeds.png"):
        assert Path("out", name).read_bytes() == Path("again", name).read_bytes(), name
    content = json.loads(Path("out/evaluation.json").read_text())
    assert len(content["combinations"]) == 4
    timing = rows("out/timing.csv")
    assert all(float(row["seconds"]) > 0 for row in timing)
    page = Path("out/report.html").read_text()
    for text in (
        "step:dx=1,time=0.2",
        "What each law flew with",
        "Poles of",
        'class="player"',
        "data:image/png;base64,",
    ):
        assert text in page
    assert 'src="http' not in page


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


def test_the_file_of_the_eight_readings_is_one(capsys):
    file = Path(__file__).resolve().parents[2] / "config" / "eight_cases.yaml"
    short = ["--engine", "eigen,gazebo11", "--duration", "0.5", "--quiet"]
    assert main(["evaluate", str(file), *short, "--out", "out", "--no-plots"]) == 0
    assert len(rows()) == 8
    found = json.loads(Path("out/evaluation.json").read_text())["poles"]
    yaw = [row for row in found if row["axis"] == "yaw"]
    assert [row["engine"] for row in yaw] == ["eigen, gazebo11"] * 2
    assert [row["poles"][0][0] for row in yaw] == pytest.approx([7.45, 10.4], abs=0.05)


def test_models_with_other_rotors_fly_beside_each_other():
    found = evaluate("geometric", "hover", models=["hexarotor", "crazyflie"], xacro_args={})
    assert [row["model"] for row in found.table] == ["hexarotor", "crazyflie"]
    assert max(row["largest_position"] for row in found.table) < 0.01


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("controler: pd\n", "fly.yaml:1: there is no option 'controler'"),
        ("controller: pd\nseeds: 0\n", "fly.yaml: argument --seeds"),
        ("controller: pd\ncontroller: pid\n", "fly.yaml:2: controller is given twice"),
        ("controller: [pd\n", "fly.yaml:2:"),
        ("- pd\n", "fly.yaml:1: write options as KEY: VALUE"),
        ("controller: {a: {b: 1}}\n", "fly.yaml:1: controller is"),
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
        ("--reference spiral", "nothing to fly: name --controller"),
        ("--controller pd", "nothing to fly: name --reference"),
        ("--controller pdd --reference spiral", "there is no law 'pdd'"),
        ("--controller pd,pd --reference spiral", "controller 'pd' is named twice"),
        ("--controller pd --reference spirl", "there is no reference 'spirl'"),
        ("--controller pd --reference spiral --engine bullet", "'bullet' is none of"),
        ("--controller pd --reference spiral --model nope", "nope: no such file"),
        ("--controller pd --reference spiral --vary engine=ode", "name the engines"),
        ("--controller pd --reference spiral --vary controller.rate=x", "not a finite number"),
        ("--controller pd --reference spiral --vary a.b=1", "a.b"),
        ("--controller pd --reference spiral --seeds 100001", "100001 flights; at most"),
    ],
)
def test_what_cannot_be_evaluated_is_one_line(capsys, arguments, says):
    assert main([*FLY, *arguments.split(" ")]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1
    assert says in errors[0]


def test_names_with_commas_and_parameters_are_told_apart():
    text = "pd,geometric:kp_xy=4,lead=0,own:Law,circle:rate=1,g.yaml"
    names = ["pd", "geometric:kp_xy=4,lead=0", "own:Law", "circle:rate=1", "g.yaml"]
    assert several_calls(text) == names


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

    plan = Plan("pd", "hover", ["eigen"], ["quadrotor"], 3, {}, 0.2, None, None, None, None, {})
    with pytest.raises(KeyboardInterrupt) as raised:
        conduct(plan, 60, 1, progress)
    assert raised.value.evaluation.table[0]["failure"] == ""
