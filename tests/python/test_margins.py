"""What a controller forgives."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from evaluations import evaluate
from hooked import with_plugins
from vehicles import plugin, vehicle

import quadcore as qc
from quadcore.cli import main
from quadcore.control import controllers
from quadcore.studies.evaluate import evaluate as evaluation
from quadcore.studies.evaluate.margins import (
    ENDS,
    NOT_DECAYED,
    MarginSearch,
    format_margin,
    is_lost,
)
from quadcore.studies.evaluate.plan import Plan
from quadcore.studies.evaluate.trial import Trial, list_missing_effects
from quadcore.studies.measured_flight import NAN, Outcome, fly_and_measure
from quadcore.studies.options import EvaluateOptions


def test_margins_are_found(capsys):
    found = evaluate(
        ["geometric", lambda t, state, reference: [471, -471, 471, -471]], "circle",
        duration=1, margins=True,
    )  # fmt: skip
    first, own = found.margins
    assert first["gain_low"] < 0.8 < 1.3 < first["gain_high"]
    assert 0.004 < first["delay_margin"] < 0.5
    assert first["box_median"] <= first["box_worst"]
    assert first["rms_at_500_Hz"] < first["rms_at_25_Hz"] or np.isnan(first["rms_at_25_Hz"])
    assert own["controller"] == "<lambda>"
    assert np.isnan(own["box_worst"])


def test_flights_on_a_batch_give_the_margins_of_single_flights(monkeypatch, tmp_path):
    options = {
        "duration": 2,
        "margins": True,
        "processes": 1,
        "parameters": {"odometry.positionNoise": 1e-6},
    }
    notes = tmp_path / "notes"
    fly_group = evaluation.fly_group

    def note(*arguments):
        outcomes = fly_group(*arguments)
        with notes.open("a") as file:  # in another process
            file.write(f"{outcomes is not None} {len(arguments[0])}\n")
        return outcomes

    monkeypatch.setattr(evaluation, "fly_group", note)
    together = evaluate("geometric", "circle", **options)
    grouped = [line.split() for line in notes.read_text().splitlines()]
    assert all(flew == "True" for flew, _ in grouped)
    assert sum(int(count) for _, count in grouped) > 10
    monkeypatch.setattr(evaluation, "fly_group", lambda *arguments: None)
    alone = evaluate("geometric", "circle", **options)
    np.testing.assert_equal(together.margins, alone.margins)


class Own:
    """Wrap a built-in controller, so that it counts as a user's."""

    rate = 500.0

    def __init__(self):
        self._inner = controllers.geometric()

    def reset(self, simulation):
        self._inner.reset(simulation)

    def __call__(self, t, state, reference):
        return self._inner(t, state, reference)


@pytest.mark.parametrize("change", [{"thrust": 1.5}, {"delay": 0.01}, {"thrust": 0.9, "lag": 1.3}])
@pytest.mark.parametrize("kicked", [False, True])
def test_trials_of_an_own_controller_mean_what_those_of_a_built_in_one_mean(change, kicked):
    plan = Plan({"shipped": "geometric", "own": Own()}, "circle", ["eigen"], ["quadrotor"], {},
                options_of(1))  # fmt: skip
    shipped, own = (
        fly_and_measure(partial(Trial(row, kicked=kicked, **change).make_plan, plan), 60)
        for row in range(2)
    )
    assert own.measures["rms_position"] == pytest.approx(shipped.measures["rms_position"], rel=1e-6)


def test_a_flight_too_short_to_judge_a_disturbance_has_no_margins():
    (row,) = evaluate("geometric", "circle", duration=0.2, margins=True).margins
    assert row["failure"] == NOT_DECAYED
    assert np.isnan([row[name] for name in ENDS]).all()


def thrust_of(simulation):
    tags = {tag.name: tag.value for plugin in simulation.plugins for tag in plugin.parameters}
    return float(tags["rotorThrustCoeff"])


def test_the_inner_loop_of_an_own_controller_has_the_model_of_the_described_vehicle():
    own_controllers = {"none": Own(), "its own": Own()}
    own_controllers["its own"].inner_loop = qc.InnerLoop(spins=[1, -1, 1, -1])
    plan = Plan(
        own_controllers, "hover", ["eigen"], ["quadrotor"], {}, EvaluateOptions(duration=1.0)
    )
    for row in range(2):
        flight = Trial(row, thrust=2.0).make_plan(plan)
        model = flight.controller.inner_loop.belief
        assert thrust_of(flight.simulation()) == pytest.approx(2 * thrust_of(model))
    assert flight.controller.inner_loop.spins == [1, -1, 1, -1]


URDF = Path(__file__).resolve().parents[2] / "urdf"


@pytest.mark.parametrize("model", sorted(path.name.split(".")[0] for path in URDF.glob("*.xacro")))
def test_of_every_shipped_model_thrust_drag_and_lag_can_be_varied(model):
    assert list_missing_effects(qc.Simulation(model, engine="eigen")) == []


@pytest.mark.parametrize("motor", ["pid", "first_order"])
def test_the_motors_of_either_kind_say_how_they_lag(motor):
    simulation = qc.Simulation("hexarotor", engine="eigen", xacro_args={"motor": motor})
    assert list_missing_effects(simulation) == []


@pytest.mark.parametrize("model", ["quadrotor", "hexarotor", "firefly"])
def test_the_vehicle_of_a_trial_pushes_resists_and_lags_by_the_factors_asked_for(model):
    options = EvaluateOptions(duration=1.0, dt=1e-4)
    plan = Plan({"own": Own()}, "hover", ["eigen"], [model], {}, options)

    def make_simulation(**factors):
        return Trial(0, **factors).make_plan(plan).simulation()

    plain = make_simulation()
    hover = plain.hover_speed
    assert make_simulation(thrust=4.0).hover_speed == pytest.approx(hover / 2, rel=1e-9)
    assert make_simulation(drag=3.0, lag=2.0).hover_speed == pytest.approx(hover, rel=1e-9)
    assert resistance(plain) > 0
    assert resistance(make_simulation(drag=3.0)) == pytest.approx(
        3 * resistance(make_simulation()), rel=1e-6
    )
    assert rise(make_simulation(lag=2.0)) == pytest.approx(2 * rise(make_simulation()), rel=0.02)


def in_hover(simulation):
    """Rates of the joints, rad/s."""
    return simulation.hover_speed * [rotor.rate_per_command for rotor in simulation.rotors]


def resistance(simulation):
    """Force of still air on a vehicle that slides sideways, rotors at hover, N."""
    state = simulation.state.copy()
    state.linear_velocity[0] = 1e-3
    state.rotor_velocity[:] = in_hover(simulation)
    simulation.set_state(state)
    wrenches = simulation.run(simulation.dt, wrenches=True).wrenches
    return -sum(wrench[0, 0] for wrench in wrenches.values())


def rise(simulation):
    """Time in which the rotors reach 63 % of a speed that is commanded at rest, s."""
    target = np.abs(in_hover(simulation))
    simulation.command(simulation.hover_speed)
    while (np.abs(simulation.state.rotor_velocity) < 0.632 * target).any():
        simulation.step()
    return simulation.time


def test_a_margin_at_the_end_of_its_search_is_reported_as_larger():
    row = {"gain_low": 0.1, "gain_high": 10.0, "delay_margin": 0.5}
    assert [format_margin(row, name, "{:g}".format) for name in ENDS] == ["< 0.1", "> 10", "> 0.5"]
    assert format_margin({"gain_high": 9.9}, "gain_high", "{:g}".format) == "9.9"

    def never_lost(trials):
        return [Outcome("", {**NAN, "rms_position": 0.1 * trial.thrust}) for trial in trials]

    searches = MarginSearch(["one"], [])
    searches.run(never_lost)
    (row,) = searches.list_rows()
    assert {name: row[name] for name in ENDS} == ENDS
    assert row["box_worst"] == pytest.approx(0.1 / 0.9)


def test_effects_that_no_tag_scales_are_named_on_the_terminal_and_on_the_page(
    hook_plugins, tmp_path, capsys
):
    """As of a vehicle with the motors of a third party, whose tags scale the thrust alone."""
    model = tmp_path / "own.urdf"
    model.write_text(with_plugins(vehicle(mass=1), plugin("own_motor", {}), plugin("odometry", {})))
    warning = f"margins: no tag of '{model}' scales its drag and its lag. box is not searched."
    out = tmp_path / "out"
    command = "evaluate --controller geometric --reference hover --duration 1 --margins"
    assert main([*command.split(), "--model", str(model), "--out", str(out)]) == 0
    assert f"warning: {warning}\n" in capsys.readouterr().err
    assert warning in (out / "report.html").read_text().replace("&#39;", "'")
    content = json.loads((out / "evaluation.json").read_text())
    assert content["unsearched"] == warning
    assert content["margins"][0]["gain_high"] > 1
    assert content["margins"][0]["box_worst"] is None
    assert content["margins"][0]["delay_margin"] > 0


def test_the_search_finds_the_edge():
    def lost_outside(trials):
        return [
            Outcome("" if 0.5 < t.thrust < 3 and t.delay < 0.1 else "lost", NAN) for t in trials
        ]

    searches = MarginSearch(["one"], ["drag"])
    searches.run(lost_outside)
    (row,) = searches.list_rows()
    assert row["gain_low"] == pytest.approx(0.5, rel=0.02)
    assert row["gain_high"] == pytest.approx(3, rel=0.02)
    assert row["delay_margin"] == pytest.approx(0.1, abs=0.002)
    assert np.isnan(row["box_worst"])  # no tag says the drag
    assert row["failure"] == ""


def test_the_first_loss_counts_however_soon_flights_succeed_again():
    def lose_for_a_while(trials):
        return [Outcome("lost" if 0.0285 < t.delay < 0.0295 else "", NAN) for t in trials]

    searches = MarginSearch(["one"], [])
    searches.run(lose_for_a_while)
    assert searches.list_rows()[0]["delay_margin"] == pytest.approx(0.0285, abs=6e-4)


@pytest.mark.parametrize("duration", [10, 30])
def test_the_delay_margin_in_hover_is_the_linear_one_however_long_the_flight(duration):
    plan = Plan("pd", "hover", ["eigen"], ["quadrotor"], {}, options_of(duration))
    found = evaluate("pd", "hover", duration=1.0)
    linear = min(row["delay_margin"] for row in found.poles)

    def is_lost_after(delay):
        pair = [Trial(0, delay=delay, kicked=kicked) for kicked in (False, True)]
        made = [partial(each.make_plan, plan) for each in pair]
        return is_lost(*(fly_and_measure(each, 60, watch=True) for each in made))

    delays = np.arange(0.033, 0.038, 0.001)
    lost = [is_lost_after(delay) for delay in delays]
    first = delays[lost.index(True)]
    assert lost == (delays >= first).tolist()
    assert first - 0.001 <= 0.035 < first  # the same for both durations
    assert linear == pytest.approx(0.0353, abs=1e-4)


def options_of(duration):
    return EvaluateOptions(duration=float(duration), xacro_args={"sim_slow": 1})


def test_an_interrupted_search_says_so():
    def interrupt(trials):
        if len(trials) > 1:
            raise KeyboardInterrupt
        return [Outcome("", NAN)]

    searches = MarginSearch(["one"], [])
    with pytest.raises(KeyboardInterrupt):
        searches.run(interrupt)
    assert searches.list_rows()[0]["failure"] == "not flown: interrupted"
