"""Statistics over seeds: coverage of intervals, Holm's correction, ties, flights without noise."""

from __future__ import annotations

import numpy as np
import pytest
from evaluations import evaluate
from scipy import stats

from quadcore.studies.evaluate.best_controllers import describe_seeds, mark_best
from quadcore.studies.evaluate.intervals import (
    adjust_p_values,
    compute_interval,
    compute_p_value,
)

NOISY = {"odometry.positionNoise": 0.0002106}


@pytest.fixture(scope="module")
def noisy_errors():
    """Tracking errors of 400 noisy flights of two controllers, by seed; shape (2, 400)."""
    found = evaluate(["pd", "geometric"], "circle", parameters=NOISY, seeds=400)
    values = [row["rms_position"] for row in found.table]
    return np.reshape(values, (2, 400))


@pytest.mark.parametrize("seeds", [2, 3, 5, 10, 20])
def test_intervals_of_noisy_flights_cover_what_they_state(noisy_errors, seeds):
    draw = np.random.default_rng(seeds)
    for values in (*noisy_errors, noisy_errors[1] - noisy_errors[0]):
        picks = (draw.choice(values, seeds, replace=False) for _ in range(4000))
        ends = np.array([compute_interval(pick) for pick in picks])
        assert 0.93 < np.mean((ends[:, 0] < values.mean()) & (values.mean() < ends[:, 1])) < 0.97


def test_intervals_and_p_values_are_those_of_scipy():
    values = np.random.default_rng(1).normal(0.4, 1, size=7)
    mean, error = values.mean(), stats.sem(values)
    assert compute_interval(values) == pytest.approx(stats.t.interval(0.95, 6, mean, error))
    assert compute_p_value(values) == pytest.approx(stats.ttest_1samp(values, 0).pvalue)
    assert np.isnan(compute_interval(values[:1])).all()
    assert np.isnan(compute_p_value(values[:1]))


def test_equal_differences_are_certain():
    assert compute_p_value(np.full(3, 1e-3)) == 0
    assert compute_p_value(np.full(3, 1e-10)) == 1


def test_holm_corrects_for_the_number_of_comparisons():
    # The example of Holm's step-down: 0.01 x 4, 0.02 x 3, 0.03 x 2, 0.04 x 1, each at least the
    # one before.
    assert adjust_p_values([0.01, 0.04, np.nan, 0.03, 0.02]) == pytest.approx(
        [0.04, 0.06, np.nan, 0.06, 0.06], nan_ok=True
    )
    assert adjust_p_values([0.9, 0.8]) == [1, 1]


def rank(*flights):
    """Mark the best of some controllers, given the errors of their flights by seed."""
    groups = [
        {"failure_rate": np.mean(np.isnan(values)), "mean_final_position": np.nanmean(values)}
        for values in flights
    ]
    mark_best(groups, flights)
    return [group["is_best"] for group in groups]


def test_the_best_are_those_that_nothing_beats_beyond_chance():
    noise = np.random.default_rng(2).normal(0, 1e-3, size=(2, 10))
    values = 0.02 + noise[0]
    assert rank(values, values + 1e-2, values + noise[1]) == [True, False, True]
    assert rank(values, np.where(noise[0] < 0, values - 1e-2, np.nan)) == [True, False]


def test_a_single_seed_stars_the_lowest_error_and_its_equals():
    assert rank([0.02 + 1e-12], [0.02], [0.020001]) == [True, True, False]


def test_seeds_without_noise_have_no_intervals_and_the_result_says_so():
    found = evaluate(["pd", "geometric"], "circle", seeds=3)
    for group in found.groups:
        assert group["is_random"] is False
        assert np.isnan([group["low_rms_position"], group["difference_low_rms_position"]]).all()
    assert describe_seeds(found.groups) == [
        "Nothing is random in these flights. Seeds have no effect, and there are no intervals."
    ]
    found = evaluate("pd", "circle", seeds=3, vary={"odometry.positionNoise": [0, 1e-3]})
    (note,) = describe_seeds(found.groups)
    assert note == (
        "Seeds change nothing in 1 of 2 combinations, which have no intervals: pd on circle "
        "(odometry.positionNoise=0)."
    )


def test_one_seed_states_that_intervals_need_more():
    found = evaluate("pd", "circle", parameters=NOISY)
    (note,) = describe_seeds(found.groups)
    assert "fewer than two" in note and "Use more seeds" in note
