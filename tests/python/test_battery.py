"""libbattery_plugin.so: a voltage that falls, and with it what the rotors lift."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import CHAPTER2, G, assert_same_bytes, fly, make_motored, with_plugins
from vehicles import CROSS, HAND, MOTOR, ODD, plugin, start, vehicle, wrenches

import quadcore as qc

LIPO = {"fullVoltage": 12.6, "emptyVoltage": 9.9, "capacity": 2.2, "resistance": 0.03}
SPEEDS = np.array([400, -420, 380, -390])
BALANCED = np.array([400, -400, 400, -400])  # turns nothing, so that the rates stay


def power(speeds, left=1):
    """Of the air's torque, W."""
    return np.sum(left * np.abs(speeds) ** 3) * HAND["rotorTorqueCoeff"]


def add_battery(rotors=CROSS, air=HAND, **tags):
    return with_plugins(vehicle(rotors, air=air), plugin("battery", {**LIPO, **tags}))


def start_turning(hangar, urdf, speeds=SPEEDS, **options):
    """Rotors that nothing brakes: the reaction is the frame's."""
    return start(hangar(urdf, engine="eigen", **options), rotor_velocity=speeds)


@pytest.mark.parametrize("sim_slow", [1, 4])
@pytest.mark.parametrize("efficiency", [1, 0.7])
def test_current_and_voltage_are_those_of_the_circuit(sim_slow, efficiency, hangar):
    slowed = {"sim_slow": sim_slow}
    urdf = vehicle(CROSS, air={**HAND, **slowed}, motor={**MOTOR, **slowed})
    tags = {**LIPO, "efficiency": efficiency, "charge": 0.6}
    urdf = with_plugins(urdf, plugin("battery", tags))
    simulation = start_turning(hangar, urdf, SPEEDS / sim_slow)
    simulation.step()
    battery = simulation.topic("battery")
    U, current = battery["voltage"], battery["current"]
    assert battery["charge"] == 0.6 * 2.2 and battery["capacity"] == 2.2
    assert pytest.approx(9.9 + 0.6 * 2.7 - 0.03 * current, rel=1e-12) == U
    # The rotors turn at U/12.6 of the speed that they show, their power is the cube of it.
    assert U * current == pytest.approx(power(SPEEDS) * (U / 12.6) ** 3 / efficiency, rel=1e-10)
    shares = simulation.topic("effectiveness")
    for j in range(1, 5):
        assert shares[f"s{j}"] == pytest.approx((U / 12.6) ** 2, rel=1e-15)


def test_rotors_of_rotors_motors_draw_the_same_power_whichever_way_they_turn(tmp_path):
    urdf = tmp_path / "firefly.urdf"
    battery = plugin("battery", {**LIPO, "resistance": 0})
    urdf.write_text(with_plugins(qc.read_model("firefly").document.text, battery))
    simulation = qc.Simulation(urdf, engine="eigen")
    start(simulation, rotor_velocity=[50, -50, 50, 50, -50, -50]).step()
    torque = 8.54858e-06 * 0.016 * 500**2  # at the speed before the slowdown, 10 x 50 rad/s
    assert simulation.topic("battery")["current"] == pytest.approx(6 * torque * 500 / 12.6)


def test_what_falls_with_the_voltage_is_thrust_and_reaction(hangar):
    urdf = with_plugins(vehicle(ODD, air=CHAPTER2), plugin("battery", LIPO))
    bare = hangar(vehicle(ODD, air=CHAPTER2), engine="eigen")
    sagging = hangar(urdf, engine="eigen")
    moving = {"rotor_velocity": SPEEDS, "linear_velocity": (3, -2, 1)}
    start(sagging, **moving).step()
    U = sagging.topic("battery")["voltage"]
    assert U < 12.6
    at_rest = {"orientation": (0, 0, 0, 1), "position": (0, 0, 0), **moving}
    angles = {"rotor_angle": np.zeros(4), "angular_velocity": np.zeros(3)}
    sag, whole = (wrenches(start(s, **at_rest, **angles)) for s in (sagging, bare))
    assert np.allclose(sag["reaction"], (U / 12.6) ** 2 * whole["reaction"], rtol=1e-9)
    for term in ("induced", "translational", "profile"):
        assert np.allclose(sag[term], whole[term], rtol=1e-9, atol=1e-15)
    assert np.linalg.norm(sag["thrust"]) < np.linalg.norm(whole["thrust"])


def test_a_battery_of_one_voltage_is_drained_steadily(hangar):
    same = {"fullVoltage": 11.1, "emptyVoltage": 11.1}
    simulation = start_turning(hangar, add_battery(**same), BALANCED, dt=0.005)
    battery = simulation.run(20, topics=["battery"]).topics["battery"]
    current = battery["current"][1]
    assert np.allclose(battery["current"][1:], current, rtol=1e-6)
    t = np.arange(len(battery["charge"]) - 1) * 0.005
    assert np.allclose(battery["charge"][1:], 2.2 - current * t / 3600, rtol=1e-9)


def test_without_resistance_the_voltage_falls_as_the_equation_says(hangar):
    # dE/dt = -(12.6 - 9.9)/Q I and I = P E^2/12.6^3: 1/E grows linearly.
    simulation = start_turning(hangar, add_battery(resistance=0, capacity=0.03), BALANCED, dt=0.005)
    battery = simulation.run(15, topics=["battery"]).topics["battery"]
    U = battery["voltage"][1:]
    t = np.arange(len(U)) * 0.005
    slope = 2.7 / (0.03 * 3600) * power(BALANCED) / 12.6**3
    assert np.allclose(1 / U, 1 / 12.6 + slope * t, rtol=1e-4)
    assert U[-1] < 11.5


def test_an_empty_battery_lifts_nothing(hangar):
    simulation = start_turning(hangar, add_battery(charge=1e-5))
    assert simulation.topic("battery")["count"] == 0
    simulation.step(100)
    battery = simulation.topic("battery")
    assert battery["voltage"] == battery["current"] == battery["charge"] == 0
    assert not wrenches(simulation)["thrust"].any()


def test_shares_of_a_fault_and_of_the_battery_multiply(hangar):
    fault = plugin("fault", {"effectiveness": "faults", "losses": "0 2 0.4"})
    urdf = with_plugins(
        vehicle(CROSS, air=HAND), fault, plugin("battery", {**LIPO, "faults": "faults"})
    )
    simulation = start_turning(hangar, urdf)
    simulation.step()
    battery, shares = simulation.topic("battery"), simulation.topic("effectiveness")
    U = battery["voltage"]
    left = [1, 0.4, 1, 1]
    assert U * battery["current"] == pytest.approx(power(SPEEDS, left) * (U / 12.6) ** 3, rel=1e-10)
    for j, share in enumerate(left, 1):
        assert shares[f"s{j}"] == pytest.approx(share * (U / 12.6) ** 2, rel=1e-15)


def test_two_that_say_what_is_left_of_rotors_are_refused(hangar):
    with pytest.raises(qc.InputError, match="effectiveness"):
        hangar(with_plugins(vehicle(CROSS, air=HAND), plugin("fault", {}), plugin("battery", LIPO)))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_battery_that_does_not_sag_flies_the_same_bytes_and_survives_a_snapshot(engine, hangar):
    ideal = {**LIPO, "emptyVoltage": 12.6, "resistance": 0}
    bare = fly(hangar(make_motored(), G, engine=engine), 200)
    assert_same_bytes(
        bare,
        fly(hangar(with_plugins(make_motored(), plugin("battery", ideal)), G, engine=engine), 200),
    )
    simulation = hangar(with_plugins(make_motored(), plugin("battery", LIPO)), G, engine=engine)
    fly(simulation, 100)
    middle = simulation.snapshot()
    second = fly(simulation, 100)
    simulation.restore(middle)
    assert_same_bytes(second, fly(simulation, 100))
    assert second.table.tobytes() != bare.table[100:].tobytes()


def test_voltages_the_wrong_way_round_are_refused(hangar):
    with pytest.raises(qc.InputError, match=r"<emptyVoltage> exceeds <fullVoltage>\. Swap them"):
        hangar(add_battery(emptyVoltage=13))
