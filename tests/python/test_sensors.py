"""What sensors have in common: rate, delay, dropout, seed."""

from __future__ import annotations

import math

import pytest
from flights import ENGINES
from hooked import G, assert_same_bytes, fly, make_motored, with_plugins
from sensed import NOISY, TOPIC, make_mounted, rows_of
from vehicles import plugin, start

import quadcore as qc


@pytest.mark.parametrize("name", sorted(NOISY))
def test_a_delayed_message_is_an_earlier_one_bit_for_bit(name, hangar):
    tags = {"rate": 200, **NOISY[name]}
    prompt, late = (
        hangar(make_mounted(name, {**tags, "delay": delay}), G, engine="eigen", seed=3)
        for delay in (0, 0.0123)
    )
    for simulation in (prompt, late):
        start(simulation, angular_velocity=(0.3, -0.2, 0.5))
    in_time, in_delay = (rows_of(s, TOPIC[name], 400) for s in (prompt, late))
    rate = tags["rate"]
    lost = math.ceil(0.0123 * rate)
    assert len(in_delay) in (len(in_time) - lost, len(in_time) - lost + 1)
    assert in_delay.tobytes() == in_time[: len(in_delay)].tobytes()
    late.step()
    assert late.time - late.topic(TOPIC[name])["stamp"] >= 0.0123 - 1e-9


@pytest.mark.parametrize("name", sorted(NOISY))
def test_messages_get_lost_by_the_binomial_law_and_leave_the_others_as_they_are(name, hangar):
    tags = {**NOISY[name], "rate": 1000}
    all_of_them, some = (
        hangar(make_mounted(name, {**tags, "dropout": p}), G, engine="eigen", seed=4)
        for p in (0, 0.3)
    )
    everything, arrived = (rows_of(s, TOPIC[name], 4000) for s in (all_of_them, some))
    expected, deviation = 0.7 * len(everything), math.sqrt(len(everything) * 0.3 * 0.7)
    assert abs(len(arrived) - expected) < 4 * deviation
    sent = {row.tobytes() for row in everything}
    assert all(row.tobytes() in sent for row in arrived)


@pytest.mark.parametrize("engine", ENGINES)
def test_sensors_survive_a_snapshot_and_repeat_with_their_seed(engine, hangar):
    more = {"delay": 0.0123, "dropout": 0.1}
    elements = [plugin(name, {**tags, **more}) for name, tags in NOISY.items()]
    simulation = hangar(with_plugins(make_motored(), *elements), G, engine=engine, seed=5)

    def fly_and_read(steps):
        log = simulation.run(steps * simulation.dt, topics=list(TOPIC.values()))
        return b"".join(log.topics[t][f].tobytes() for t in TOPIC.values() for f in log.topics[t])

    fly(simulation, 50)
    middle = simulation.snapshot()
    second = fly_and_read(100)
    simulation.restore(middle)
    assert fly_and_read(100) == second
    simulation.reset()
    fly(simulation, 50)
    assert fly_and_read(100) == second
    simulation.reset(seed=6)
    fly(simulation, 50)
    assert fly_and_read(100) != second


def test_a_delay_that_cannot_be_kept_is_refused(hangar):
    with pytest.raises(qc.InputError, match="<delay> is too long for the message buffer"):
        hangar(make_mounted("imu", {"delay": 1e6}))


def test_what_flies_is_not_moved_by_what_measures(hangar):
    elements = [plugin(name, tags) for name, tags in NOISY.items()]
    for engine in ENGINES:
        bare = fly(hangar(make_motored(), G, engine=engine), 100)
        assert_same_bytes(
            bare, fly(hangar(with_plugins(make_motored(), *elements), G, engine=engine), 100)
        )
