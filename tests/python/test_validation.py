"""``quadcore validate``: flights, chains, tables, page and refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from flights import ENGINES
from vehicles import AIR, CROSS, DRAG, MOTOR, vehicle

import quadcore as qc
from quadcore.thesis.chapter2 import Vehicle
from quadcore.thesis.validation import MODEL, Case, Experiment, compare_states, extract_states
from quadcore.thesis.validation.ascent import make_ascent
from quadcore.thesis.validation.experiment import align_to_steps
from quadcore.thesis.validation.prescribed_speeds import speeds

ROOT = Path(__file__).resolve().parents[2]
HEXAROTOR = ROOT / "tests/data/gazebo11/cases/B1_hexa_hover/model.urdf"
FAST = ["--drag", "none", "--sim-slow", "1", "--engine", "eigen", "--duration", "0.5", "--quiet"]


@pytest.fixture(scope="module")
def list_distances(study):
    """Largest distance from the model by engine, sim_slow and drag."""
    assert not any(row.failure for row in study.rows)
    return {row.case[:3]: row.difference.max["distance"] for row in study.rows}


def test_every_flight_ascends_and_moves_in_all_axes_without_a_steep_angle(study):
    for flight in study.flights.values():
        ranges = np.ptp(extract_states(flight.log)[:, :6], axis=0)
        assert ranges[:2].min() > 0.2
        assert flight.log.position[-1, 2] > 20
        assert ranges[3:].min() > np.radians(2)
    for row in study.rows:
        assert row.steepest < np.radians(60)


def test_slowing_down_seems_to_cure_gazebo(list_distances):
    assert list_distances["gazebo11", 1, "all"] > 10
    assert list_distances["gazebo11", 8, "all"] < list_distances["gazebo11", 1, "all"] / 10
    assert list_distances["gazebo11", 8, "none"] < list_distances["gazebo11", 1, "none"] / 10


def test_engines_without_the_fault_need_no_slowing_down(list_distances):
    for engine in ("ode", "eigen"):
        for drag in ("none", "all"):
            assert list_distances[engine, 1, drag] < list_distances[engine, 8, drag]
            assert list_distances[engine, 1, drag] < list_distances["gazebo11", 1, drag] / 10


def test_a_chain_leads_from_the_plant_to_the_model_and_adds_up(study):
    assert len(study.chains) == 4
    for chain in study.chains:
        assert not chain.failure
        assert chain.links[0].begin == Case("gazebo11", chain.sim_slow, chain.drag)
        assert chain.links[-1].end == Case(MODEL, 1, chain.drag)
        for link, after in zip(chain.links, chain.links[1:]):
            assert link.end == after.begin
        assert sum(link.share for link in chain.links) == pytest.approx(chain.distance, abs=1e-12)
        ends = [study.flights[case].log for case in (chain.links[0].begin, chain.links[-1].end)]
        whole = compare_states(*ends).max["distance"]
        assert chain.distance == pytest.approx(whole, abs=1e-12)
    assert [len(chain.links) for chain in study.chains] == [5, 6, 5, 6]


def test_the_fault_is_repaired_before_the_slow_down_is_undone(study):
    """At full speed the fault costs metres that a slowed plant does not show."""
    chain = next(c for c in study.chains if (c.drag, c.sim_slow) == ("all", 8))
    plants = [link.begin[:2] for link in chain.links[:4]]
    assert plants == [("gazebo11", 8), ("ode", 8), ("eigen", 8), ("eigen", 1)]
    for link in chain.links:
        assert abs(link.share) < chain.distance
        assert link.max < 1


def test_each_link_changes_one_thing(study):
    for chain in study.chains:
        for link in chain.links[:-1]:
            assert sum(a != b for a, b in zip(link.begin, link.end)) == 1


def test_the_links_say_what_is_wrong(study):
    chain = next(c for c in study.chains if (c.drag, c.sim_slow) == ("all", 1))
    fault, step, drag, left_out, rest = chain.links
    assert fault.max > 10
    assert 0.01 < step.max < 1
    assert 0.1 < drag.max < 1
    assert 0.1 < left_out.max < 1
    assert rest.max < 2e-4
    bare = next(c for c in study.chains if (c.drag, c.sim_slow) == ("none", 1))
    assert bare.links[2].max < 1e-10


def test_what_is_left_out_is_the_torque_of_rotors_that_spin_up(study):
    sizes = [row.difference.max["distance"] for row in study.left_out]
    no_lag, spin_up, dragged, both = sizes
    assert no_lag > 0.5
    assert both == pytest.approx(spin_up, rel=0.05)
    assert dragged < spin_up / 20


def test_only_gazebo_damps_and_as_expected(study):
    assert [entry.sim_slow for entry in study.damping] == [1, 8]
    for entry in study.damping:
        assert sorted(entry.measured) == sorted(ENGINES)
        for engine, decay in entry.measured.items():
            if engine == "gazebo11":
                assert decay == pytest.approx(entry.formula, rel=0.01)
            else:
                assert abs(decay) < 1e-3 * entry.formula


def test_the_model_has_no_second_engine_in_it(study):
    """Its flight is apart from that of the engine whose limit it is."""
    flights = [study.flights[Case("eigen", 1, "all", "given speeds")], study.flights[Case(MODEL)]]
    assert 1e-6 < compare_states(*(flight.log for flight in flights)).max["distance"] < 2e-4


def test_an_ascent_lifts_a_hexarotor_with_odd_rotors():
    experiment = Experiment.of(str(HEXAROTOR), duration=3)
    assert experiment.commands.shape[1] == 7
    assert (np.sign(experiment.commands[:, 1:]) == [1, -1, 1, -1, 1, -1]).all()
    log = experiment.fly(Case("eigen")).log
    assert log.position[-1, 2] > 11
    assert np.abs(extract_states(log)[:, 3:5]).max() < 0.3


def test_a_vehicle_that_the_input_cannot_lift_tilt_or_turn_is_refused_with_the_reason(hangar):
    def refuse(rotors, **air):
        air = {**AIR, **DRAG, **air}
        urdf = vehicle(rotors, air=air, motor=MOTOR)
        with pytest.raises(qc.InputError) as refusal:
            make_ascent(Vehicle.of(hangar(urdf, (0, 0, -9.8), engine="eigen")))
        return str(refusal.value)

    assert "give this vehicle no lift without another force" in refuse(CROSS[:2])
    # Lifts and tilts, but nothing turns it about the vertical.
    assert "give this vehicle no torque about z without" in refuse(CROSS, rotorTorqueCoeff=0)
    # Turns, but a hundred times less than the built-in flight asks.
    weak = refuse(CROSS, rotorTorqueCoeff=AIR["rotorTorqueCoeff"] / 100)
    assert "cannot lift this vehicle and turn it about z as fast as" in weak


def test_a_command_takes_effect_with_the_step_that_feels_it():
    table = np.array([[-1, 1], [0, 2], [0.0011, 3], [0.002, 4], [0.0021, 5], [0.005, 6]])
    assert align_to_steps(table, 1e-3).tolist() == [[0, 2], [0.002, 4], [0.003, 5], [0.005, 6]]


def test_given_speeds_are_those_of_motors_on_a_held_frame():
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    heavy = Vehicle.of(simulation)
    table = np.array([[0, 400, -400, 400, -400], [0.1, 500, -450, 500, -450]])
    times = np.array([0.05, 0.1, 0.15, 1.0])
    omega = speeds(heavy, table, times, lag=True)
    rate = 5e-4 / 2.8125e-5
    assert np.allclose(omega[:2], table[0, 1:])
    assert omega[2, 0] == pytest.approx(500 - 100 * np.exp(-rate * 0.05), rel=1e-12)
    assert np.allclose(omega[3], table[1, 1:], atol=1e-4)
    assert np.array_equal(speeds(heavy, table, times, lag=False)[1], table[1, 1:])
