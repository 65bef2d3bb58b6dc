"""State, time, commands and failure of a simulation are what its calls say."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
from flights import BUSY, ENGINES, HOVER, MANOEUVRE, bits, hold_height, quadrotor
from vehicles import AIR, COM, MOTOR, Rotor, start, vehicle

import quadcore as qc
from quadcore import _core
from quadcore.simulation import flight


def test_a_hover_holds_height_by_its_odometry():
    simulation = quadrotor(parameters=BUSY)
    hold_height(simulation, 2000)
    assert abs(simulation.state.position[2] - 10) < 0.5


def test_a_vehicle_with_its_mass_off_the_middle_hovers_level_at_its_hover_speed(hangar):
    flying = hangar(
        vehicle(com=COM, air=AIR, motor=MOTOR), engine="eigen", gravity=(0, 0, -3.7), dt=1e-4
    )
    flying.command(flying.hover_speed)
    start(flying, rotor_velocity=flying.hover_speed)
    flying.step(10000)
    assert np.ptp(np.abs(flying.hover_speed)) > 5
    assert np.allclose(flying.state.orientation, [0, 0, 0, 1], atol=1e-6)
    assert np.allclose(flying.state.linear_velocity, 0, atol=1e-5)
    assert list(flying.gravity) == [0, 0, -3.7]


def test_hovering_at_a_tenth_of_the_speed_is_commanded_at_full_speed():
    """As sim_slow has it: the plant's joints turn slower than the command says."""
    slow, full = quadrotor(), quadrotor(xacro_args={"sim_slow": 1})
    assert np.allclose(slow.hover_speed, full.hover_speed)
    weight = full.mass * 9.8
    assert np.isclose(1.1487e-5 * np.sum(full.hover_speed**2), weight, rtol=1e-6)


def test_a_vehicle_that_its_rotors_cannot_hold_has_no_hover_speed():
    weak = quadrotor(parameters={"motorpid_plugin.maxVelocity": 300})
    with pytest.raises(qc.InputError, match="the rotors cannot hold the vehicle"):
        weak.hover_speed  # noqa: B018


@pytest.mark.parametrize("engine", ENGINES)
def test_a_state_that_is_set_is_the_state(engine):
    simulation = quadrotor(engine)
    wanted = simulation.state.copy()
    wanted.time = 3.5
    wanted.position[:] = 1, -2, 30
    wanted.orientation[:] = np.array([0.1, -0.7, 0.3, 0.5]) / np.sqrt(0.84)
    wanted.linear_velocity[:] = 3, 2, -1
    wanted.angular_velocity[:] = 0.5, -0.25, 2
    wanted.rotor_velocity[:] = 40, -41, 42, -43
    wanted.rotor_angle[:] = -3, 3, 0.5, 0
    simulation.set_state(wanted)
    for name in wanted.__slots__:
        assert np.allclose(
            getattr(simulation.state, name), getattr(wanted, name), rtol=0, atol=1e-13
        ), name
    simulation.step()
    assert simulation.time == 3.501


@pytest.mark.parametrize(("engine", "apart"), [("gazebo11", 1e-4), ("ode", 1e-4), ("eigen", 1e-12)])
def test_a_state_that_is_put_back_flies_on_alike(engine, apart):
    simulation = quadrotor(engine)
    simulation.run(0.5, MANOEUVRE)
    state = simulation.state.copy()
    flown = simulation.run(0.5).table
    simulation.set_state(state)
    # ODE's bodies are put back onto their hinges, from which they had drifted a little.
    assert np.allclose(simulation.run(0.5).table, flown, rtol=0, atol=apart)


def test_live_views_follow_the_flight_and_cannot_be_written():
    simulation = quadrotor()
    position = simulation.state.position
    copy = simulation.state.copy()
    simulation.step(100)
    assert position[2] < 10
    assert position is simulation.state.position
    assert copy.position[2] == 10
    for name in copy.__slots__[1:]:
        view = getattr(simulation.state, name)
        assert np.shares_memory(view, getattr(simulation.state, name))
        with pytest.raises(ValueError, match="read-only"):
            view[0] = 1
        with pytest.raises(AttributeError, match=rf"state.{name} is read-only\. Change a state.co"):
            setattr(simulation.state, name, view)
        assert not np.shares_memory(view, getattr(copy, name))


def test_live_views_outlive_the_simulation():
    simulation = quadrotor()
    simulation.step(10)
    position = simulation.state.position
    expected = position.copy()
    del simulation
    quadrotor().step(1000)
    assert np.array_equal(position, expected)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_snapshot_goes_on_in_another_simulation_of_its_kind(engine):
    simulation, other = quadrotor(engine, parameters=BUSY), quadrotor(engine, parameters=BUSY)
    hold_height(simulation, 50)
    other.restore(simulation.snapshot())
    assert hold_height(other, 50) == hold_height(simulation, 50)


def test_no_step_changes_nothing():
    simulation = quadrotor(parameters=BUSY)
    hold_height(simulation, 50)
    before = bits(simulation)
    simulation.step(0)
    assert bits(simulation) == before


def test_time_counts_whole_steps():
    simulation = quadrotor(dt=0.003)
    simulation.step(7)
    assert simulation.dt == 0.003
    assert simulation.time == simulation.state.time == 7 * 0.003
    assert simulation.topic("odom")["stamp"] == 7 * 0.003


@pytest.mark.parametrize(("log_every", "rows"), [(1, 101), (7, 15), (100, 2), (101, 1)])
def test_a_log_begins_at_once_and_has_a_row_every_so_many_steps(log_every, rows):
    simulation = quadrotor()
    simulation.step(3)
    log = simulation.run(0.1, MANOEUVRE, log_every=log_every)
    assert simulation.time == 103 * 0.001
    assert np.array_equal(log.time, (3 + log_every * np.arange(rows)) * 0.001)
    again = quadrotor()
    again.step(3)
    assert np.array_equal(again.run(0.1, MANOEUVRE).table[::log_every], log.table)


def test_a_log_of_many_pieces_is_that_of_one(monkeypatch):
    def log():
        sim = quadrotor("eigen")
        return sim.run(0.5, controller="geometric", reference="spiral", wrenches=True)

    whole = log()
    monkeypatch.setattr(flight, "_ROWS", 7)
    pieces = log()
    assert len(whole) == 501 and pieces.columns == whole.columns
    assert pieces.table.tobytes() == whole.table.tobytes()
    for name, wrench in whole.wrenches.items():
        assert pieces.wrenches[name].tobytes() == wrench.tobytes()


@pytest.mark.parametrize("engine", ENGINES)
def test_logs_without_joint_angles_leave_the_state_up_to_date(engine):
    logged, stepped = quadrotor(engine), quadrotor(engine)
    for sim in (logged, stepped):
        sim.command(HOVER)
    logged.run(0.05)
    stepped.step(50)
    assert bits(logged) == bits(stepped)


def test_a_run_ends_with_the_last_step_that_fits():
    assert len(quadrotor().run(0)) == 1
    assert len(quadrotor().run(0.0019)) == 2
    assert len(quadrotor(dt=0.1).run(0.3)) == 4  # 0.3/0.1 is a little less than 3


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_a_rotor_on_a_hinge_may_turn_half_a_turn_per_step_and_no_more(engine):
    simulation = quadrotor(engine)
    state = simulation.state.copy()
    state.rotor_velocity[2] = 0.9999 * np.pi / simulation.dt
    simulation.set_state(state)
    simulation.step()
    state.rotor_velocity[2] = -1.0001 * np.pi / simulation.dt
    simulation.set_state(state)
    with pytest.raises(qc.FlightError, match="rotor 'rotor3' turns more than half a turn per step"):
        simulation.step()


def test_a_small_vehicle_saturates_in_eigen_at_more_than_half_a_turn_per_step():
    """The rotor's angle is a periodic state there: coarse steps fly as fine ones do."""

    def fly_step(dt):
        free = {"motorpid_plugin.maxVelocity": 1e9}
        simulation = qc.Simulation(
            "crazyflie", engine="eigen", dt=dt, parameters=free, spawn=(0, 0, 9)
        )
        simulation.command([5000, -4990, 5000, -4990])
        if dt < 1e-3:
            simulation.step(1000)
            return simulation
        with pytest.warns(qc.QuadcoreWarning, match="more than half a turn per step, so its"):
            simulation.step(250)
        simulation.step(250)
        return simulation

    coarse, fine = fly_step(1e-3), fly_step(5e-4)
    assert coarse.time == fine.time
    assert np.abs(coarse.state.rotor_velocity).min() * coarse.dt > np.pi
    assert [w for w in coarse.warnings if "half a turn" in w] == coarse.warnings[-1:]
    assert not fine.warnings
    assert np.abs(coarse.state.rotor_angle).max() <= np.pi
    assert coarse.state.position == pytest.approx(fine.state.position, abs=1e-6)
    assert coarse.state.rotor_velocity == pytest.approx(fine.state.rotor_velocity, rel=1e-9)


def test_the_worlds_step_holds_unless_another_is_given(toy):
    world = (toy / "toy.world").read_text()
    (toy / "toy.world").write_text(world.replace(">0.001<", ">0.004<"))
    assert qc.Simulation("toy.urdf", world="toy.world").dt == 0.004
    assert qc.Simulation("toy.urdf", world="toy.world", dt=0.002).dt == 0.002
    assert qc.Simulation("toy.urdf").dt == 0.001


@pytest.mark.parametrize("slow", [1, 8.0, "18"])
def test_parameters_and_xacro_arguments_mean_the_same(slow):
    names = ("drone_plugin.sim_slow", "motorpid_plugin.sim_slow")
    by_tag = quadrotor(parameters=dict.fromkeys(names, slow))
    by_argument = quadrotor(xacro_args={"sim_slow": slow})
    tables = [simulation.run(0.1, MANOEUVRE).table for simulation in (by_tag, by_argument)]
    assert np.array_equal(*tables)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_failed_flight_keeps_its_log_and_can_be_taken_up_again(engine):
    parameters = {**BUSY, "motorpid_plugin.maxVelocity": 1e6}
    simulation = quadrotor(engine, parameters=parameters)
    too_fast = [[0, *HOVER], [0.1, *(1000 * HOVER)]]
    snapshot = simulation.snapshot()
    with pytest.raises(qc.FlightError) as failed:
        simulation.run(1, too_fast)
    message, late = "turns more than half a turn per step. Use a smaller step", 0.0
    if engine == "eigen":  # whose last step ends where nothing can be logged
        message, late = "the motion diverged. This warning came before: ", simulation.dt
    assert message in str(failed.value)
    assert "plugin 'drone_plugin'" in str(failed.value)
    assert 0.1 < failed.value.time < 0.7
    assert failed.value.log.time[-1] == pytest.approx(failed.value.time - late, abs=1e-12)
    assert failed.value.time == simulation.time
    began = quadrotor(engine, parameters=parameters).run(0.1, too_fast)
    assert np.array_equal(failed.value.log.table[:101], began.table)
    with pytest.raises(qc.FlightError, match="To continue, call reset, restore or set_state"):
        simulation.step()

    expected = hold_height(quadrotor(engine, parameters=parameters), 100)
    simulation.reset()
    assert hold_height(simulation, 100) == expected
    with pytest.raises(qc.FlightError):
        simulation.run(1, too_fast)
    simulation.restore(snapshot)
    assert hold_height(simulation, 100) == expected
    with pytest.raises(qc.FlightError):
        simulation.run(1, too_fast)
    simulation.set_state(quadrotor().state.copy())
    simulation.command(HOVER)
    simulation.step(100)
    assert simulation.time == pytest.approx(0.1)


@pytest.mark.parametrize("rotors", [4, 60])
@pytest.mark.parametrize("call", ["step", "run"])
def test_an_interrupt_is_heard_soon_however_slow_a_step(rotors, call, hangar, alarm):
    simulation = hangar(vehicle([Rotor((0.1 * i, 0, 0)) for i in range(rotors)]))
    begin = time.process_time()
    alarm(0.1)
    with pytest.raises(KeyboardInterrupt) as interrupted:
        simulation.step(10**9) if call == "step" else simulation.run(10**6)
    assert time.process_time() - begin < 20  # not the hours that all the steps would take
    if call == "run":
        assert len(interrupted.value.log) > 1
    simulation.step(1)


def test_log_state_topics_and_warnings_cannot_be_read_while_another_thread_writes_them():
    simulation = quadrotor("eigen")
    flight = _core.Flight(simulation, None, 1)
    flying = threading.Thread(target=flight.advance, args=(200000,))
    flying.start()
    while simulation.time == 0:
        pass
    for read in (
        flight.take,
        simulation.state.copy,
        lambda: simulation.topic("odom"),
        lambda: simulation.warnings,
    ):
        with pytest.raises(qc.InputError, match="is in use by another thread"):
            read()
    flying.join()
    table, wrenches = flight.take()
    assert len(table) == len(wrenches) == 200001


@pytest.mark.parametrize("engine", ENGINES)
def test_a_motion_that_diverges_ends_the_flight(engine, toy):
    world = (toy / "toy.world").read_text()
    (toy / "toy.world").write_text(world.replace("0 0 -9.8", "0 0 -1.01e8"))
    simulation = qc.Simulation("toy.urdf", engine=engine, world="toy.world")
    with pytest.raises(qc.FlightError, match="the motion diverged") as failed:
        simulation.step(1000)
    assert failed.value.time == pytest.approx(0.01)  # beyond 1e6 m/s
