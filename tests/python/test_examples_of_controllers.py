"""Controllers from outside: a plugin built out of the tree, and a learned policy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from builds import build_once
from flights import ENGINES
from hooked import with_plugins
from vehicles import plugin

import quadcore as qc
from quadcore.cli import main

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
OPPOSING = {"drone_plugin.reactionTorque": "opposing"}


def away(log, reference):
    """Distance from a reference, m."""
    wanted = np.array([reference(t).position for t in log.time])
    return np.linalg.norm(log.position - wanted, axis=1)


@pytest.fixture(scope="module")
def plugin_folder(tmp_path_factory):
    return build_once(EXAMPLES / "controller_plugin", tmp_path_factory)


@pytest.fixture
def guided_urdf(plugin_folder, tmp_path, monkeypatch):
    monkeypatch.setenv("QUADCORE_PLUGIN_PATH", str(plugin_folder))
    text = qc.read_model("quadrotor", {"sim_slow": 1}).document.text
    controller = plugin("tilt_controller", {"rate": 400})
    file = tmp_path / "guided.urdf"
    circle = plugin("reference", {"shape": "circle", "rate": 0.7})
    file.write_text(with_plugins(text, controller, circle))
    return file


@pytest.mark.parametrize("engine", ENGINES)
def test_a_controller_built_outside_the_tree_flies_a_circle(engine, guided_urdf):
    circle = qc.references.circle(rate=0.7)
    sim = qc.Simulation(guided_urdf, engine=engine)
    sim.set_state(qc.references.start(sim, circle))
    log = sim.run(8.0, log_every=10)
    assert 0 < away(log, circle).max() < 0.1
    assert np.abs(np.diff(log.orientation, axis=0)).max() < 0.01


def test_it_goes_on_from_a_snapshot_and_from_upside_down(guided_urdf):
    sim = qc.Simulation(guided_urdf, engine="eigen", spawn=(2, 0, 10, 3.1, 0, 0))
    sim.run(0.4)
    snapshot = sim.snapshot()
    expected = sim.run(5.6)
    assert away(expected, qc.references.circle(rate=0.7))[-1] < 0.1
    sim.restore(snapshot)
    assert sim.run(5.6).table.tobytes() == expected.table.tobytes()


@pytest.fixture
def in_folder_of_policy(monkeypatch):
    pytest.importorskip("foundation_policy", reason="needs foundation-policy, which pip has")
    monkeypatch.chdir(EXAMPLES / "learned_policy")
    monkeypatch.syspath_prepend(str(EXAMPLES / "learned_policy"))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sim_slow", [1, 10])
def test_the_learned_policy_hovers_within_2_cm(engine, sim_slow, in_folder_of_policy):
    from learned_policy import Policy

    hover = qc.references.hover()
    sim = qc.Simulation(
        "quadrotor", engine=engine, xacro_args={"sim_slow": sim_slow}, parameters=OPPOSING,
        spawn=(0.5, -0.4, 9.6, 0.3, -0.2, 0.1),
    )  # fmt: skip
    log = sim.run(6.0, controller=Policy(), reference=hover, log_every=10)
    assert away(log, hover)[0] > 0.7
    assert away(log, hover)[log.time > 3].max() < 0.02


def test_the_learned_policy_is_a_row_of_an_evaluation(in_folder_of_policy, tmp_path):
    evaluation = qc.evaluate(
        ["geometric", "learned_policy:Policy"], "circle:rate=0.8,radius=1", parameters=OPPOSING,
        duration=6.0,
    )  # fmt: skip
    ours, learned = evaluation.table
    assert (learned["controller"], learned["failure"]) == ("learned_policy:Policy", "")
    assert ours["rms_position"] < learned["rms_position"] < 0.1


def test_the_learned_policy_says_what_it_cannot_fly(in_folder_of_policy, capsys):
    arguments = ["quadrotor", "--controller", "learned_policy:Policy", "--engine", "eigen"]
    assert main(["run", *arguments, "--duration", "1", "--quiet"]) == 2
    assert "set drone_plugin.reactionTorque" in capsys.readouterr().err


def test_the_main_job_flies_what_its_settings_say(tmp_path, monkeypatch):
    """For a second, in which nothing is lost yet."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    import spiral

    from quadcore.report.plots import png

    monkeypatch.setitem(spiral.SETTINGS, "duration", 1.0)
    logs = spiral.fly()
    assert {controller for controller, _ in logs} == set(spiral.STYLES)
    assert {engine for _, engine in logs} == set(ENGINES)
    for (controller, _), log in logs.items():
        assert 0 < spiral.tracking_error(log).max() < (1e-3 if controller == "geometric" else 0.1)
    assert png(spiral.picture(logs)).startswith(b"\x89PNG")


def test_the_predictive_controller_beats_feedback_without_its_feed_forward(monkeypatch):
    monkeypatch.chdir(EXAMPLES / "nmpc")
    evaluation = qc.evaluate(
        ["nmpc.py", "geometric:feed_forward=false"], "circle:radius=2,rate=1.5", duration=5.0,
        xacro_args={"sim_slow": 1},
    )  # fmt: skip
    predictive, feedback = evaluation.table
    assert predictive["failure"] == feedback["failure"] == ""
    assert predictive["rms_position"] < 0.5 * feedback["rms_position"]
