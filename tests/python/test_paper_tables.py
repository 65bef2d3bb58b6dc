"""Ranks over all cells, beside scipy, and tables with controllers as columns."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from evaluations import FLY, evaluate
from scipy import stats

from quadcore.cli import main
from quadcore.studies.evaluate.intervals import compute_effect_size
from quadcore.studies.evaluate.paper_tables import make_latex, make_rows
from quadcore.studies.evaluate.ranks import describe_ranks, rank_controllers


def study(errors):
    """Statistics of a study; `errors` has a row per cell and a column per controller."""
    return [
        {
            "controller": f"law{i}", "reference": f"path{j}", "engine": "eigen", "model": "m",
            "scenario": "", "flights": 1, "failure_rate": float(np.isinf(value)),
            "mean_final_position": value,
        }
        for i, column in enumerate(np.transpose(errors))
        for j, value in enumerate(column)
    ]  # fmt: skip


def test_ranks_and_tests_are_those_of_scipy():
    errors = np.random.default_rng(3).gamma(2, 0.1, size=(9, 4))
    errors += np.array([0, 0.3, 0.1, 0])
    errors[2, 1] = errors[2, 0]
    found = rank_controllers(study(errors))
    means = dict(zip(found.controllers, found.mean_ranks))
    expected = stats.rankdata(errors, axis=1).mean(axis=0)
    assert [means[f"law{i}"] for i in range(4)] == pytest.approx(expected)
    assert found.mean_ranks == sorted(found.mean_ranks)
    statistic, p_value = stats.friedmanchisquare(*errors.T)
    assert found.p_value == pytest.approx(p_value)
    assert found.agreement == pytest.approx(statistic / (9 * 3))


def test_the_post_hoc_test_has_the_critical_differences_of_demsar():
    # Table 5a of Demsar (2006): 2.569 for four controllers at 5 %.
    cells, count = 10, 4
    critical = 2.569 * np.sqrt(count * (count + 1) / (6 * cells))
    ranks = rank_controllers(study(np.tile([1.0, 2, 3, 4], (cells, 1))))
    assert ranks.mean_ranks == [1, 2, 3, 4] and ranks.agreement == pytest.approx(1)
    for (one, other), p_value in ranks.post_hoc.items():
        distance = abs(int(one[-1]) - int(other[-1]))
        assert (p_value < 0.05) == (distance > critical)
    assert "law0 and law2" in describe_ranks(ranks, 0.95)[-1]


def test_failures_are_last_and_noise_is_a_tie():
    ranks = rank_controllers(study([[1, 1 + 1e-12, np.inf], [2, 2 - 1e-12, 3]]))
    assert dict(zip(ranks.controllers, ranks.mean_ranks)) == {"law0": 1.5, "law1": 1.5, "law2": 3}
    assert np.isnan(rank_controllers(study([[1, 2]] * 5)).p_value)
    assert describe_ranks(rank_controllers(study([[1, 2, 3]])), 0.95) == []


def test_the_effect_size_is_the_mean_over_the_deviation():
    assert compute_effect_size(np.array([1.0, 2.0, 3.0])) == 2
    assert np.isnan(compute_effect_size(np.array([1.0, 1.0])))


def test_controllers_are_columns_of_the_tables(in_empty_folder):
    command = ["--controller", "pd,geometric", "--reference", "hover,circle", "--seeds", "2"]
    noise = ["--set", "odometry.positionNoise=1e-4"]
    assert main([*FLY, *command, *noise, "--out", "out", "--no-plots", "--quiet"]) == 0
    rows = list(csv.DictReader(Path("out/comparison.csv").read_text().splitlines()))
    errors = {row["reference"]: row for row in rows if row["metric"] == "rms_position"}
    assert list(errors) == ["hover", "circle"]
    for row in errors.values():
        assert float(row["geometric low"]) < float(row["geometric"]) < float(row["geometric high"])
        assert row["pd failed"] == "0"
    text = Path("out/comparison.tex").read_text()
    assert text.count(r"\begin{tabular}{lrr}") == 3
    assert r"reference & pd & geometric \\" in text and r"\pm" in text and r"\mathbf" in text


def test_failures_and_special_characters_are_legible_in_latex():
    controllers = {"a_b": "pd", "lost": lambda t, state, reference: [900, -100, 900, -100]}
    found = evaluate(controllers, "hover", duration=3.0)
    text = make_latex(found.groups)
    assert r"a\_b & lost \\" in text and "1 of 1 failed" in text
    header, first, *_ = make_rows(found.groups)
    assert dict(zip(header, first))["lost failed"] == 1
