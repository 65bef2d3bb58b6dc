"""Sensitivities of sweeps: what the PAWN index sees, beside SALib and beside rank correlations."""

from __future__ import annotations

import numpy as np
import pytest

import quadcore as qc
from quadcore.studies.ranking import rank_values
from quadcore.studies.sweep.pawn import compute_pawn
from quadcore.studies.sweep.plots import _draw_surface, _leading_axes


@pytest.fixture(scope="module")
def valley():
    """A result that depends on the first of three parameters, around its mean."""
    draw = np.random.default_rng(0)
    points = draw.random((1000, 3))
    return points, np.abs(points[:, 0] - 0.5) + 0.02 * draw.normal(size=1000)


def test_the_pawn_index_is_that_of_salib(valley):
    pawn = pytest.importorskip("SALib.analyze.pawn")
    points, values = valley
    problem = {"num_vars": 3, "names": list("abc"), "bounds": [[0, 1]] * 3}
    expected = pawn.analyze(problem, points, values, S=10)["mean"]
    found = [compute_pawn(column, values).value for column in points.T]
    assert found == pytest.approx(expected, abs=0.012)  # a level of the distribution


def test_only_a_parameter_with_an_effect_exceeds_the_noise(valley):
    points, values = valley
    first, *others = (compute_pawn(column, values) for column in points.T)
    assert first.value > 5 * first.noise and first.interval < 0.05
    assert all(other.value < other.noise for other in others)
    without = [
        compute_pawn(column, values) for column in np.random.default_rng(1).random((200, 1000))
    ]
    assert np.mean([each.value < each.noise for each in without]) == pytest.approx(0.95, abs=0.03)


def test_an_index_needs_rows_that_differ():
    assert np.isnan(compute_pawn(np.arange(8.0), np.arange(8.0)).value)
    assert np.isnan(compute_pawn(np.arange(50.0), np.ones(50)).value)
    assert np.isnan(compute_pawn(np.ones(50), np.arange(50.0)).value)
    values = np.r_[np.arange(40.0), [np.nan] * 10]
    assert compute_pawn(np.arange(50.0), values) == compute_pawn(np.arange(40.0), values[:40])
    # Two listed values are two slices; the distance from the whole is a half.
    assert compute_pawn(np.repeat([0.0, 1], 30), np.arange(60.0)).value == pytest.approx(0.5)


def test_a_model_error_that_rank_correlation_misses_ranks_first():
    found = qc.sweep(
        "geometric",
        "circle",
        {
            "controller.believed_mass": "normal:1:1e-4",
            "controller.believed_drag": "uniform:0.9:1.1",
            "controller.believed_thrust": "uniform:0.9:1.1",
        },
        samples=150,
        duration=1.0,
        xacro_args={"sim_slow": 1},
        processes=1,
    )
    rows = [row for row in found.sensitivities if row["measure"] == "rms_position"]
    assert rows[0]["axis"] == "controller.believed_thrust"
    assert abs(rows[0]["rank"]) < 0.3 and rows[0]["pawn"] > 2 * rows[0]["pawn_noise"]
    assert _leading_axes(rows)[0] == "controller.believed_thrust"  # of the response surface


def test_the_surface_of_an_axis_with_a_narrow_range_has_its_label():
    backend = pytest.importorskip("matplotlib.backends.backend_agg")
    x, y = np.random.default_rng(0).random((2, 50))
    columns = {"a": x, "frame.mass": 1 + 2e-4 * (y - 0.5), "rms": x + y}
    parts = [("", np.arange(50))]
    figure = _draw_surface(parts, columns, ["a", "frame.mass"], "rms", "rms (m)", "")
    backend.FigureCanvasAgg(figure).draw()
    label = figure.axes[0].yaxis.label
    assert label.get_text() == "frame.mass"
    assert label.get_window_extent().x0 > 0


@pytest.mark.parametrize("values", [[], [3, 1, 1, np.inf, np.inf, 1, -np.inf, 2], [7, 7]])
def test_ranks_are_those_of_scipy(values):
    expected = pytest.importorskip("scipy.stats").rankdata(values)
    assert rank_values(values).tolist() == expected.tolist()
