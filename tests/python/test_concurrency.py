"""Simulations side by side, in turns, in threads and in processes, fly as each flies alone."""

from __future__ import annotations

import gc
import itertools
import multiprocessing
import queue
import sys
import threading
from pathlib import Path
from typing import NamedTuple, Optional

import numpy as np
import pytest
import xacro
from flights import BUSY, ENGINES, MANOEUVRE, quadrotor

import quadcore as qc

WORLD = """\
<sdf version="1.6">
  <world name="few_iterations">
    {ground}
    <physics type="ode"><ode><solver><iters>{iterations}</iters></solver></ode></physics>
  </world>
</sdf>
"""
GROUND = "<include><uri>model://ground_plane</uri></include>"


class Case(NamedTuple):
    """A flight that leans on all that an engine remembers: noise, warm starts, contacts."""

    engine: str
    iterations: int = 50
    ground: bool = False

    def world(self, folder: Path) -> Path:
        return folder / f"{self.iterations}_{self.ground}.world"

    def simulation(self, folder: Path) -> qc.Simulation:
        # On the ground it falls, tumbles and jumps.
        spawn = (0, 0, 0.2 if self.ground else 10, 0.3, -0.2, 1)
        world = self.world(folder)
        return quadrotor(self.engine, world=world, spawn=spawn, parameters=BUSY, seed=7)


CASES = [
    *(Case(engine) for engine in ENGINES),
    *(Case("gazebo11", iterations) for iterations in (10, 7)),  # ode needs none in flight
    *(Case(engine, 50, ground=True) for engine in ("gazebo11", "ode")),
    *(Case(engine, 5, ground=True) for engine in ("gazebo11", "ode")),
]


def fly_case(case: Case, folder: Path, simulation: Optional[qc.Simulation] = None) -> bytes:
    """Every bit of a flight of 0.4 s."""
    simulation = simulation or case.simulation(folder)
    log = simulation.run(0.4, MANOEUVRE)
    odometry = np.array(list(simulation.topic("odom").values()))
    return log.table.tobytes() + odometry.tobytes()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worlds")
    for case in CASES:
        ground = GROUND if case.ground else ""
        case.world(folder).write_text(WORLD.format(ground=ground, iterations=case.iterations))
    return folder


@pytest.fixture(scope="module")
def alone(folder):
    """What each case flies in a new process of its own."""
    with multiprocessing.get_context("spawn").Pool(2, maxtasksperchild=1) as pool:
        flights = pool.starmap(fly_case, [(case, folder) for case in CASES], chunksize=1)
    assert len(set(flights)) == len(CASES)
    return dict(zip(CASES, flights))


def test_one_after_the_other(alone, folder):
    for case in [*CASES, *reversed(CASES)]:
        assert fly_case(case, folder) == alone[case], case


def test_in_turns(alone, folder):
    simulations = [case.simulation(folder) for case in CASES]
    rows = [[] for _ in CASES]
    for step in range(400):
        for simulation, flight in zip(simulations, rows):
            # A piece of a log begins where the one before ended.
            flight.append(simulation.run(0.001, MANOEUVRE).table[0 if step == 0 else 1 :])
    for case, simulation, flight in zip(CASES, simulations, rows):
        odometry = np.array(list(simulation.topic("odom").values()))
        assert np.concatenate(flight).tobytes() + odometry.tobytes() == alone[case], case


def in_threads(work, count: int) -> None:
    """Run `work(i)` in as many threads at once; raises what one of them raises."""
    failures: queue.Queue = queue.Queue()

    def guarded(i):
        try:
            work(i)
        except BaseException as error:
            failures.put(error)

    threads = [threading.Thread(target=guarded, args=(i,)) for i in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if not failures.empty():
        raise failures.get()


def test_in_threads_of_different_engines_and_worlds(alone, folder):
    def work(i):
        for case in CASES[i:] + CASES[:i]:
            assert fly_case(case, folder) == alone[case], case

    in_threads(work, 4)


def test_made_flown_and_dropped_in_three_threads(alone, folder):
    simulations, flights = {}, {}

    def make(_):
        simulations.update((case, case.simulation(folder)) for case in CASES)

    def fly(_):
        flights.update((case, fly_case(case, folder, simulations[case])) for case in CASES)

    def drop(_):
        simulations.clear()
        gc.collect()

    for work in (make, fly, drop):
        in_threads(work, 1)
    assert flights == alone


def test_beside_flights_that_fail(alone, folder):
    # Forces beyond all bounds, at which ODE itself gives up.
    absurd = {"motorpid_plugin.kp": 1e300}
    stop = threading.Event()

    def fail():
        while not stop.is_set():
            for engine in ENGINES:
                with pytest.raises(qc.FlightError):
                    quadrotor(engine, parameters=absurd).run(0.1, MANOEUVRE)

    failing = threading.Thread(target=fail)
    failing.start()
    try:
        for case in CASES:
            assert fly_case(case, folder) == alone[case], case
    finally:
        stop.set()
        failing.join()


def test_in_forked_workers(alone, folder):
    in_threads(lambda i: fly_case(CASES[i], folder), 2)  # the parent has used its threads before
    with multiprocessing.get_context("fork").Pool(2) as pool:
        flights = pool.starmap(fly_case, [(case, folder) for case in CASES], chunksize=1)
    assert dict(zip(CASES, flights)) == alone


def test_a_simulation_flies_on_alike_on_both_sides_of_a_fork(folder):
    for case in CASES:
        simulation = case.simulation(folder)
        simulation.run(0.2, MANOEUVRE)
        context = multiprocessing.get_context("fork")
        receiver, sender = context.Pipe(duplex=False)
        child = context.Process(
            target=lambda case, one, to: to.send_bytes(fly_case(case, folder, one)),
            args=(case, simulation, sender),
        )
        child.start()
        here = fly_case(case, folder, simulation)
        assert receiver.recv_bytes() == here, case
        child.join()


def test_a_fork_beside_a_thread_that_expands_a_xacro_can_expand_one_too():
    ending = threading.Event()

    def expand():
        for slow in itertools.count(1):  # another each time, as expansions are kept
            qc.Simulation("quadrotor", xacro_args={"sim_slow": slow})
            if ending.is_set():
                return

    thread = threading.Thread(target=expand)
    thread.start()
    try:
        for _ in range(20):
            child = multiprocessing.get_context("fork").Process(
                target=qc.Simulation, kwargs={"xacro_args": {"sim_slow": 0.5}}
            )
            child.start()
            child.join(10)
            assert child.exitcode == 0
    finally:
        ending.set()
        thread.join()


def test_what_others_print_while_a_xacro_is_expanded_is_not_lost(monkeypatch):
    out = sys.stdout
    swapped = []
    expand = xacro.process_file

    def spy(*arguments, **options):
        swapped.append(sys.stdout is not out)
        return expand(*arguments, **options)

    monkeypatch.setattr(xacro, "process_file", spy)
    qc.Simulation("quadrotor", xacro_args={"sim_slow": 0.7})
    assert swapped == [False]
