"""What a run calls back may read the vehicle and publish, but not move it."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from flights import ENGINES, HOVER, quadrotor

import quadcore as qc

MOVES = {
    "step()": lambda sim: sim.step(1),
    "run()": lambda sim: sim.run(0.005),
    "reset()": lambda sim: sim.reset(),
    "restore()": lambda sim: sim.restore(sim.snapshot()),
    "set_state()": lambda sim: sim.set_state(sim.state.copy()),
    "command()": lambda sim: sim.command(HOVER),
    "publish()": lambda sim: sim.publish("vel_cmd", HOVER),
}
SAYS = (
    "{}: this simulation is running, and callbacks may only read it and publish. "
    "Return the command from the callback, and use a separate simulation for predictions."
)


def late(simulation, act):
    """Act once the flight is under way, as often as asked to."""
    return lambda *_: act(simulation) if simulation.time > 0.0095 else None


def by_controller(simulation, act):
    act = late(simulation, act)
    return {"controller": lambda *_: (act(), HOVER)[1]}


def by_reference(simulation, act):
    act = late(simulation, act)
    hover = qc.references.hover(height=10)
    return {"controller": "pd", "reference": lambda t: (act(), hover(t))[1]}


def by_progress(simulation, act):
    return {"commands": [[0, *HOVER]], "progress": late(simulation, act)}


CALLED_BACK = {"controller": by_controller, "reference": by_reference, "progress": by_progress}


@pytest.mark.parametrize("call", MOVES)
@pytest.mark.parametrize("who", CALLED_BACK)
def test_who_moves_a_vehicle_in_flight_ends_the_flight_and_its_log_stays(who, call):
    """A duration of several pieces, with a call of progress between them."""
    simulation, untouched = (quadrotor("eigen") for _ in range(2))
    options = CALLED_BACK[who](simulation, MOVES[call])
    with pytest.raises(qc.InputError) as error:
        simulation.run(0.5, **options)
    assert str(error.value) == SAYS.format(call)
    log = error.value.log
    assert len(log) >= 10
    assert log.time == pytest.approx(np.arange(len(log)) * 0.001)
    quiet = CALLED_BACK[who](untouched, lambda sim: None)
    expected = untouched.run(log.time[-1], **quiet)
    assert (log.position == expected.position).all()
    assert simulation.time == log.time[-1]
    MOVES[call](simulation)  # the run is over


def test_a_controller_may_put_the_vehicle_where_the_flight_begins():
    class Lifts:
        def reset(self, simulation):
            state = simulation.state.copy()
            state.position[:] = 1, -2, 13
            simulation.set_state(state)

        def __call__(self, t, state, reference):
            return HOVER

    log = quadrotor("eigen").run(0.1, controller=Lifts())
    other = quadrotor("eigen", spawn=(1, -2, 13)).run(0.1, controller=lambda *_: HOVER)
    assert (log.table == other.table).all()


def test_a_reference_that_moves_the_vehicle_which_is_put_onto_it_is_refused():
    simulation = quadrotor("eigen")
    with pytest.raises(qc.InputError, match=r"^step\(\): this simulation is running"):
        simulation.run(0.1, controller="pd", reference=lambda t: simulation.step(), on_reference=1)
    assert simulation.time == 0


@pytest.mark.parametrize("engine", ENGINES)
def test_who_only_reads_and_publishes_flies_the_same_bytes(engine):
    """A controller may predict with a simulation of its own in the present state."""

    class Looks:
        def reset(self, simulation):
            self.simulation = simulation
            self.own = quadrotor(engine)

        def __call__(self, t, state, reference):
            sim = self.simulation
            assert sim.time == sim.state.time == t
            assert (sim.topic("odom")["z"], "odom" in sim.topics) == (state.position[2], True)
            sim.publish("effectiveness", [1, 1, 1, 1])
            self.own.restore(sim.snapshot())
            self.own.run(0.003, commands=[[0, *HOVER]])
            assert sim.state.copy().time == t and len(sim.hover_speed) == sim.rotor_count
            return HOVER

    plain = quadrotor(engine).run(0.03, controller=lambda *_: HOVER)
    assert quadrotor(engine).run(0.03, controller=Looks()).table.tobytes() == plain.table.tobytes()


def test_a_controller_that_catches_the_error_flies_as_if_it_had_not_tried():
    simulation = quadrotor("eigen")

    def stubborn(t, state, reference):
        with pytest.raises(qc.InputError):
            simulation.step(1)
        return HOVER

    plain = quadrotor("eigen").run(0.03, controller=lambda *_: HOVER)
    assert (simulation.run(0.03, controller=stubborn).table == plain.table).all()


def test_a_run_that_is_refused_leaves_its_controller_alone():
    class Counts:
        begun = 0

        def reset(self, simulation):
            self.simulation, self.begun = simulation, self.begun + 1

        def __call__(self, t, state, reference):
            with pytest.raises(qc.InputError):
                self.simulation.run(0.01, controller=self)
            return HOVER

    controller = Counts()
    quadrotor("eigen").run(0.01, controller=controller)
    assert controller.begun == 1


def test_a_call_from_another_thread_is_refused():
    simulation, messages = quadrotor("eigen"), []

    def meddle():
        for move in MOVES.values():
            with pytest.raises(qc.InputError) as error:
                move(simulation)
            messages.append(str(error.value))

    def controller(t, state, reference):
        if t == 0:
            thread = threading.Thread(target=meddle)
            thread.start()
            thread.join()
        return HOVER

    simulation.run(0.01, controller=controller)
    assert messages == [
        "this simulation is in use by another thread. Use a separate simulation for each thread."
    ] * len(MOVES)  # fmt: skip


def test_after_a_flight_that_failed_the_simulation_may_be_moved():
    simulation = quadrotor("eigen")
    with pytest.raises(ZeroDivisionError) as error:  # which is kept, with all of its frames
        simulation.run(0.1, controller=lambda *_: 1 / 0)
    simulation.step(3)
    simulation.reset()
    assert len(simulation.run(0.01, [[0, *HOVER]])) == 11 > len(error.value.log)


def test_a_reference_that_fails_costs_no_row_of_the_log():
    hover = qc.references.hover(height=10)

    def reference(t):
        if t > 0.0495:
            raise ValueError("no idea")
        return hover(t)

    with pytest.raises(ValueError, match="no idea") as error:
        quadrotor("eigen").run(1.0, controller="pd", reference=reference)
    log = error.value.log
    assert log.time[-1] == pytest.approx(0.05)
    assert np.isnan(log.topics["reference"]["x"][-1])


def test_an_evaluated_controller_that_moves_the_vehicle_is_a_row_that_failed():
    class Moves:
        def reset(self, simulation):
            self.simulation = simulation

        def __call__(self, t, state, reference):
            self.simulation.step(1)
            return HOVER

    found = qc.evaluate(
        [Moves()], ["hover"], engines=["eigen"], duration=0.1, processes=1, privileged=True
    )
    assert "step(): this simulation is running" in found.table[0]["failure"]
