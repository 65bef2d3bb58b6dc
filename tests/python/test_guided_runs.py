"""``quadcore run`` in closed loop: what it flies, tells, logs and refuses."""

from __future__ import annotations

import csv
import pickle
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from flights import quadrotor

import quadcore as qc
from quadcore.cli import main
from quadcore.control import controllers, references
from quadcore.simulation.controller_pilot import ControllerPilot
from quadcore.simulation.flight import fly

FLY = ["run", "quadrotor", "--engine", "eigen", "--xacro", "sim_slow:=1"]

OWN = """
import numpy as np
class Hover:
    rate = 100
    def reset(self, simulation):
        self.speeds = np.sqrt(simulation.mass * 9.8 / 4 / 1.1487e-5) * np.array([1, -1, 1, -1])
    def __call__(self, t, state, reference):
        return self.speeds
class Raises(Hover):
    def __call__(self, t, state, reference):
        raise ValueError("no idea")
class Nan(Hover):
    def __call__(self, t, state, reference):
        return self.speeds * (np.nan if t > 0.1 else 1)
class Short(Hover):
    def __call__(self, t, state, reference):
        return self.speeds[:2]
class Wrong(Hover):
    def __call__(self, t):
        return self.speeds
class Asks:
    def __init__(self, what):
        pass
class Slotted:
    __slots__ = ()
    def __call__(self, t, state, reference):
        return [471, -471, 471, -471]
def constant(t, state, reference):
    return [471, -471, 471, -471]
three = 3
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN)
    monkeypatch.delitem(__import__("sys").modules, "own", raising=False)


def run_main(capsys, *arguments):
    assert main([*FLY, *arguments]) == 0
    lines = capsys.readouterr().out.splitlines()
    return {line[:22].strip(): line[22:].strip() for line in lines}


def columns(file):
    with open(file) as stream:
        names, *rows = csv.reader(stream)
    return dict(zip(names, np.array(rows, dtype=float).T))


def test_reference_and_error_are_in_the_log_beside_the_state(capsys, in_empty_folder):
    arguments = ["--controller", "geometric", "--reference", "spiral:radius=1.5", "--duration", "2"]
    run_main(capsys, *arguments, "--log", "log.csv", "--log", "log.mat", "--log-every", "10")
    log = columns("log.csv")
    assert list(log)[-7:] == [
        *(f"reference.{name}" for name in ("x", "y", "z", "yaw")),
        *(f"error.{name}" for name in "xyz"),
    ]
    t = log["t"]
    assert len(t) == 201
    np.testing.assert_allclose(log["reference.x"], 1.5 * np.cos(0.5 * t), atol=1e-12)
    np.testing.assert_allclose(log["reference.z"], 10 + t, atol=1e-12)
    for axis in "xyz":
        assert np.array_equal(log[f"error.{axis}"], log[axis] - log[f"reference.{axis}"])
        assert np.abs(log[f"error.{axis}"]).max() < 1e-3
    vectors = scipy.io.loadmat("log.mat", squeeze_me=True, struct_as_record=False)
    assert np.array_equal(vectors["topic_error"].y, log["error.y"])


def test_the_summary_tells_largest_rms_and_late_errors(capsys):
    said = run_main(
        capsys, "--controller", "pd", "--reference", "circle", "--duration", "12", "--log", "l.csv"
    )
    log = columns("l.csv")
    away = np.linalg.norm([log[f"error.{axis}"] for axis in "xyz"], axis=0)
    late = away[log["t"] > log["t"][-1] - 10].max()
    assert said["max error"] == f"{away.max():.4g} m (whole flight), {late:.4g} m (last 10 s)"
    assert said["RMS error"] == f"{np.sqrt(np.mean(away**2)):.4g} m"
    assert said["controller"] == "pd, 500 Hz, delay 0 s"
    assert said["saturated updates"] == "0 of 6000"


def test_it_flies_what_python_flies(capsys):
    run_main(
        capsys, "--controller", "geometric:kp_xy=7", "--reference", "circle", "--duration", "1",
        "--controller-rate", "250", "--delay", "0.004", "--log", "log.csv",
    )  # fmt: skip
    circle = references.circle()
    simulation = quadrotor("eigen", xacro_args={"sim_slow": 1})
    simulation.set_state(references.start(simulation, circle))
    controller = controllers.geometric(kp_xy=7, rate=250, delay=0.004)
    log = simulation.run(1, controller=controller, reference=circle)
    assert np.array_equal(columns("log.csv")["x"], log.position[:, 0])
    assert np.array_equal(columns("log.csv")["error.z"], log.topics["error"]["z"])


def test_a_built_in_controller_reports_saturation_whoever_gives_the_reference():
    step = references.step(height=40)
    counts = []
    for reference in (step, lambda t: step(t)):
        simulation = quadrotor("eigen", xacro_args={"sim_slow": 1})
        pilot = ControllerPilot(controllers.geometric(), simulation, reference)
        fly(simulation, 1.0, None, 100, lambda table, wrenches: None, pilot=pilot)
        counts.append((pilot.updates, pilot.saturated))
    assert counts[0] == counts[1]
    assert counts[0][1] > 0


def test_a_reference_of_ones_own_and_one_of_quadcore_fly_alike():
    circle = references.circle()
    logs = []
    for reference in (circle, lambda t: circle(t)):
        simulation = quadrotor("eigen")
        logs.append(simulation.run(0.5, controller="indi", reference=reference))
    assert np.array_equal(logs[0].table, logs[1].table)
    assert np.array_equal(logs[0].topics["error"]["x"], logs[1].topics["error"]["x"])


def test_a_log_may_be_thinner_than_the_pieces_of_a_flight():
    log = quadrotor("eigen").run(0.5, controller="pd", reference="circle", log_every=100)
    assert log.topics["error"]["x"].shape == (6,)


def test_without_reference_it_hovers_where_it_begins(capsys):
    said = run_main(
        capsys, "--controller", "geometric", "--spawn", "1,2,7,0,0,0.5", "--duration", "8"
    )
    assert said["reference"] == "hover at the spawn"
    assert np.allclose(
        [float(x) for x in said["final position"][:-2].split(",")], [1, 2, 7], atol=1e-3
    )
    assert float(said["final roll, pitch, yaw"].split(",")[2][:-4]) == pytest.approx(28.65, abs=0.1)


def test_a_spawn_beside_the_reference_is_where_the_flight_begins(capsys):
    arguments = ["--controller", "geometric", "--reference", "circle", "--spawn", "0,0,10"]
    said = run_main(capsys, *arguments, "--duration", "1", "--log", "log.csv")
    assert "begins" not in said["reference"]
    assert columns("log.csv")["x"][0] == 0


@pytest.mark.parametrize("own", ["own:Hover", "own:constant"])
def test_a_controller_of_ones_own_flies(capsys, own):
    said = run_main(capsys, "--controller", own, "--duration", "0.3")
    assert said["controller"].startswith(own)


def test_updates_that_reach_the_limit_of_the_motors_are_counted(capsys):
    limited = ["--set", "motorpid_plugin.maxVelocity=400"]
    said = run_main(capsys, "--controller", "own:constant", "--duration", "0.2", *limited)
    assert said["saturated updates"] == "100 of 100"


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        ("--controller nomodule:X", 2, "there is no module 'nomodule'"),
        ("--controller own:Nope", 2, "module 'own' has no 'Nope'"),
        ("--controller own:three", 2, "cannot be called as controller(t, state, reference)"),
        ("--controller own:Wrong", 2, "cannot be called as controller(t, state, reference)"),
        ("--controller own:Asks", 2, "missing 1 required positional argument"),
        ("--controller own:Slotted --delay 0.1", 2, "its delay cannot be set"),
        ("--controller own:Raises", 3, "t = 0.000000 s: controller: ValueError: no idea (/"),
        ("--controller own:Nan", 3, "the command for rotor 1 is not a finite number. Return 4"),
        ("--controller own:Short", 3, "has 2 rotor speeds. Return 4"),
        (
            "--controller geometrc",
            2,
            "controller 'geometrc' does not exist. Did you mean 'geometric'?",
        ),
        ("--controller pd:kp=1", 2, "has no parameter 'kp'"),
        ("--controller pd:kp_xy=x", 2, "'kp_xy=x' is not of the form KEY=NUMBER"),
        ("--controller nope.yaml", 2, "nope.yaml: the file cannot be read"),
        (
            "--controller pd --reference spirl",
            2,
            "'spirl' does not exist. Did you mean 'spiral'?",
        ),
        ("--controller pd --reference series", 2, "reference 'series' has no rows. Write series:"),
        ("--controller pd --reference spiral:rad=1", 2, "has no parameter 'rad'"),
        ("--controller pd --reference nope.csv", 2, "nope.csv: the file cannot be read"),
        ("--reference spiral", 2, "--reference requires a controller"),
        ("--delay 0.1", 2, "--delay requires a controller"),
        ("--controller pd --commands w.csv", 2, "Give one of them"),
        ("--controller pd --delay -1", 2, "-1 is less than 0"),
        ("--controller pd --controller-rate 0", 2, "0 is not greater than 0"),
    ],
)
def test_what_cannot_fly_is_one_line(capsys, arguments, status, says):
    Path("w.csv").write_text("t,w1,w2,w3,w4\n0,1,1,1,1\n")
    assert main([*FLY, "--duration", "0.5", *arguments.split()]) == status
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1
    assert errors[0].startswith("error: ")
    assert says in errors[0]


def test_a_flight_whose_controller_raises_keeps_its_log(capsys):
    assert main([*FLY, "--controller", "own:Nan", "--log", "log.csv"]) == 3
    assert columns("log.csv")["t"][-1] == pytest.approx(0.11)


def test_pictures_show_the_reference(capsys):
    run_main(
        capsys, "--controller", "pd", "--reference", "circle", "--duration", "0.5", "--out", "out"
    )
    assert Path("out/error.png").read_bytes()[:4] == b"\x89PNG"


def test_a_topic_with_the_name_of_an_output_is_refused():
    simulation = quadrotor("eigen")
    with pytest.raises(qc.InputError, match="topic"):
        simulation.run(0.1, controller="pd", reference="circle", topics=["reference"])


def test_plans_of_guided_flights_fly_elsewhere_and_have_fingerprints():
    plan = qc.FlightPlan.of(
        engine="eigen",
        duration=0.3,
        controller=controllers.geometric(),
        reference=references.circle(),
        on_reference=True,
    )
    again = pickle.loads(pickle.dumps(plan))
    assert np.array_equal(plan.fly().table, again.fly().table)
    assert plan.fingerprint() == again.fingerprint()
    other = qc.FlightPlan.of(
        engine="eigen", duration=0.3, controller=controllers.geometric(kp_xy=9),
        reference=references.circle(), on_reference=True,
    )  # fmt: skip
    assert other.fingerprint() != plan.fingerprint()
    own = qc.FlightPlan.of(controller=lambda t, state, reference: [0, 0, 0, 0])
    with pytest.raises(qc.InputError, match="your own has no fingerprint"):
        own.fingerprint()
