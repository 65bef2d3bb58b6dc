"""The options that all studies share: the same in Python, on the command line and in files."""

from __future__ import annotations

import csv
import inspect
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
import yaml

import quadcore as qc
from quadcore.cli import main, make_parser
from quadcore.studies import options

STUDIES = {
    "evaluate": (qc.evaluate, options.EvaluateOptions),
    "compare": (qc.compare, options.CompareOptions),
    "sweep": (qc.sweep, options.SweepOptions),
    "tune": (qc.tune, options.ControlOptions),
}
GUIDED = ["--controller", "pd", "--reference", "hover"]
WORDS = {
    "evaluate": GUIDED,
    "compare": ["quadrotor", *GUIDED],
    "sweep": [*GUIDED, "--out", "out"],
    "tune": ["pd", "-o", "out.yaml", "--budget", "1"],
}


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def rows():
    with open("out/table.csv") as stream:
        return list(csv.DictReader(stream))


def test_type_checkers_see_the_options_that_there_are():
    inherited: dict = {}
    for kind, keywords in (
        (options.Options, options.Keywords),
        (options.ControlOptions, options.ControlKeywords),
        (options.CriteriaOptions, options.CriteriaKeywords),
        (options.EvaluateOptions, options.EvaluateKeywords),
    ):
        declared = {each.name: each.type for each in fields(kind)}
        inherited.update(keywords.__annotations__)
        assert declared == {name: kind.__forward_arg__ for name, kind in inherited.items()}


@pytest.mark.parametrize("study", STUDIES)
def test_signature_docstring_and_parser_have_every_option_with_its_default(study):
    function, kind = STUDIES[study]
    parameters, docstring = inspect.signature(function).parameters, inspect.getdoc(function)
    actions = next(iter(make_parser()._subparsers._group_actions)).choices[study]._actions
    by_flag = {flag: action for action in actions for flag in action.option_strings}
    for each in fields(kind):
        assert parameters[each.name].default == each.default
        assert f"\n{each.name}\n    {each.metadata['about'].meaning[0].upper()}" in docstring
        if each.name != "progress":
            action = by_flag[f"--{each.metadata['about'].flag}"]
            assert action.default == ([] if each.metadata["about"].repeats else each.default)
            assert action.help.startswith(each.metadata["about"].meaning)


@pytest.mark.parametrize("study", STUDIES)
def test_a_file_holds_the_options_of_every_study(study, capsys):
    Path("shared.yaml").write_text("duration: 0.2\nxacro: {sim_slow: 1}\nvary:\n  frame.mas: [1]\n")
    assert main([study, *WORDS[study], "--options", "shared.yaml"]) == 2
    assert "error: shared.yaml:4: " in capsys.readouterr().err
    Path("shared.yaml").write_text("duration: 0.2\ntime-limit: 1e12\n")
    assert main([study, *WORDS[study], "--options", "shared.yaml"]) == 2
    assert "time_limit is 1000000000000.0. Give seconds" in capsys.readouterr().err


def test_a_comparison_has_seeds_scenarios_and_values_of_the_controller():
    words = "--engine eigen --xacro sim_slow:=1 --duration 0.2 --quiet --no-plots --out out"
    given = ["--seeds", "2", "--scenario", "none,parcel", "--vary", "controller.delay=0,0.01"]
    noise = ["--set", "odometry.positionNoise=0.01"]
    assert main(["compare", "quadrotor", *GUIDED, *words.split(), *given, *noise]) == 0
    found = rows()
    assert [row["seed"] for row in found] == ["0", "1"] * 4
    assert [row["scenario"] for row in found] == ["none"] * 4 + ["parcel"] * 4
    assert [float(row["controller.delay"]) for row in found] == [0, 0, 0.01, 0.01] * 2
    assert len({row["rms_error"] for row in found}) == 8


def test_the_mathematical_model_is_compared_with_an_engine():
    found = qc.compare(
        "quadrotor",
        {"engine": ["eigen", "lagrange"]},
        controller="geometric",
        reference="hover",
        duration=0.2,
        xacro_args={"sim_slow": 1},
    )
    assert found.table["failure"].tolist() == ["", ""]
    assert 0 < found.table["final_position"][1] < 1e-3


def test_a_flight_of_a_comparison_that_does_not_end_in_time_is_a_row():
    def endless(t, state, reference):
        while t > 0.1:
            pass
        return [471.0, -471.0, 471.0, -471.0]

    found = qc.compare("quadrotor", {"engine": ["eigen"]}, controller=endless, time_limit=1.0)
    assert "not done within the time limit of 1 s" in found.table["failure"][0]


def test_evaluations_and_sweeps_take_scenarios_in_python():
    given = {"scenario": ["none", "parcel"], "duration": 0.1}
    found = qc.evaluate("pd", "hover", **given)
    assert [row["scenario"] for row in found.table] == ["none", "parcel"]
    swept = qc.sweep("pd", "hover", **given)
    assert swept.columns["scenario"].tolist() == ["none", "parcel"]
    for study in (qc.evaluate, qc.sweep):
        with pytest.raises(qc.InputError, match="vary scenario: --scenario is also given"):
            study("pd", "hover", vary={"scenario": ["gusty"]}, **given)


def test_gains_are_tuned_in_all_conditions():
    pytest.importorskip("cma")
    found = qc.tune(
        "pd",
        references=["hover"],
        held_out=["ramp"],
        vary={"frame.mass": [1.0, 1.1]},
        seeds=2,
        scenario="parcel",
        delay=0.004,
        budget=1,
        duration=1.0,
        parameters={"odometry.positionNoise": 0.001},
        xacro_args={"sim_slow": 1},
    )
    judged = [f"ramp, parcel frame.mass={m}, seed {s}" for m in ("1.0", "1.1") for s in (0, 1)]
    assert list(found.held_out) == judged
    assert len(set(found.held_out.values())) == 4
    assert found.gains.delay == 0.004
    qc.gains.write(found.gains, "pd.yaml")
    history = yaml.safe_load(Path("pd.yaml").read_text())["history"]
    assert (history["seeds"], history["delay"]) == (2, 0.004)
    assert history["vary"] == {"scenario": ["parcel"], "frame.mass": ["1.0", "1.1"]}
    plain = qc.tune("pd", references=["hover"], held_out=["ramp"], budget=1, duration=1.0)
    assert np.isfinite(plain.error) and "vary" not in plain.gains.history


def test_tuning_in_python_writes_no_log_either():
    with pytest.raises(qc.InputError, match="tuning writes no log"):
        qc.tune("pd", log_every=5)
