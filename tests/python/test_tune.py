"""Gains by search: what is found, judged, refused, kept, and written."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import yaml

import quadcore as qc
from quadcore.cli import main, terminal
from quadcore.control import gains
from quadcore.studies.tune import problem

pytest.importorskip("cma")

SHORT = {"duration": 4.0, "xacro_args": {"sim_slow": 1}}
FLIGHT = ["--duration", "4", "--xacro", "sim_slow:=1", "--quiet"]


def tenth(name="pd"):
    """A controller whose gains are a tenth of the defaults."""
    (table,) = (specs for controller, _, specs in qc._core.controllers() if controller == name)
    numbers = {s.name: float(s.default) / 10 for s in table if s.name[:3] in ("kp_", "kd_")}
    assert len(numbers) == 8
    return getattr(qc.controllers, name)(**numbers)


def largest(controller, reference):
    """Largest distance from a reference over 6 s, m."""
    sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    sim.set_state(qc.references.start(sim, reference))
    log = sim.run(6.0, controller=controller, reference=reference, log_every=10)
    wanted = np.array([reference(t).position for t in log.time])
    return np.linalg.norm(log.position - wanted, axis=1).max()


@pytest.fixture(scope="module")
def found():
    return qc.tune(tenth(), budget=40, seed=3, processes=2, **SHORT)


def test_gains_ten_times_too_small_become_gains_that_fly_what_was_held_out(found):
    controller = found.gains.make()
    for reference in (qc.references.circle(), qc.references.eight()):
        assert largest(controller, reference) < 0.5 * largest(tenth(), reference)
    assert set(found.held_out) == {"circle", "eight"}
    assert found.error < 0.7 * found.start


def test_flights_on_a_batch_give_the_results_of_single_flights(monkeypatch, tmp_path):
    options = {"budget": 3, "seed": 5, "processes": 1, "seeds": 2, **SHORT, "duration": 2.0}
    options["parameters"] = {"odometry.positionNoise": 0.002}
    notes = tmp_path / "notes"
    fly_group = problem.fly_group

    def note(flights, limit):
        records = fly_group(flights, limit)
        with notes.open("a") as file:  # in another process
            file.write(f"{records is not None} {len(flights)}\n")
        return records

    monkeypatch.setattr(problem, "fly_group", note)
    together = qc.tune(tenth(), **options)
    grouped = [line.split() for line in notes.read_text().splitlines()]
    assert all(flew == "True" for flew, _ in grouped)
    assert sum(int(count) for _, count in grouped) > 10
    monkeypatch.setattr(problem, "fly_group", lambda flights, limit: None)
    alone = qc.tune(tenth(), **options)
    assert together == alone


def test_the_same_seed_gives_the_same_gains_whatever_the_processes(found):
    np.random.seed(1)  # whose state has no say
    again = qc.tune(tenth(), budget=40, seed=3, processes=1, **SHORT)
    assert again == found
    other = qc.tune(tenth(), budget=10, seed=4, held_out=["hover"], **SHORT)
    assert other.evaluations[0] == found.evaluations[0]
    assert other.evaluations[1] != found.evaluations[1]


def test_what_was_found_is_written_with_its_history_and_read_back(found, tmp_path):
    gains.write(found.gains, tmp_path / "pd.yaml")
    back = gains.read(tmp_path / "pd.yaml")
    assert back.parameters == found.gains.parameters
    assert (back.law, back.vehicle, back.rate) == ("pd", "quadrotor", 500)
    history = yaml.safe_load((tmp_path / "pd.yaml").read_text())["history"]
    assert history["tuned_on"] == ["spiral", "step"]
    assert history["held_out"] == found.held_out
    assert history["evaluations"] == found.evaluations and len(found.evaluations) >= 40
    assert min(found.evaluations) <= history["best"] == found.error
    assert (history["models"], history["xacro_args"]) == (["quadrotor"], {"sim_slow": 1})
    assert (history["dt"], history["duration"], history["quadcore"]) == (0.001, 4, qc.__version__)
    assert (history["seed"], history["budget"], history["start"]["kp_xy"]) == (3, 40, 0.24)


def test_gains_that_lose_a_held_out_case_are_refused():
    far = qc.references.step(dx=40.0, time=0.1)  # lost from the first moment on
    with pytest.raises(
        qc.FlightError, match=r"no acceptable gains found: .* fail on far: lost at"
    ) as caught:
        qc.tune("pd", budget=3, references=["hover"], held_out=[_named("far", far)], **SHORT)
    assert len(caught.value.evaluations) >= 3


def test_gains_that_do_not_bring_a_vehicle_back_are_refused():
    """On its reference, in still air, a controller with a perfect model needs almost no gains."""
    weak = qc.controllers.pd_compensated(kp_xy=0.02, kd_xy=0.02, kp_z=0.02, kd_z=0.02)
    with pytest.raises(qc.FlightError, match="do not return to hover from an offset") as caught:
        qc.tune(weak, budget=1, references=["ramp"], held_out=["hover"], **SHORT)
    assert caught.value.evaluations[0] < 5  # it is not lost
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    log = simulation.run(4.0, controller=weak, reference="hover", on_reference=True, log_every=10)
    assert np.abs(log.topics["error"]["x"]).max() < 1e-6


def _named(name, shape):
    def reference(t):
        return shape(t)

    reference.__name__ = name
    return reference


def test_other_models_judge_too(tmp_path):
    text = qc.read_model("quadrotor", {"sim_slow": 1}).document.text
    (tmp_path / "own.urdf").write_text(text)
    model = tmp_path / "own.urdf"
    found = qc.tune(
        "pd", model, references=["hover"], held_out=["ramp"], held_out_models=["quadrotor"],
        only=["kp_xy", "kd_xy"], budget=1, duration=1.0,
    )  # fmt: skip
    assert set(found.held_out) == {
        f"ramp, {model}", "hover, quadrotor", "ramp, quadrotor"
    }  # fmt: skip
    assert set(found.gains.history["start"]) == {"kp_xy", "kd_xy"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"controller": "pidd"}, "controller 'pidd' does not exist"),
        ({"controller": "controllers:Mine"}, "controllers"),
        ({"controller": "pd:spins=1"}, "controller 'pd' has no parameter 'spins'"),
        ({"only": ["kp_xz"]}, "controller 'pd' has no parameter 'kp_xz'. Use some of scale, kp_xy"),
        ({"only": ["ki_xy"]}, "ki_xy is 0. Start with more than 0."),
        ({"only": ["drag"]}, "no parameter 'drag'"),
        (
            {"held_out": ["spiral"]},
            "reference 'spiral' is both a training and a held-out reference",
        ),
        ({"references": ["step", "step"]}, "reference 'step' is named twice"),
        ({"references": []}, "tuning requires a model, a reference"),
        ({"references": ["stair"]}, "reference 'stair' does not exist"),
        ({"budget": 0}, "budget is 0. Give at least 1."),
        ({"engine": "odd"}, "odd"),
        ({"engine": 5}, "engine is 5. Give a name"),
        ({"model": 5}, "model is 5. Give a name, or several"),
        ({"references": 5}, "references is 5. Give names, or functions that are called as"),
        ({"held_out": [5]}, r"held_out is \[5\]. Give names, or functions"),
        (
            {"references": "hover", "held_out": "hover"},
            "'hover' is both a training and a held-out reference",
        ),
        ({"only": 5}, "only is 5. Give a name, or several"),
        ({"only": "kp_xz"}, "has no parameter 'kp_xz'"),
        ({"budget": 1.5}, "budget is 1.5. Give a whole number"),
        ({"processes": 0}, "processes is 0. Give a whole number from 1 on"),
        ({"commands": 3}, "option 'commands' does not exist"),
    ],
)
def test_what_cannot_be_tuned_is_refused_before_any_flight(arguments, message):
    with pytest.raises(qc.InputError, match=message):
        qc.tune(**{"controller": "pd", "budget": 1, **SHORT, **arguments})


def test_without_the_optimiser_the_package_to_install_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "cma", None)
    with pytest.raises(qc.InputError, match=r"pip install 'quadcore\[tune\]'"):
        qc.tune("pd", budget=1, **SHORT)


@pytest.mark.usefixtures("in_empty_folder")
class TestCommand:
    def test_it_writes_a_gains_file_that_flies(self):
        assert main(["tune", "pd", "-o", "pd.yaml", "--budget", "1", *FLIGHT]) == 0
        assert gains.read_controller("pd.yaml").parameters["kp_xy"] == 2.4
        assert main(["tune", "pd.yaml", "-o", "again.yaml", "--budget", "1", *FLIGHT]) == 0

    def test_an_interrupt_keeps_the_best_so_far(self, monkeypatch, capsys):
        @contextmanager
        def interrupting(*_):
            def report(done, _):
                if done > 1:
                    raise KeyboardInterrupt

            yield report

        monkeypatch.setattr(terminal, "show_progress", interrupting)
        assert main(["tune", "pd", "-o", "pd.yaml", "--budget", "500", *FLIGHT]) == 130
        assert "best gains so far: pd.yaml" in capsys.readouterr().err
        history = yaml.safe_load(Path("pd.yaml").read_text())["history"]
        assert history["ended"] == "interrupted" and 1 < len(history["evaluations"]) < 50

    def test_without_gains_that_keep_everything_there_is_no_file(self, capsys):
        far = ["--reference", "hover", "--hold-out", "step:dx=40,time=0.1"]
        assert main(["tune", "pd", "-o", "pd.yaml", "--budget", "1", *far, *FLIGHT]) == 3
        assert (
            "error: no acceptable gains found: the best candidates fail on step"
            in capsys.readouterr().err
        )
        assert not list(Path().iterdir())

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["pd", "-o", "pd.txt"], "pd.txt: is not a YAML file. Name a file that ends in .yaml"),
            (["pd", "-o", "no/pd.yaml"], "folder no does not exist"),
            (["nothing", "-o", "pd.yaml"], "controller 'nothing' does not exist"),
            (["pd", "no.urdf", "-o", "pd.yaml"], "no.urdf: neither a file"),
            (
                ["pd", "-o", "pd.yaml", "--hold-out", "step"],
                "both a training and a held-out reference",
            ),
        ],
    )
    def test_what_is_wrong_is_one_line_and_leaves_no_file(self, arguments, message, capsys):
        assert main(["tune", *arguments, *FLIGHT]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert message in line and line.startswith("error: ")
        assert not list(Path().iterdir())
