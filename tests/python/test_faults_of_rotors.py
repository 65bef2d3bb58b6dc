"""Rotors that lose thrust, motors that are cut or lag, and the ground's effect on rotors."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES, quadrotor
from hooked import CHAPTER2, G, assert_same_bytes, fly, make_motored, with_plugins
from vehicles import AIR, CROSS, HAND, LIFT, MOTOR, ODD, SKEW, plugin, start, vehicle, wrenches

import quadcore as qc

J = 2.8125e-5  # kg m^2: a propeller's moment about its axis


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("drag_model", ["appendix", "chapter2"])
def test_effectiveness_scales_thrust_and_reaction_and_leaves_the_drag(drag_model, engine, hangar):
    simulation = hangar(vehicle(ODD, air={**CHAPTER2, "dragModel": drag_model}), engine=engine)
    moving = {"rotor_velocity": (471, -465, 480, -475), "linear_velocity": (3, -2, 1)}

    def measure_wrenches(*left):
        simulation.reset()
        if left:
            simulation.publish("effectiveness", left)
        simulation.step()
        return wrenches(start(simulation, **moving))

    whole, none = measure_wrenches(), measure_wrenches(0, 0, 0, 0)
    alone = [measure_wrenches(*np.eye(4)[i]) for i in range(4)]
    some = measure_wrenches(0.3, 1, 0, 0.8)
    for term in ("thrust", "reaction"):
        shares = [one[term] - none[term] for one in alone]
        assert np.allclose(whole[term] - none[term], sum(shares), rtol=1e-12, atol=1e-15)
        expected = none[term] + 0.3 * shares[0] + shares[1] + 0.8 * shares[3]
        assert np.allclose(some[term], expected, rtol=1e-12, atol=1e-15)
        assert not none[term].any() and whole[term].any()
    for term in ("induced", "translational", "profile"):
        assert whole[term].tobytes() == some[term].tobytes() == none[term].tobytes()


@pytest.mark.parametrize("engine", ENGINES)
def test_published_full_effectiveness_leaves_the_bytes(engine, hangar):
    published, plain = (hangar(make_motored(), G, engine=engine) for _ in range(2))
    published.publish("effectiveness", [1] * 4)
    published.publish("power", [1] * 4)
    assert_same_bytes(fly(published, 200), fly(plain, 200))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_fault_by_time_is_the_same_as_one_by_topic(engine, hangar):
    faulty = with_plugins(
        make_motored(), plugin("fault", {"losses": "0.1 2 0.4  0.2 4 0.7", "cuts": "0.15 3"})
    )
    by_time = hangar(faulty, G, engine=engine)
    by_topic = hangar(make_motored(), G, engine=engine)
    by_fault = hangar(with_plugins(make_motored(), plugin("fault", {})), G, engine=engine)
    flown = fly(by_time, 300).table[1:]
    pieces = {by_topic: [], by_fault: []}
    for steps, e, p, fault in (
        (100, None, None, None),
        (50, (1, 0.4, 1, 1), None, (2, 0.4, 1)),
        (50, None, (1, 1, 0, 1), (3, 1, 0)),
        (100, (1, 0.4, 1, 0.7), None, (4, 0.7, 1)),
    ):
        if e:
            by_topic.publish("effectiveness", e)
        if p:
            by_topic.publish("power", p)
        if fault:
            by_fault.publish("fault", fault)
        for simulation, rows in pieces.items():
            rows.append(fly(simulation, steps).table[1:])
    for rows in pieces.values():
        assert np.concatenate(rows).tobytes() == flown.tobytes()
    whole = fly(hangar(make_motored(), G, engine=engine), 300).table[1:]
    assert whole[:100].tobytes() == flown[:100].tobytes() and (whole[101:] != flown[101:]).any()


@pytest.mark.parametrize("sim_slow", [1, 4])
@pytest.mark.parametrize("engine", ENGINES)
def test_rotors_whose_motors_are_all_cut_coast_to_rest_in_the_air(engine, sim_slow, hangar):
    air = {**AIR, "reactionOn": "rotor", "sim_slow": sim_slow}
    urdf = vehicle(CROSS, air=air, motor={**MOTOR, "sim_slow": sim_slow})
    urdf = with_plugins(urdf, plugin("fault", {"cuts": "1 1  1 2  1 3  1 4"}))
    speeds = np.array([500, -500, 500, -500])
    simulation = hangar(urdf, G, engine=engine)
    start(simulation, rotor_velocity=speeds / sim_slow)
    simulation.command(speeds)
    simulation.step(1000)
    w0 = sim_slow * simulation.state.rotor_velocity
    b = LIFT["rotorTorqueCoeff"]
    worst = 0.0
    for _ in range(20):
        simulation.step(100)
        t = simulation.time - 1
        w = sim_slow * simulation.state.rotor_velocity
        worst = max(worst, np.abs(w / (w0 / (1 + sim_slow * b * np.abs(w0) * t / J)) - 1).max())
    print(engine, "worst", worst)
    assert worst < (1e-6 if engine == "eigen" else 6e-3)
    assert np.abs(w).max() < 0.2 * np.abs(w0).max()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_fault_survives_a_snapshot(engine, hangar):
    tags = {"losses": "0.15 1 0.2", "cuts": "0.05 2"}
    simulation = hangar(with_plugins(make_motored(), plugin("fault", tags)), G, engine=engine)
    fly(simulation, 100)
    middle = simulation.snapshot()
    second = fly(simulation, 150)
    simulation.restore(middle)
    assert_same_bytes(second, fly(simulation, 150))
    simulation.reset()
    fly(simulation, 100)
    assert_same_bytes(second, fly(simulation, 150))


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ({"losses": "1 2"}, "<losses> has 2 numbers. Write three numbers for each"),
        ({"cuts": "1 2 3"}, "<cuts> has 3 numbers. Write two numbers for each"),
        ({"cuts": "-1 2"}, "<cuts> event 1 is before the start. Use a time >= 0"),
        (
            {"cuts": "1 2 1 5"},
            "<cuts> event 2 names a rotor that does not exist. Use a number from 1 to 4",
        ),
        ({"cuts": "1 2.5"}, "<cuts> event 1 names a rotor that does not exist"),
        (
            {"losses": "1 2 1.5"},
            "<losses> event 1 has an invalid remaining fraction. Use a number from 0 to 1",
        ),
        ({"losses": "1 2 0.5 1 3 0.5 1 2 0"}, "<losses> event 3 repeats rotor 2 at the same time"),
    ],
)
def test_a_fault_that_cannot_be_is_refused_with_its_line(tags, says, hangar):
    urdf = with_plugins(make_motored(), plugin("fault", tags))
    line = 1 + urdf[: urdf.index("libfault")].count("\n")
    with pytest.raises(qc.InputError, match=f"urdf:{line}: plugin 'fault' .*{says}"):
        hangar(urdf, G)


@pytest.mark.parametrize(
    ("topic", "values", "says"),
    [
        ("effectiveness", [1, 1, -1, 1], "topic 'effectiveness': s3 is out of range"),
        (
            "power",
            [1, 2, 1, 1],
            "topic 'power': s2 is out of range. Publish a fraction from 0 to 1",
        ),
    ],
)
def test_a_share_that_is_none_ends_the_flight(topic, values, says, hangar):
    simulation = hangar(make_motored(), G)
    simulation.command([400] * 4)
    simulation.publish(topic, values)
    with pytest.raises(qc.FlightError, match=says):
        simulation.step()


def make_lagging(tags, inertia=(1e9, 1e9, 1e9), **options):
    urdf = vehicle(CROSS, mass=1e9, inertia=inertia, air={**HAND, "inducedDragCoeff": 0})
    return with_plugins(urdf, plugin("motor", tags))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sim_slow", [1, 5])
def test_a_motor_follows_with_its_time_constants(sim_slow, engine, hangar):
    tags = {"timeConstantUp": 0.05, "timeConstantDown": 0.2, "sim_slow": sim_slow}
    urdf = make_lagging(tags).replace(
        "<rotorThrust", f"<sim_slow>{sim_slow}</sim_slow><rotorThrust", 1
    )
    simulation = hangar(urdf, engine=engine)
    simulation.step(10)
    assert not simulation.state.rotor_velocity.any()
    speeds = np.array([400, -300, 200, -100]) / sim_slow
    simulation.command(sim_slow * speeds)
    simulation.step(100)
    tolerance = {"rtol": 1e-9 if engine == "eigen" else 0.03}
    w = simulation.state.rotor_velocity.copy()
    assert np.allclose(w, speeds * (1 - np.exp(-0.1 / 0.05)), **tolerance)
    simulation.command([0, -50, 0, 0])
    simulation.step(100)
    target = np.array([0, -50, 0, 0]) / sim_slow
    expected = target + (w - target) * np.exp(-0.1 / 0.2)
    assert np.allclose(simulation.state.rotor_velocity, expected, **tolerance)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_delay_shifts_what_a_motor_does_by_whole_steps(engine, hangar):
    tags = {"timeConstantUp": 0.05, "timeConstantDown": 0.2}
    prompt, late = (
        hangar(make_lagging({**tags, "delay": delay}), engine=engine) for delay in (0, 0.007)
    )
    rates = {}
    for simulation in (prompt, late):
        rows = []
        for step in range(120):
            if step % 30 == 10:
                simulation.command([400 - step, -300 + step, 200, -100])
            simulation.step()
            rows.append(simulation.state.rotor_velocity.copy())
        rates[simulation] = np.array(rows)
    assert not rates[late][:17].any() and rates[prompt][10].all()
    assert rates[late][7:].tobytes() == rates[prompt][:-7].tobytes()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_motor_in_flight_survives_a_snapshot_and_is_cut(engine, hangar):
    urdf = vehicle(ODD, inertia=SKEW, air=CHAPTER2)
    urdf = with_plugins(urdf, plugin("motor", {"delay": 0.02, "maxVelocity": 460}))
    simulation = hangar(urdf, G, engine=engine)
    fly(simulation, 10)
    middle = simulation.snapshot()
    second = fly(simulation, 100)
    assert simulation.topic("saturation")["steps"] == 110
    simulation.restore(middle)
    assert_same_bytes(second, fly(simulation, 100))
    assert np.abs(simulation.state.rotor_velocity).max() < 461
    simulation.publish("power", [0] * 4)
    simulation.step()
    coasting = simulation.state.rotor_velocity.copy()
    simulation.step(100)
    assert np.allclose(simulation.state.rotor_velocity, coasting, rtol=0.02)


def test_settings_beyond_a_motor_are_reported(hangar):
    with pytest.raises(
        qc.InputError, match=r"<delay> 0.0015 is not a whole number of steps of 0.001"
    ):
        hangar(make_lagging({"delay": 0.0015}))
    with pytest.warns(qc.QuadcoreWarning, match="a time constant is too short for the step"):
        hangar(make_lagging({"timeConstantUp": 0.0001}))


GROUND = "<sdf><world><include><uri>model://ground_plane</uri></include></world></sdf>"


@pytest.mark.parametrize("engine", ENGINES)
def test_near_the_ground_a_rotor_lifts_more(engine, tmp_path):
    urdf = vehicle(ODD, air={**AIR, "sim_slow": 2})
    urdf = with_plugins(urdf, plugin("ground_effect", {"rotorRadius": 0.1}))
    (tmp_path / "a.urdf").write_text(urdf)
    (tmp_path / "a.world").write_text(GROUND)
    simulation = qc.Simulation(
        tmp_path / "a.urdf", world=tmp_path / "a.world", engine=engine, spawn=(0, 0, 5)
    )
    simulation.step()
    for radii, factor in ((0.2, 4 / 3), (0.5, 4 / 3), (1, 1.066667), (2, 1.015873), (50, 1.000025)):
        for i, rotor in enumerate(ODD):
            rates = 250 * np.eye(4)[i] * (-1) ** i
            start(simulation, position=(3, 4, 0.1 * radii - rotor.xyz[2]), rotor_velocity=rates)
            found = wrenches(simulation)
            lifted = 1 + found["ground_effect"][2] / found["thrust"][2]
            assert lifted == pytest.approx(factor, abs=1e-6), radii
            assert np.allclose(
                found["ground_effect"], (lifted - 1) * found["thrust"], rtol=1e-9, atol=1e-12
            )


def test_ground_effect_where_there_is_no_ground_is_reported(hangar):
    urdf = with_plugins(vehicle(air=AIR), plugin("ground_effect", {}))
    with pytest.warns(qc.QuadcoreWarning, match="the world has no ground plane"):
        hangar(urdf)


def test_the_shipped_vehicles_hear_of_faults():
    for name in ("quadrotor", "hexarotor", "crazyflie"):
        topics = qc.Simulation(name).topics
        assert topics["effectiveness"].writer is None and topics["power"].writer is None
    simulation = quadrotor()
    simulation.publish("power", [0, 1, 1, 1])
    simulation.command([400] * 4)
    simulation.step(10)
    assert simulation.state.rotor_velocity[0] == pytest.approx(0, abs=0.05)


def test_a_controller_that_starts_in_mid_flight_has_the_model_of_the_undamaged_vehicle(hangar):
    """Later faults are published on topics, or not at all."""
    simulation = hangar(with_plugins(make_motored(), plugin("fault", {"losses": "0.001 1 0.9"})), G)
    controller = qc.controllers.geometric()
    start = simulation.state.copy()
    controller.reset(simulation)
    hover = controller(0, start, qc.references.hover()(0))
    simulation.step(10)
    controller.reset(simulation)
    assert np.array_equal(controller(0, start, qc.references.hover()(0)), hover)


def test_two_faults_on_one_topic_before_one_step_end_the_flight(hangar):
    simulation = hangar(with_plugins(make_motored(), plugin("fault", {})), G)
    simulation.publish("fault", (1, 0, 0))
    simulation.publish("fault", (2, 0, 0))
    with pytest.raises(qc.FlightError, match="two messages were published in one step"):
        simulation.step()
