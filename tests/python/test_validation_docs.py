"""What the pages on validation say is what is found."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import quadcore as qc
from quadcore.thesis.chapter2 import Vehicle
from quadcore.thesis.validation import Experiment
from quadcore.thesis.validation.damping import measure_damping
from quadcore.thesis.validation.output import size

ROOT = Path(__file__).resolve().parents[2]


def yaw_loop(slow):
    """Roots of the loop of the published yaw gains on the model's own yaw, at hover."""
    k, b, rotor, gain = 1.1487e-5, 2.69e-7, 2.8125e-5, 5e-4
    hover = np.sqrt(1.04 * 9.8 / (4 * k))
    lag, zero = gain / rotor, 2 * b * hover * slow / rotor
    numerator = lag * np.polymul([-1 / zero, 1], [16, 96, 96])
    return np.roots(np.polyadd(np.polymul([1, 0, 0, 0], [1, lag]), numerator)), zero


def test_what_the_docs_say_of_the_published_gains():
    roots = np.roots([1, 0.125, 2.4, 0.8])
    assert np.round(roots[0], 2) == 0.10 + 1.57j
    drag = 4 * (0.01 + 0.0025 + 0.005) / 1.04
    growth = np.roots([1, 0.125 + drag, 2.4, 0.8]).real.max()
    assert round(drag, 3) == 0.067 and round(1 / growth) == 15
    for enough, stable in ((0.20, False), (0.21, True)):
        assert (np.roots([1, 0.125 + enough, 2.4, 0.8]).real.max() < 0) == stable
    for slow, zero, root in ((1, 9.0, 10.4 + 11.3j), (8, 72, -2.9 + 14.0j)):
        found, where = yaw_loop(slow)
        assert round(where, 1 if slow == 1 else 0) == zero
        assert np.round(found[found.imag.argmax()], 1) == root
        assert (found.real.max() < 0) == (slow == 8)


@pytest.mark.parametrize(("slow", "holds"), [(1, False), (8, True)])
def test_the_published_yaw_gains_hold_a_slowed_plant_only(slow, holds):
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": slow})
    state = simulation.state.copy()
    spin = np.array([1, -1, 1, -1])
    hover = np.sqrt(simulation.mass * 9.8 / (4 * 1.1487e-5))
    state.orientation[:] = [0, 0, np.sin(0.005), np.cos(0.005)]
    state.rotor_velocity[:] = spin * hover / slow
    simulation.set_state(state)
    integral, yaws = 0.0, []
    for _ in range(4000):
        yaw = 2 * np.arctan2(simulation.state.orientation[2], simulation.state.orientation[3])
        integral -= yaw * simulation.dt
        wanted = -96 * yaw + 96 * integral - 16 * simulation.state.angular_velocity[2]
        torque = simulation.inertia[2, 2] * wanted
        simulation.command(spin * np.sqrt(np.maximum(hover**2 + spin * torque / (4 * 2.69e-7), 0)))
        simulation.step()
        yaws.append(abs(yaw))
    assert (max(yaws[3000:]) < 1e-3) == holds
    assert (max(yaws[3000:]) > 0.1) != holds


def test_drag_makes_the_open_loop_unstable_as_the_docs_say():
    """About hover: a disturbance grows e-fold in 1.8 s, tenfold in 4.2 s."""
    v = Vehicle.of(qc.Simulation("quadrotor", engine="eigen"))
    drag = len(v.arms) * (v.K_I + v.K_T + v.K_P)
    tip = -v.gravity[2] * drag * v.arms[0, 2] / v.inertia[0, 0]
    growth = np.roots([1, drag / v.mass, 0, tip]).real.max()
    assert (round(1 / growth, 1), round(np.log(10) / growth, 1)) == (1.8, 4.2)


def damper(page, name):
    """Speed in the heading of a table of the damper, rad/s, and its formula by sim_slow, 1/s."""
    text = (ROOT / "docs" / page).read_text()
    table = text.split(f"<!-- measured: {name} -->")[1].split("<!-- end -->")[0]
    speed = re.search(r"\| formula, ([\d.]+) rad/s / sim_slow \|", table)
    rows = re.findall(r"^\| (\d+) \| ([\d.]+) \|", table, re.MULTILINE)
    return float(speed[1]), {float(slow): float(formula) for slow, formula in rows}


@pytest.mark.parametrize(("page", "name"), [("gazebo.md", "decay"), ("validation.md", "decays")])
def test_both_tables_of_the_damper_are_the_one_formula_at_the_speed_in_their_heading(page, name):
    speed, formulas = damper(page, name)
    assert list(formulas) == [1, 8, 10, 18]
    experiment = Experiment.of(commands=[[0, speed, -speed, speed, -speed]])
    for slow, formula in formulas.items():
        assert formula == pytest.approx(measure_damping(experiment, [], slow).formula, rel=0.005)


def test_real_gazebo_and_gazebo11_are_measured_alike_in_the_docs():
    page = (ROOT / "docs" / "gazebo.md").read_text()
    table = page.split("<!-- measured: decay -->")[1].split("<!-- end -->")[0]
    rows = [row.strip("| ").split(" | ") for row in table.strip().splitlines()[2:]]
    assert [row[0] for row in rows] == ["1", "8", "10", "18"]
    for _, _, real, gazebo, *_ in rows:
        digits = len(real.split(".")[1])
        assert round(float(gazebo), digits) == float(real)


def test_the_docs_say_what_the_command_finds(study):
    page = (ROOT / "docs" / "validation.md").read_text()
    table = re.findall(r"^\| (\w+) \| (1|8) \| ([\d.]+) \|.* ([\d.]+) \|$", page, re.MULTILINE)
    assert len(table) == 6
    for engine, slow, none, everything in table:
        for drag, printed in (("none", none), ("all", everything)):
            row = next(r for r in study.rows if r.case[:3] == (engine, float(slow), drag))
            assert size(row.difference.max["distance"]) == printed
