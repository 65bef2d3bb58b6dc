"""libpayload_plugin.so: what rides on the frame, is released, and picked up."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import CHAPTER2, G, assert_same_bytes, fly, make_motored, with_fixed_link, with_plugins
from vehicles import MOTOR, ODD, SKEW, plugin, start, text, vehicle

import quadcore as qc

MASS, PLACE, TURN = 0.23, (0.031, -0.017, -0.1234567), (0.3, -0.2, 0.9)
MOMENTS = (1.1e-4, 1.7e-4, 2.3e-4, 1e-5, -2e-5, 3e-5)  # xx yy zz xy xz yz
LOAD = {
    "mass": MASS,
    "inertia": text([MOMENTS[i] for i in (0, 3, 4, 1, 5, 2)]),
    "xyz": text(PLACE),
    "rpy": text(TURN),
}
SPEEDS = (510, -505, 515, -508)


def load_payload(**tags):
    return with_plugins(make_motored(), plugin("payload", {**LOAD, **tags}))


@pytest.mark.parametrize("engine", ENGINES)
def test_while_it_rides_it_is_a_link_of_the_urdf(engine, hangar):
    lumped = hangar(
        with_fixed_link(make_motored(), "load", MASS, MOMENTS, PLACE, TURN), G, engine=engine
    )
    carrying = hangar(load_payload(), G, engine=engine)
    assert carrying.mass == pytest.approx(lumped.mass, rel=1e-15)
    assert np.allclose(carrying.inertia, lumped.inertia, rtol=1e-14, atol=0)
    one, other = (fly(simulation, 5000, SPEEDS) for simulation in (lumped, carrying))
    apart = np.abs(one.position - other.position).max()
    print(engine, "apart", apart)
    assert apart <= 1e-12
    bare = fly(hangar(make_motored(), G, engine=engine), 5000, SPEEDS)
    assert np.abs(one.position - bare.position).max() > 1


@pytest.mark.parametrize("engine", ENGINES)
def test_after_its_release_the_bare_vehicle_flies_on(engine, hangar):
    released = hangar(load_payload(release=0.7), G, engine=engine)
    fly(released, 700)
    state = released.state.copy()
    assert released.mass > 1.2
    rest = fly(released, 1500)
    assert released.mass < 1.1
    bare = start(
        hangar(make_motored(), G, engine=engine), **{n: getattr(state, n) for n in state.__slots__}
    )
    alone = fly(bare, 1500)
    assert rest.table[1:, 1:].tobytes() == alone.table[1:, 1:].tobytes()  # all but the clock


def test_ode_and_eigen_approach_each_other_through_a_release(hangar):
    # Rotors that turn a radian in a step are too fast to see the order of a method.
    air, motor = {**CHAPTER2, "sim_slow": 10}, {**MOTOR, "sim_slow": 10}
    urdf = vehicle(ODD, inertia=SKEW, com=(0.01, -0.02, 0.03), air=air, motor=motor)
    urdf = with_plugins(urdf, plugin("payload", {**LOAD, "release": 0.192}))

    def end(engine, dt):
        simulation = hangar(urdf, G, engine=engine, dt=dt)
        return fly(simulation, round(0.384 / dt), SPEEDS).position[-1]

    exact = end("eigen", 0.0005)
    assert np.linalg.norm(end("eigen", 0.001) - exact) < 1e-9
    apart = [np.linalg.norm(end("ode", dt) - exact) for dt in (0.002, 0.001, 0.0005)]
    print("apart", apart)
    assert apart[0] > 1.8 * apart[1] and apart[1] > 1.8 * apart[2] and apart[2] < 1e-3


@pytest.mark.parametrize("engine", ENGINES)
def test_a_word_on_its_topic_lets_it_go_and_takes_it_up(engine, hangar):
    by_word, by_time = (
        hangar(load_payload(), G, engine=engine),
        hangar(load_payload(release=0.1), G, engine=engine),
    )
    first = [fly(simulation, 100, log_every=100) for simulation in (by_word, by_time)]
    by_word.publish("payload", [0])
    again = [fly(simulation, 100) for simulation in (by_word, by_time)]
    assert_same_bytes(*first)
    assert_same_bytes(*again)
    assert by_word.mass < 1.1
    by_word.publish("payload", [1])
    by_word.step()
    assert by_word.mass > 1.2


def test_the_later_of_time_and_word_holds(hangar):
    simulation = hangar(load_payload(release=0.1, pickUp=0.2), G)

    def rides():
        simulation.step(10)
        return simulation.mass > 1.2

    assert rides()
    simulation.publish("payload", [0])  # at 0.01
    assert not rides()
    simulation.publish("payload", [1])
    assert all(rides() for _ in range(7))  # to 0.09
    assert rides()  # to 0.1: the release begins with the next step
    assert not any(rides() for _ in range(10))
    assert rides()
    simulation.publish("payload", [0])
    assert not rides()


@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_picked_up_was_not_there_before(engine, hangar):
    simulation = hangar(load_payload(pickUp=0.1), G, engine=engine)
    bare = hangar(make_motored(), G, engine=engine)
    assert simulation.mass == bare.mass
    assert fly(simulation, 100).table.tobytes() == fly(bare, 100).table.tobytes()
    simulation.step()
    assert simulation.mass == pytest.approx(bare.mass + MASS, rel=1e-15)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_flight_is_taken_up_again_across_a_release(engine, hangar):
    simulation = hangar(load_payload(release=0.3), G, engine=engine)
    fly(simulation, 200)
    before = simulation.snapshot()
    first = simulation.run(0.3)
    after = simulation.snapshot()
    second = simulation.run(0.2)
    simulation.restore(before)
    assert simulation.mass > 1.2
    assert_same_bytes(first, simulation.run(0.3))
    simulation.restore(after)
    assert_same_bytes(second, simulation.run(0.2))
    simulation.reset()
    assert simulation.mass > 1.2


@pytest.mark.parametrize(
    ("tags", "says"),
    [
        ({"mass": 0}, "<mass> '0' is out of range"),
        ({"release": -1}, "<release> '-1' is out of range"),
        ({"release": 0.5, "pickUp": 0.5}, "<pickUp> and <release> are at the same time"),
        ({"inertia": "1 0 0 -1 0 1"}, "<inertia> is not physically possible"),
        ({"inertia": "1 0 0 0.1 0 0.1"}, "<inertia> is not physically possible"),
        ({"xyz": "1 2"}, "<xyz>"),
    ],
)
def test_a_payload_that_cannot_be_is_refused_with_its_line(tags, says, hangar):
    urdf = load_payload(**tags)
    line = 1 + urdf[: urdf.index("libpayload")].count("\n")
    with pytest.raises(qc.InputError, match=f"urdf:{line}: .*{says}"):
        hangar(urdf, G)


def test_a_word_that_is_none_ends_the_flight(hangar):
    simulation = hangar(load_payload(), G)
    simulation.publish("payload", [0.5])
    with pytest.raises(qc.FlightError, match="topic 'payload': riding is neither 1 nor 0"):
        simulation.step()
