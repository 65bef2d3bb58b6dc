"""A simulation repeats itself to the last bit, and leaves nothing behind."""

from __future__ import annotations

import gc
import multiprocessing
import threading
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from flights import BUSY, ENGINES, HOVER, MANOEUVRE, bits, hold_height, quadrotor
from hooked import CHAPTER2, G, with_plugins
from vehicles import MOTOR, ODD, SKEW, plugin, start, vehicle

import quadcore as qc

ALOFT = {"spawn": (1, 2, 10, 0.3, -0.2, 1), "parameters": BUSY}
# It falls, tumbles on the ground and jumps: contacts come and go.
GROUNDED = {"spawn": (1, 2, 0.2, 0.3, -0.2, 1), "world": "default", "parameters": BUSY}

everywhere = pytest.mark.parametrize(
    ("engine", "place"),
    [(engine, flight) for engine in ENGINES for flight in (ALOFT, GROUNDED)],
    ids=lambda value: value if isinstance(value, str) else value.get("world", "empty"),
)


def fly(simulation, steps):
    return hold_height(simulation, steps, simulation.state.position[2])


def csv(log, folder):
    log.to_csv(folder / "log.csv")
    return (folder / "log.csv").read_bytes()


def test_the_grounded_flight_touches_the_ground():
    simulation = quadrotor(**GROUNDED)
    fly(simulation, 500)
    assert simulation.state.position[2] < 0.1


@everywhere
def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(engine, place):
    def fly_noisy(seed):
        return fly(quadrotor(engine, seed=seed, **place), 500)

    assert fly_noisy(7) == fly_noisy(7)
    assert fly_noisy(7) != fly_noisy(8)


def test_two_runs_write_the_same_log(tmp_path):
    first, second = (quadrotor(parameters=BUSY).run(1, MANOEUVRE) for _ in range(2))
    assert csv(first, tmp_path) == csv(second, tmp_path)


@everywhere
def test_a_restored_snapshot_flies_the_same_bytes(engine, place):
    simulation = quadrotor(engine, **place)
    fly(simulation, 333)
    snapshot = simulation.snapshot()
    flown = fly(simulation, 1000)
    simulation.restore(snapshot)
    assert fly(simulation, 1000) == flown
    other = quadrotor(engine, **place)
    fly(other, 10)
    other.restore(snapshot)
    assert fly(other, 1000) == flown


@everywhere
def test_a_reset_simulation_is_a_new_one(engine, place):
    simulation = quadrotor(engine, **place)
    new = bits(simulation)
    flown = fly(simulation, 500)
    simulation.reset()
    assert simulation.time == 0
    assert simulation.topic("vel_cmd")["count"] == 0
    assert bits(simulation) == new
    assert fly(simulation, 500) == flown
    assert fly(quadrotor(engine, **place), 500) == flown


def test_many_steps_are_as_many_single_steps():
    at_once, one_by_one = quadrotor(parameters=BUSY), quadrotor(parameters=BUSY)
    for simulation in (at_once, one_by_one):
        simulation.command(HOVER)
    at_once.step(500)
    for _ in range(500):
        one_by_one.step()
    assert bits(at_once) == bits(one_by_one)


def table(engine, place, seed=0, duration=2):
    return quadrotor(engine, seed=seed, **place).run(duration, MANOEUVRE, log_every=10).table


@everywhere
def test_threads_fly_the_bytes_that_each_flies_alone(engine, place):
    def work(seed):  # long enough for the threads to meet
        here = {**place, "spawn": (0, 0, 0.2, 0.1 * seed, 0, 0)}
        return table(engine, here, seed, duration=3 if "world" in place else 12)

    seeds = [0, 1, 2] * 4
    with ThreadPoolExecutor(3) as pool:
        together = list(pool.map(work, seeds))
    alone = [work(seed) for seed in range(3)]
    for seed, flown in zip(seeds, together):
        assert np.array_equal(flown, alone[seed])


@everywhere
def test_a_simulation_may_move_to_another_thread(engine, place):
    simulation, moved = quadrotor(engine, **place), quadrotor(engine, **place)
    flown = fly(simulation, 500)
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(fly, moved, 500).result() == flown


@everywhere
def test_forked_workers_fly_the_same_bytes(engine, place):
    here = table(engine, place)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for there in pool.starmap(table, [(engine, place)] * 2):
            assert np.array_equal(there, here)


def test_one_simulation_refuses_a_second_thread_at_once():
    simulation = quadrotor()
    worker = threading.Thread(target=simulation.step, args=(100000,))
    worker.start()
    while simulation.time == 0:
        pass
    for call in (simulation.step, simulation.snapshot, lambda: simulation.command(HOVER)):
        with pytest.raises(qc.QuadcoreError, match=r"in use by another thread\. Use a separate"):
            call()
    worker.join()
    simulation.step()
    assert simulation.time == 100.001


def test_a_simulation_dies_with_its_last_reference():
    gc.disable()
    try:
        simulation = quadrotor()
        simulation.run(0.01)
        gone = weakref.ref(simulation)
        del simulation
        assert gone() is None
    finally:
        gc.enable()


def resident_bytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


def test_a_thousand_simulations_leave_no_memory_behind(toy):
    def come_and_go(count):
        for _ in range(count):
            qc.Simulation("toy.urdf").run(0.001)

    def measure_growth():
        before = resident_bytes()
        come_and_go(300)
        return resident_bytes() - before

    come_and_go(100)
    # A leak of one kilobyte per simulation grows each time; a new page of the allocator does not.
    assert min(measure_growth() for _ in range(3)) < 300 * 1000


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("drag_model", ["appendix", "chapter2"])
def test_plugins_act_as_if_updated_in_every_step(engine, drag_model, hangar):
    air = {**CHAPTER2, "dragModel": drag_model}
    alone = with_plugins(
        vehicle(ODD, inertia=SKEW, air=air), plugin("motorpid", {**MOTOR, "maxVelocity": 460})
    )
    updated = with_plugins(alone, plugin("reference", {"shape": "hover"}))  # in every step
    flights = []
    for urdf in (alone, updated):
        simulation = hangar(urdf, G, engine=engine)
        start(simulation, orientation=(1, 0, 0, 0.7), angular_velocity=(3, 0, 0))
        numbers = []
        for step in range(120):
            if step % 40 == 10:
                simulation.command([400 + step, -300, 461, -100])
            if step == 60:
                simulation.publish("effectiveness", [0.5, 1, 1, 0])
            if step == 75:
                simulation.publish("power", [1, 0.8, 0, 1])
            if step == 90:
                simulation.restore(simulation.snapshot())
            simulation.step(1 + step % 3)
            state = simulation.state
            numbers += [*state.position, *state.orientation, *state.rotor_velocity]
            numbers.append(simulation.topic("saturation")["steps"])
        flights.append((numbers, simulation.warnings))
    assert flights[0] == flights[1]
    assert numbers[-1] > 0 and any("tilts" in line for line in simulation.warnings) == (
        drag_model == "appendix"
    )
