"""Wakes of other vehicles: thrust loss against the cited jet, order, range and messages."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from flights import ENGINES
from hooked import G, with_plugins
from vehicles import CROSS, LIFT, plugin, start, vehicle

import quadcore as qc

RADIUS = 0.1  # m
OPPOSITE = 0.4  # m, between opposite rotors of CROSS
LOSS = 1.3
DENSITY = 101325 / (287.05287 * 288.15)  # kg/m^3, of the standard atmosphere


def make_wake_vehicle(air=LIFT, sim_slow=2, radius=RADIUS):
    tags = {"rotorRadius": radius, "advanceRatioLoss": LOSS}
    urdf = vehicle(CROSS, air={**air, "inducedDragCoeff": 0, "sim_slow": sim_slow})
    return with_plugins(urdf, plugin("downwash", tags))


def make_fleet(**vehicles):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", qc.QuadcoreWarning)
        return qc.Fleet(vehicles)


def wrenches(fleet, name):
    """What each term exerts on a vehicle now: force, then torque, frame axes."""
    return {term: rows[0] for term, rows in fleet.run(0, wrenches=True)[name].wrenches.items()}


def find_speed(r, s, thrust):
    """Speed of the flow r aside and s below a vehicle, m/s: eqs. (1) to (6), (8) and (9)."""
    induced = np.sqrt(thrust / (2 * DENSITY * 4 * np.pi * RADIUS**2))
    r, s = r / OPPOSITE, s / OPPOSITE
    half_width = 0.07668 * (s + 5.817)
    center = induced * 10.11 / (s + 5.817)
    return center / (1 + (np.sqrt(2) - 1) * (r / half_width) ** 2) ** 2


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("below", [1.1, 2.0, 4.0])  # m: 2.75, 5 and 10 rotor distances
def test_a_vehicle_below_another_loses_the_thrust_of_the_cited_model(engine, below, hangar):
    urdf = make_wake_vehicle()
    rates = 240 * np.array([1, -1, 1, -1.0])  # of the joints; the rotors turn twice as fast
    lower = hangar(urdf, G, engine=engine)
    upper = hangar(urdf, G, engine=engine, spawn=(0, 0, 9))
    fleet = make_fleet(lower=lower, upper=upper)
    aside = 0.3
    start(lower, position=(5, 5, 3), rotor_velocity=rates)
    start(upper, position=(5 + aside, 5, 3 + below), rotor_velocity=rates)
    fleet.step()
    found = wrenches(fleet, "lower")
    rate = abs(lower.state.rotor_velocity)
    thrusts = LIFT["rotorThrustCoeff"] * (2 * rate) ** 2
    thrust = 4 * LIFT["rotorThrustCoeff"] * 480**2
    reach = [np.hypot(rotor.xyz[0] - aside, rotor.xyz[1]) for rotor in CROSS]
    flow = np.array([find_speed(r, below, thrust) for r in reach])
    advance_ratio = flow / (2 * rate / (2 * np.pi) * 2 * RADIUS)
    lost = LOSS * advance_ratio * thrusts
    assert found["downwash"][2] == pytest.approx(-lost.sum(), rel=1e-9)
    assert found["thrust"][2] == pytest.approx(thrusts.sum(), rel=1e-9)
    # The rotors nearer to the centre lose more, which tilts the vehicle towards it.
    pitch = sum(rotor.xyz[0] * each for rotor, each in zip(CROSS, lost))
    assert found["downwash"][4] == pytest.approx(pitch, rel=1e-8)
    assert 0.01 < lost.sum() / thrusts.sum() < 0.3
    assert not wrenches(fleet, "upper")["downwash"].any()


@pytest.mark.parametrize("engine", ENGINES)
def test_the_order_of_the_vehicles_has_no_effect(engine, hangar):
    urdf = make_wake_vehicle()
    tables = []
    for order in (("low", "middle", "high"), ("high", "low", "middle")):
        heights = {"low": 2, "middle": 3.5, "high": 5.5}
        vehicles = {
            name: hangar(urdf, G, engine=engine, spawn=(0.1 * heights[name], 0, heights[name]))
            for name in order
        }
        fleet = make_fleet(**vehicles)
        for simulation in vehicles.values():
            state = simulation.state
            start(
                simulation, rotor_velocity=240 * np.array([1, -1, 1, -1.0]), position=state.position
            )
        logs = fleet.run(0.2, wrenches=True)
        tables.append(logs)
    for name in ("low", "middle", "high"):
        one, other = (logs[name] for logs in tables)
        assert one.table.tobytes() == other.table.tobytes()
    assert tables[0]["low"].wrenches["downwash"][-1, 2] < 0


@pytest.mark.parametrize("engine", ENGINES)
def test_a_vehicle_without_others_is_undisturbed(engine, hangar):
    def fly(urdf, in_fleet):
        simulation = hangar(urdf, G, engine=engine, spawn=(0, 0, 5))
        fleet = make_fleet(only=simulation) if in_fleet else None
        start(simulation, rotor_velocity=240 * np.array([1, -1, 1, -1.0]), position=(0, 0, 5))
        return fleet.run(0.2)["only"] if in_fleet else simulation.run(0.2)

    urdf = make_wake_vehicle()
    plain = vehicle(CROSS, air={**LIFT, "inducedDragCoeff": 0, "sim_slow": 2})
    expected = fly(plain, False).table.tobytes()
    assert fly(urdf, False).table.tobytes() == fly(urdf, True).table.tobytes() == expected


def test_a_wake_is_wind_to_the_drag(hangar):
    drag = {**LIFT, "parasiticDragCoeff": 0.02, "dragModel": "chapter2"}
    rates = 240 * np.array([1, -1, 1, -1.0])
    lower = hangar(make_wake_vehicle(drag), G)
    upper = hangar(make_wake_vehicle(drag), G, spawn=(0, 0, 9))
    fleet = make_fleet(lower=lower, upper=upper)
    start(lower, position=(0, 0, 3), rotor_velocity=rates)
    start(upper, position=(0, 0, 5), rotor_velocity=rates)
    fleet.step()
    thrust = 4 * LIFT["rotorThrustCoeff"] * 480**2
    height = CROSS[0].xyz[2]  # of the rotors above the frame's origin
    speed = find_speed(0, 2 + height, thrust)
    down = wrenches(fleet, "lower")["parasitic"][2]
    assert down == pytest.approx(-0.02 * speed**2, rel=1e-2)  # it falls 10 mm/s


def test_a_snapshot_restores_the_wake(hangar):
    urdf = make_wake_vehicle()
    fleet = make_fleet(
        low=hangar(urdf, G, spawn=(0, 0, 3)), high=hangar(urdf, G, spawn=(0.1, 0, 5))
    )
    for simulation in fleet.vehicles.values():
        start(simulation, rotor_velocity=240 * np.array([1, -1, 1, -1.0]))
    fleet.step(50)
    snapshot = fleet.snapshot()
    force = wrenches(fleet, "low")["downwash"]
    logs = [fleet.run(0.05)["low"].table.tobytes()]
    fleet.restore(snapshot)
    assert wrenches(fleet, "low")["downwash"].tobytes() == force.tobytes()
    logs.append(fleet.run(0.05)["low"].table.tobytes())
    assert logs[0] == logs[1]


def test_a_vehicle_near_below_another_is_warned_once(hangar):
    urdf = make_wake_vehicle()
    fleet = make_fleet(
        low=hangar(urdf, G, spawn=(0, 0, 3)), high=hangar(urdf, G, spawn=(0.1, 0, 3.9))
    )
    for simulation in fleet.vehicles.values():
        start(simulation, rotor_velocity=240 * np.array([1, -1, 1, -1.0]))
    with pytest.warns(
        qc.QuadcoreWarning, match="less than 2.5 rotor distances below 'high'"
    ) as caught:
        fleet.step(20)
    assert len([each for each in caught if "rotor distances" in str(each.message)]) == 1


def test_a_vehicle_without_the_plugin_has_no_wake(hangar):
    bare = vehicle(CROSS, air={**LIFT, "inducedDragCoeff": 0, "sim_slow": 2})
    low = hangar(make_wake_vehicle(), G, spawn=(0, 0, 3))
    fleet = make_fleet(low=low, high=hangar(bare, G, spawn=(0, 0, 5)))
    for simulation in fleet.vehicles.values():
        start(simulation, rotor_velocity=240 * np.array([1, -1, 1, -1.0]))
    with pytest.warns(qc.QuadcoreWarning, match="vehicle 'high' has no wake") as caught:
        fleet.step(20)
    assert len(caught) == 1
    assert not wrenches(fleet, "low")["downwash"].any()


def test_the_size_of_a_wake_needs_two_rotors(hangar):
    urdf = with_plugins(vehicle(CROSS[:1], air=LIFT), plugin("downwash", {}))
    with pytest.raises(
        qc.InputError, match=r"<rotorJoints> names fewer\. Name at least two joints"
    ):
        hangar(urdf)
