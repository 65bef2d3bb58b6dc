"""libtachometer_plugin.so: rotor speeds as a sensor."""

from __future__ import annotations

import numpy as np
import pytest
from hooked import with_plugins
from sensed import rows_of
from vehicles import plugin

import quadcore as qc
from quadcore.model.description import read_model


def make_vehicle(tmp_path, model="quadrotor", engine="eigen", seed=0, xacro=None, **tags):
    urdf = with_plugins(read_model(model, xacro or {}).document.text, plugin("tachometer", tags))
    (tmp_path / "fitted.urdf").write_text(urdf)
    return qc.Simulation(tmp_path / "fitted.urdf", engine=engine, seed=seed)


@pytest.mark.parametrize("engine", ["gazebo11", "eigen"])
@pytest.mark.parametrize("slow", [1, 10])
def test_a_steady_speed_is_the_commanded_one_whatever_the_slowdown(tmp_path, engine, slow):
    sim = make_vehicle(tmp_path, engine=engine, xacro={"sim_slow": slow})
    command = sim.hover_speed * [1.01, 1.0, 0.99, 1.0]
    sim.command(command)
    sim.step(600)
    message = sim.topic("rotor_speeds")
    assert [message[f"w{i}"] for i in (1, 2, 3, 4)] == pytest.approx(command, rel=2e-2)
    rates = sim.state.rotor_velocity * slow
    assert [message[f"w{i}"] for i in (1, 2, 3, 4)] == pytest.approx(rates, abs=1e-9)
    assert message["stamp"] == pytest.approx(0.6)


def test_the_signs_are_those_of_commands_on_a_vehicle_with_directions(tmp_path):
    sim = make_vehicle(tmp_path, "hummingbird")
    command = sim.hover_speed
    sim.command(command)
    sim.step(1000)
    message = sim.topic("rotor_speeds")
    assert [message[f"w{i}"] for i in (1, 2, 3, 4)] == pytest.approx(command, rel=1e-2)


def test_noise_is_white_with_its_deviation_and_depends_on_the_seed(tmp_path):
    noisy = rows_of(make_vehicle(tmp_path, noise=2.5, rate=1000), "rotor_speeds", 3000)
    exact = rows_of(make_vehicle(tmp_path, rate=1000), "rotor_speeds", 3000)
    error = noisy[:, 1:] - exact[:, 1:]
    assert error.std(axis=0) == pytest.approx([2.5] * 4, rel=0.05)
    assert np.abs(error.mean(axis=0)).max() < 0.2
    assert abs(np.corrcoef(error[1:, 0], error[:-1, 0])[0, 1]) < 0.06
    assert abs(np.corrcoef(error[:, 0], error[:, 1])[0, 1]) < 0.06
    again = rows_of(make_vehicle(tmp_path, noise=2.5, rate=1000, seed=1), "rotor_speeds", 10)
    assert not np.array_equal(again[:, 1:], noisy[:10, 1:])


def test_dropouts_and_delays_leave_the_numbers_of_the_others(tmp_path):
    whole = rows_of(make_vehicle(tmp_path, noise=1, rate=100), "rotor_speeds", 1000)
    lossy = rows_of(
        make_vehicle(tmp_path, noise=1, rate=100, dropout=0.5, delay=0.03), "rotor_speeds", 1000
    )
    assert 20 < len(lossy) < 80
    by_stamp = {round(row[0], 6): row for row in whole}
    for row in lossy:
        assert np.array_equal(row[1:], by_stamp[round(row[0], 6)][1:])


def test_a_controller_reads_them(tmp_path):
    sim = make_vehicle(tmp_path)
    seen = []

    def controller(t, state, reference):
        seen.append(state.topic("rotor_speeds")["w1"])
        return sim.hover_speed

    sim.run(0.3, controller=controller)
    assert seen[-1] == pytest.approx(sim.topic("rotor_speeds")["w1"], rel=0.05)
