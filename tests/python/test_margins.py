"""What a controller forgives."""

from __future__ import annotations

import numpy as np
import pytest
from evaluations import evaluate

import quadcore as qc
from quadcore import laws
from quadcore.evaluation.flights import NAN, Outcome
from quadcore.evaluation.plan import Plan
from quadcore.evaluation.robustness import ENDS, Searches, margin_text
from quadcore.evaluation.trial import Trial


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


class Own:
    """A law of quadcore in a coat, which makes it one of one's own."""

    rate = 500.0

    def __init__(self):
        self._law = laws.geometric()

    def reset(self, simulation):
        self._law.reset(simulation)

    def __call__(self, t, state, reference):
        return self._law(t, state, reference)


def test_margins_of_an_own_law_mean_what_those_of_a_shipped_one_mean():
    found = evaluate(["geometric", Own()], "circle", duration=1, margins=True)
    shipped, own = found.margins
    for name in (*ENDS, "box_median", "box_worst"):
        assert own[name] == pytest.approx(shipped[name], rel=1e-6), name


def thrust_of(simulation):
    tags = {tag.name: tag.value for plugin in simulation.plugins for tag in plugin.parameters}
    return float(tags["rotorThrustCoeff"])


def test_the_inner_loop_of_an_own_law_believes_in_the_vehicle_as_it_is_described():
    laws_ = {"none": Own(), "its own": Own()}
    laws_["its own"].inner_loop = qc.InnerLoop(spins=[1, -1, 1, -1])
    plan = Plan(laws_, "hover", ["eigen"], ["quadrotor"], 1, {}, 1.0, *[None] * 4, {})
    for row in range(2):
        flight = Trial(row, thrust=2.0).flight(plan)
        told = flight.controller.inner_loop.belief
        assert thrust_of(flight.simulation()) == pytest.approx(2 * thrust_of(told))
    assert flight.controller.inner_loop.spins == [1, -1, 1, -1]


def test_a_margin_at_the_end_of_its_search_is_told_as_larger():
    row = {"gain_low": 0.1, "gain_high": 10.0, "delay_margin": 0.5}
    assert [margin_text(row, name, "{:g}".format) for name in ENDS] == ["< 0.1", "> 10", "> 0.5"]
    assert margin_text({"gain_high": 9.9}, "gain_high", "{:g}".format) == "9.9"

    def never_lost(trials):
        return [Outcome("", {**NAN, "rms_position": 0.1 * trial.thrust}) for trial in trials]

    searches = Searches(["one"], [])
    searches.run(never_lost)
    (row,) = searches.rows()
    assert {name: row[name] for name in ENDS} == ENDS
    assert row["box_worst"] == pytest.approx(0.1 / 0.9)


def test_the_search_finds_the_edge():
    def lost_outside(trials):
        return [
            Outcome("" if 0.5 < t.thrust < 3 and t.delay < 0.1 else "lost", NAN) for t in trials
        ]

    searches = Searches(["one"], ["drag"])
    searches.run(lost_outside)
    (row,) = searches.rows()
    assert row["gain_low"] == pytest.approx(0.5, rel=0.02)
    assert row["gain_high"] == pytest.approx(3, rel=0.02)
    assert row["delay_margin"] == pytest.approx(0.1, abs=0.002)
    assert np.isnan(row["box_worst"])  # no tag says the drag
    assert row["failure"] == ""


def test_an_interrupted_search_says_so():
    def interrupted(trials):
        if len(trials) > 1:
            raise KeyboardInterrupt
        return [Outcome("", NAN)]

    searches = Searches(["one"], [])
    with pytest.raises(KeyboardInterrupt):
        searches.run(interrupted)
    assert searches.rows()[0]["failure"] == "not flown: interrupted"
