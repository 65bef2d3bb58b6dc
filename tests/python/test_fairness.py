"""Fairness: what a controller may know and do in a study, and who is marked."""

from __future__ import annotations

import csv
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.evaluate.trial import Trial
from quadcore.studies.measured_flight import fly_and_measure
from quadcore.studies.options import EvaluateOptions

OWN = """
import quadcore as qc

class Honest:
    def reset(self, vehicle):
        self.inner = qc.controllers.geometric()
        self.inner.reset(vehicle)
    def __call__(self, t, state, reference):
        return self.inner(t, state, reference)

class ReadsState(Honest):
    def reset(self, sim):
        super().reset(sim)
        self.state = sim.state
    def __call__(self, t, state, reference):
        return self.inner(t, self.state, reference)

class Moves(Honest):
    def reset(self, sim):
        super().reset(sim)
        state = sim.state.copy()
        state.position = [0, 0, 10]
        sim.set_state(state)

class Pushes(Honest):
    def reset(self, sim):
        super().reset(sim)
        self.sim = sim
    def __call__(self, t, state, reference):
        self.sim.publish("push", [0, 0, 1, 0, 0, 0])
        return super().__call__(t, state, reference)

class Heals(Pushes):
    def __call__(self, t, state, reference):
        self.sim.publish("fault", {"rotor": 1, "effectiveness": 1, "power": 1})
        return Honest.__call__(self, t, state, reference)

class Peeks(Honest):
    def __call__(self, t, state, reference):
        return self.inner(t, state.topic.__self__.state, reference)

class ReadsFault(Honest):
    def __call__(self, t, state, reference):
        state.topic("effectiveness")
        return self.inner(t, state, reference)

class Measures(Honest):
    def reset(self, vehicle):
        super().reset(vehicle)
        from quadcore.studies import measured_flight, tracking_metrics
        def measure(*_):
            return dict.fromkeys(tracking_metrics.UNITS, 0.0)
        measured_flight.measure = tracking_metrics.measure = measure
"""
CHEATS = {
    "ReadsState": "has no 'state'",
    "Moves": "has no 'state'",
    "Pushes": "topic 'push' belongs to the scenario",
    "Heals": "topic 'fault' belongs to the scenario",
    "Peeks": "has no 'state'",
    "ReadsFault": "topic 'effectiveness' belongs to the scenario",
}
SCENARIO = """
plugins:
  odometry: {positionNoise: 0.005}
  fault: {detection: 0.1}
events:
  - {at: 0.5, push: [0, 0, 0.5], lasts: 0.1}
  - {at: 0.6, weaken: 1, to: 0.99}
"""
OPTIONS = EvaluateOptions(duration=0.5, xacro_args={"sim_slow": 1})
FLIGHT = ["--xacro", "sim_slow:=1", "--duration", "1", "--reference", "circle", "--scenario"]
FLIGHT += ["pushed.yaml", "--quiet", "--no-plots"]


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "pushed.yaml").write_text(SCENARIO)
    monkeypatch.delitem(sys.modules, "own", raising=False)


def table(*more, names=("Honest", *CHEATS, "Measures")):
    text = ",".join(["geometric", *(f"own:{name}" for name in names)])
    status = main(["evaluate", "--controller", text, *FLIGHT, "--out", "out", *more])
    with open("out/table.csv") as stream:
        return status, {row["controller"]: row for row in csv.DictReader(stream)}


def test_privileged_controllers_are_refused_and_measured_like_all_others():
    status, rows = table()
    assert status == 3
    for name, says in CHEATS.items():
        assert says in rows[f"own:{name}"]["failure"], name
        assert "--privileged" in rows[f"own:{name}"]["failure"]
    honest = float(rows["geometric"]["rms_position"])
    assert honest > 1e-3
    for name in ("Honest", "Measures"):
        assert rows[f"own:{name}"]["failure"] == ""
        assert float(rows[f"own:{name}"]["rms_position"]) == honest


def test_privileged_controllers_fly_with_the_option_and_are_marked_everywhere(capsys):
    flying = ("Honest", "ReadsState", "Pushes", "Heals", "Measures")
    status, rows = table("--privileged", names=flying)
    assert status == 0
    assert set(rows) == {"geometric", *(f"own:{name} (privileged)" for name in flying)}
    state = float(rows["own:ReadsState (privileged)"]["rms_position"])
    assert state < float(rows["geometric"]["rms_position"])
    page = Path("out/report.html").read_text()
    assert "own:ReadsState (privileged)" in page and "geometric (privileged)" not in page
    # The measurement is out of reach of privileged controllers, too.
    same = rows["own:Measures (privileged)"]["rms_position"]
    assert same == rows["own:Honest (privileged)"]["rms_position"]


def test_sweeps_and_searches_give_the_view_as_well(capsys):
    sweep = ["sweep", "--controller", "own:ReadsState", "--vary", "controller.rate=200,500"]
    assert main([*sweep, *FLIGHT, "--out", "swept"]) == 3
    assert "has no 'state'" in Path("swept/table.csv").read_text()
    assert main([*sweep, *FLIGHT, "--out", "marked", "--privileged"]) == 0
    assert "own:ReadsState (privileged)" in Path("marked/table.csv").read_text()
    capsys.readouterr()


def test_searches_refuse_the_simulation_and_mark_it_in_the_gains(capsys):
    Path("tuned.py").write_text(
        OWN
        + """
class Tuned(ReadsState):
    kp = 4.0
    def __call__(self, t, state, reference):
        return super().__call__(t, state, reference)
"""
    )
    tune = ["tune", "tuned.py:Tuned", "--free", "kp", "--budget", "1", "-o", "gains.yaml"]
    tune += ["--xacro", "sim_slow:=1", "--duration", "0.2", "--reference", "circle"]
    tune += ["--hold-out", "hover", "--quiet"]
    assert main(tune) == 3
    assert "has no 'state'" in capsys.readouterr().err
    assert main([*tune, "--privileged"]) == 0
    assert "privileged: true" in Path("gains.yaml").read_text()


def test_margins_give_the_nominal_model_with_the_sensors_of_the_flight():
    Path("sensed.py").write_text(
        OWN
        + """
class Sensed(Honest):
    def reset(self, vehicle):
        super().reset(vehicle)
        self.vehicle = vehicle
    def __call__(self, t, state, reference):
        assert self.vehicle.topic("odom")["z"] == state.position[2]
        return super().__call__(t, state, reference)
"""
    )
    plan = Plan(["sensed.py:Sensed"], "circle", ["eigen"], ["quadrotor"], {}, OPTIONS)
    outcome = fly_and_measure(partial(Trial(0, thrust=1.1).make_plan, plan), 60)
    assert outcome.failure == ""


def test_the_view_has_the_parameters_of_the_vehicle_and_its_sensors():
    sim = qc.Simulation("hummingbird", engine="eigen")
    view = sim.vehicle
    assert view.mass == sim.mass
    assert np.array_equal(view.gravity, sim.gravity)
    assert np.array_equal(view.hover_speed, sim.hover_speed)
    assert view.vehicle is view
    assert "odom" in view.topics
    assert view.topic("odom") == sim.topic("odom")
    assert view.rotors[0].joint == sim.rotors[0].joint
    for name in ("state", "step", "snapshot", "command", "set_state"):
        assert not hasattr(view, name)
        assert hasattr(sim, name)
    with pytest.raises(AttributeError, match=r"has no 'state'\. Use the odometry"):
        _ = view.state
