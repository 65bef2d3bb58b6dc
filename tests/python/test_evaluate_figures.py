"""Figures of an evaluation: one per reference and scenario, each controller in its own colour."""

from __future__ import annotations

import pytest
from evaluations import evaluate

from quadcore.studies.evaluate import evaluate as evaluation
from quadcore.studies.evaluate import plots
from quadcore.studies.evaluate.output import _describe_omitted_flights


@pytest.fixture(scope="module")
def found():
    own = {"pd": "pd", "lost": lambda t, state, reference: [900, -100, 900, -100], "lqr": "lqr"}
    vary = {"odometry.positionNoise": [0, 1e-3]}
    return evaluate(own, ["hover", "circle"], duration=2.0, seeds=2, vary=vary)


def test_each_reference_and_scenario_has_a_figure_with_all_controllers(found):
    groups = plots.group_flights(found)
    assert len(groups) == 4
    for flights in groups.values():
        assert [flight.label for flight in flights] == ["pd", "lost (failed)", "lqr"]
        assert [flight.style for flight in flights] == [0, 1, 2]
    assert _describe_omitted_flights(found) == ""
    assert plots.name_group(found, *next(iter(groups))) == (
        "hover, scenario odometry.positionNoise=0, seed 0"
    )


def test_omitted_figures_are_named_and_the_others_are_complete(monkeypatch):
    monkeypatch.setattr(evaluation, "_DRAWN", 5)
    found = evaluate(["pd", "lqr"], ["hover", "circle", "step"], duration=0.2)
    groups = plots.group_flights(found)
    assert [reference for reference, _ in groups] == ["hover", "step"]
    assert all(len(flights) == 2 for flights in groups.values())
    assert _describe_omitted_flights(found) == (
        "Plots and animations show 2 of 3 combinations of reference and scenario, each with all "
        "controllers. Omitted: circle."
    )


def test_margins_have_the_colours_of_their_controllers(found):
    margins = [{"controller": name} for name in ("lqr", "pd")]
    figure = plots._draw_rates(margins, [2, 0])
    lines = {line.get_label(): line.get_color() for line in figure.axes[0].lines}
    assert lines == {"lqr": plots.curve_style(2)["color"], "pd": plots.curve_style(0)["color"]}
    assert plots.is_plot("rates")
    drawn = plots.list_figures(found._replace(margins=margins))["rates"]()
    assert {line.get_label(): line.get_color() for line in drawn.axes[0].lines} == lines
