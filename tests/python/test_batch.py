"""Batches: every vehicle moves as a simulation of it alone does."""

import time

import numpy as np
import pytest
import vehicles as v

import quadcore as qc
from quadcore import BatchSimulation, InputError, Simulation, _core

N = 21  # two blocks, and a part of a third
ROWS = np.arange(N)
SPAWN = np.column_stack([ROWS - 7, 1 + 0.1 * ROWS, 9 + 0.2 * ROWS, *np.zeros((2, N)), 0.3 * ROWS])
THRUST = np.linspace(8.0e-6, 9.0e-6, N)
COMMANDS = (500 + 20 * np.sin(np.arange(4 * N)).reshape(N, 4)) * [1, -1, 1, -1]
TAG = "aerodynamic.rotorThrustCoeff"


@pytest.fixture(scope="module", params=["appendix", "chapter2"])
def odd(request, tmp_path_factory):
    """A vehicle without any symmetry, with every force law."""
    air = {**v.LIFT, **v.DRAG, **v.FLAPPING, "dragModel": request.param}
    motor = {**v.MOTOR, "maxVelocity": 515}
    file = tmp_path_factory.mktemp("odd") / "odd.urdf"
    file.write_text(v.vehicle(v.ODD, 1.1, v.SKEW, v.COM, air, motor))
    return file


def fly(flight, commands, steps):
    """Three calls, each with weaker commands."""
    for k in range(3):
        flight.step(commands * (1 - 0.02 * k), steps)


def batch_of(model, n=N, **options):
    parameters = {TAG: THRUST[:n], **options.pop("parameters", {})}
    return BatchSimulation(model, n, spawn=SPAWN[:n], parameters=parameters, **options)


def alone(model, i, **options):
    parameters = {TAG: float(THRUST[i]), **options.pop("parameters", {})}
    options.setdefault("engine", "eigen")
    return Simulation(model, spawn=SPAWN[i], parameters=parameters, **options)


def fly_alone(sim, i, steps):
    for k in range(3):
        sim.command(COMMANDS[i] * (1 - 0.02 * k))
        sim.step(steps)
    return sim


def assert_same(batch, i, sim):
    for name, rows in batch.state._asdict().items():
        np.testing.assert_array_equal(rows[i], getattr(sim.state, name), err_msg=f"{name} of {i}")
    assert batch.time[i] == sim.time


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
@pytest.mark.parametrize("width", ["1", "2", "4", "8"])
def test_each_moves_as_it_does_alone_to_the_last_bit(odd, width, engine, monkeypatch):
    monkeypatch.setenv("QUADCORE_LANES", width)
    batch = batch_of(odd, engine=engine)
    fly(batch, COMMANDS, 40)
    monkeypatch.delenv("QUADCORE_LANES")  # alone, all its rotors side by side
    for i in (0, 7, 8, N - 1):
        assert_same(batch, i, fly_alone(alone(odd, i, engine=engine), i, 40))


def test_an_engine_without_lanes_flies_the_same_one_by_one(odd):
    batch = batch_of(odd, 3, engine="ode")
    fly(batch, COMMANDS[:3], 20)
    for i in range(3):
        assert_same(batch, i, fly_alone(alone(odd, i, engine="ode"), i, 20))


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_neither_threads_nor_neighbours_nor_the_length_of_calls_change_a_bit(odd, engine):
    batch = batch_of(odd, engine=engine, threads=1)
    fly(batch, COMMANDS, 30)
    expected = batch.read_state()
    several = batch_of(odd, engine=engine, threads=3)
    fly(several, COMMANDS, 30)
    np.testing.assert_array_equal(several.read_state(), expected)
    few = batch_of(odd, 3, engine=engine)
    fly(few, COMMANDS[:3], 30)
    np.testing.assert_array_equal(few.read_state(), expected[:3])
    piecewise = batch_of(odd, engine=engine)
    for k in range(3):
        for _ in range(30):
            piecewise.step(COMMANDS * (1 - 0.02 * k))
    np.testing.assert_array_equal(piecewise.read_state(), expected)


@pytest.mark.parametrize(("engine", "too_fast"), [("eigen", 9e5), ("gazebo11", 4000)])
def test_a_vehicle_that_fails_is_reported_and_the_others_go_on(engine, too_fast):
    commands = COMMANDS.copy()
    commands[5] = too_fast, -500, 500, -500
    parameters = {"drone_plugin.sim_slow": 1, "motorpid_plugin.sim_slow": 1}
    free = {**parameters, "motorpid_plugin.maxVelocity": 1e6}
    batch = BatchSimulation(n=N, engine=engine, spawn=SPAWN, parameters=free)
    batch.step(commands, 300)
    sim = Simulation(engine=engine, spawn=SPAWN[5], parameters=free)
    sim.command(commands[5])
    with pytest.raises(qc.FlightError) as failure:
        sim.step(300)
    assert list(np.flatnonzero(batch.failed)) == [5]
    assert batch.failures[5] == str(failure.value)
    for i in (4, 6):
        sim = Simulation(engine=engine, spawn=SPAWN[i], parameters=free)
        sim.command(commands[i])
        sim.step(300)
        assert_same(batch, i, sim)
    before = batch.read_state()
    batch.step(commands, 10)
    np.testing.assert_array_equal(batch.read_state()[5], before[5])
    batch.reset(batch.failed)
    assert not batch.failed.any()
    assert batch.time[5] == 0 and batch.time[4] == pytest.approx(0.31)


def test_vehicles_beyond_half_a_turn_per_step_fly_in_eigen_as_they_do_alone():
    """They leave the lanes for the warning and come back."""
    free = {"motorpid_plugin.maxVelocity": 1e6}
    commands = np.linspace(2900, 5000, 9)[:, None] * [1, -1, 1, -1]
    batch = BatchSimulation("crazyflie", 9, spawn=(0, 0, 5), parameters=free)
    for _ in range(30):
        batch.step(commands, 10)
    assert not batch.failed.any()
    for i in range(9):
        sim = Simulation("crazyflie", engine="eigen", spawn=(0, 0, 5), parameters=free)
        sim.command(commands[i])
        sim.step(300)
        assert_same(batch, i, sim)
        assert batch.warnings(i) == sim.warnings
        assert len(sim.warnings) == (np.abs(sim.state.rotor_velocity).max() * sim.dt > np.pi)
    assert len(batch.warnings(0)) == 0 and len(batch.warnings(8)) == 1


def test_what_only_a_simulation_can_say_is_said_of_a_vehicle_of_a_batch():
    """It leaves the lanes for that, and no bit changes."""
    spawn = [(0, 0, 50, 0, 0.1 * i, 0) for i in range(4)]
    batch = BatchSimulation(n=4, spawn=spawn)
    commands = np.array([[480, -480, 530, -480]] * 4, dtype=float)
    with pytest.warns(qc.QuadcoreWarning, match="tilts beyond 90"):
        sim = Simulation(engine="eigen", spawn=spawn[3])
        sim.command(commands[3])
        sim.step(2000)
    for _ in range(20):
        batch.step(commands, 100)
    assert_same(batch, 3, sim)
    assert batch.warnings(3) == sim.warnings


def test_a_reset_brings_back_the_start_with_another_seed(odd):
    batch = batch_of(odd)
    start = batch.read_state()
    batch.step(COMMANDS, 50)
    moved = batch.read_state()
    mask = ROWS % 3 == 0
    batch.reset(mask, seed=7)
    np.testing.assert_array_equal(batch.read_state(), np.where(mask[:, None], start, moved))
    np.testing.assert_array_equal(batch.time == 0, mask)


def test_after_a_reset_the_motors_are_free_until_the_next_command(odd):
    batch = batch_of(odd)
    batch.step(COMMANDS, 20)
    batch.reset()
    batch.step(None, 20)
    sim = alone(odd, 4)
    sim.step(20)
    assert_same(batch, 4, sim)


def test_a_snapshot_brings_back_what_was_to_come(odd):
    batch = batch_of(odd)
    batch.step(COMMANDS, 20)
    snapshot = batch.snapshot()
    batch.step(None, 20)
    expected = batch.read_state()
    batch.step(0.9 * COMMANDS, 30)
    batch.restore(snapshot)
    batch.step(None, 20)
    np.testing.assert_array_equal(batch.read_state(), expected)
    with pytest.raises(InputError, match="another batch"):
        batch_of(odd).restore(snapshot)


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_vehicles_take_off_and_land_as_they_do_alone(engine):
    """They leave the lanes at the ground, and come back above it."""
    heights = np.array([0.05, 0.3, 0.6, 3.0])
    spawn = np.column_stack([*np.zeros((2, 4)), heights, 0.1 * np.ones(4), *np.zeros((2, 4))])
    batch = BatchSimulation(n=4, engine=engine, world="default", spawn=spawn)
    for speed in (0, 0, 620, 620, 450, 450, 450):
        batch.step(np.resize(np.array([speed, -speed], float), (4, 4)), 150)
    assert not batch.failed.any()
    for i in range(4):
        sim = Simulation(engine=engine, world="default", spawn=spawn[i])
        for speed in (0, 0, 620, 620, 450, 450, 450):
            sim.command([speed, -speed] * 2)
            sim.step(150)
        assert_same(batch, i, sim)


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_masses_and_poses_may_be_each_vehicles_own(engine):
    masses = np.array([0.8, 1.0, 1.3])
    parameters = {"frame.mass": masses}
    batch = BatchSimulation(n=3, engine=engine, parameters=parameters, spawn=(1, 2, 30))
    batch.step(COMMANDS[:3], 30)
    sim = Simulation(engine=engine, parameters={"frame.mass": 1.3}, spawn=(1, 2, 30))
    sim.command(COMMANDS[2])
    sim.step(30)
    assert_same(batch, 2, sim)


def test_plugins_that_fly_in_no_lane_fly_each_by_itself():
    """A controller's commands are its own."""
    given = {"motorpid_plugin.ki": 1e-4, "motorpid_plugin.iMax": 1e-6, "motorpid_plugin.iMin": -1}
    batch = BatchSimulation(n=2, parameters=given)
    batch.step(COMMANDS[:2], 30)
    sim = Simulation(engine="eigen", parameters=given)
    sim.command(COMMANDS[1])
    sim.step(30)
    assert_same(batch, 1, sim)


def test_the_state_is_written_into_the_callers_array():
    batch = BatchSimulation(n=2)
    mine = np.empty((2, 21))
    assert batch.read_state(mine) is mine
    np.testing.assert_array_equal(qc.BatchState.of(mine).position, batch.state.position)
    for wrong in (np.empty((2, 20)), np.empty((2, 21), np.float32), np.empty((2, 42))[:, ::2]):
        with pytest.raises(InputError, match=r"float64 array of shape \(2, 21\)"):
            batch.read_state(wrong)


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda: BatchSimulation(n=0), "n is 0. Give a number of vehicles from 1 to 1000000"),
        (lambda: BatchSimulation(n=10**9), "n is 1000000000. Give a number of vehicles from 1"),
        (
            lambda: BatchSimulation(n=2, parameters={"drone_plugin.sim_slow": np.ones(3)}),
            "3 values",
        ),
        (lambda: BatchSimulation(n=2, spawn=np.zeros((3, 6))), "poses of 2 vehicles"),
        (lambda: BatchSimulation(n=2, seed=[1, 2, 3]), "does not contain 2 whole numbers"),
        (
            lambda: BatchSimulation(n=2).step(np.zeros((2, 3))),
            r"commands has the shape \(2, 3\). Give an array of shape \(2, 4\)",
        ),
        (lambda: BatchSimulation(n=2).step(np.zeros(4)), "commands"),
        (lambda: BatchSimulation(n=2).step([[0] * 4, [0, np.nan, 0, 0]]), "rotor 2 of vehicle 1"),
        (lambda: BatchSimulation(n=2).step(None, -1), "steps is -1"),
        (lambda: BatchSimulation(n=2).reset([True]), r"mask has the shape \(1,\)"),
        (lambda: BatchSimulation(n=2).reset([1, 0]), "mask is not an array of booleans"),
        (lambda: BatchSimulation(n=64).warnings(64), "vehicle is 64. Give a number from 0 to 63"),
        (lambda: BatchSimulation(n=64).warnings(-1), "vehicle is -1. Give a number from 0 to 63"),
        (lambda: BatchSimulation(n=2).warnings("a"), "vehicle must be a whole number"),
        (lambda: BatchSimulation(n=2, engine="eigne"), "eigne"),
    ],
)
def test_what_makes_no_batch_is_refused(call, what):
    with pytest.raises(InputError, match=what) as refusal:
        call()
    assert "\n" not in str(refusal.value)


def test_the_number_of_vehicles_is_that_of_the_core_whatever_python_does():
    class Renumbered(BatchSimulation):
        n = 1

    batch = BatchSimulation(n=200)
    with pytest.raises(AttributeError):
        batch.n = 1
    batch.__init__(n=1)
    assert batch.n == len(batch.state.position) == len(batch.time) == 200
    with pytest.raises(InputError, match=r"float64 array of shape \(200, 21\)"):
        batch.read_state(np.empty((1, 21)))
    with pytest.raises(
        InputError, match=r"out is not a writable, contiguous float64 array of shape \(3, 21\)"
    ):
        _ = Renumbered(n=3).state


def test_the_core_checks_the_size_of_every_array_by_itself():
    batch = BatchSimulation(n=3)
    core = super(BatchSimulation, batch)
    seeds = np.arange(3, dtype=np.uint64)
    for mask in (np.ones(2, bool), np.ones((3, 1), bool)):
        with pytest.raises(InputError, match=r"mask has the shape"):
            core.reset(mask, None)
    with pytest.raises(InputError, match=r"seeds has the shape \(2,\)"):
        core.reset(np.ones(3, bool), seeds[:2])
    model, world = qc.read_model("quadrotor"), qc.read_world("empty")
    arguments = [[model] * 3, world, "eigen", None, [{}] * 3, np.zeros((3, 6)), seeds, 1]
    for place, wrong in ((4, [{}]), (5, np.zeros((3, 5))), (5, np.zeros((2, 6))), (6, seeds[:2])):
        with pytest.raises(InputError, match="Give"):
            qc._core.Batch(*arguments[:place], wrong, *arguments[place + 1 :])


def test_numbers_that_lie_across_the_bounds_of_doubles_are_read_but_not_written():
    def unaligned(rows):
        memory = np.zeros(rows.nbytes + 1, np.uint8)[1:]
        view = memory.view(float).reshape(rows.shape)
        view[...] = rows
        return view

    batch, other = BatchSimulation(n=3), BatchSimulation(n=3)
    batch.step(unaligned(COMMANDS[:3]), 5)
    other.step(COMMANDS[:3], 5)
    np.testing.assert_array_equal(batch.read_state(), other.read_state())
    rows = other.read_state()
    other.set_state(rows)
    batch.set_state(unaligned(rows))
    np.testing.assert_array_equal(batch.read_state(), other.read_state())
    with pytest.raises(InputError, match="contiguous float64 array"):
        batch.read_state(unaligned(np.zeros((3, 21))))


def test_a_long_step_can_be_interrupted(alarm):
    batch = BatchSimulation(n=64)
    begin = time.process_time()
    alarm(0.3)
    with pytest.raises(KeyboardInterrupt):
        batch.step(np.resize([480.0, -480, 480, -480], (64, 4)), 10**9)
    assert time.process_time() - begin < 60  # not the hours that all the steps would take


def test_a_command_that_grows_old_does_so_in_a_batch_as_it_does_alone():
    given = {"motorpid_plugin.commandTimeout": 0.02}
    batch = BatchSimulation(n=2, parameters=given)
    batch.step(COMMANDS[:2], 10)
    for _ in range(40):
        batch.step()
    sim = Simulation(engine="eigen", parameters=given)
    sim.command(COMMANDS[1])
    sim.step(50)
    assert_same(batch, 1, sim)


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_logs_of_chosen_vehicles_are_those_of_a_run_alone(odd, engine):
    n = 5
    commands = np.array([[470.0 + 3 * i, -471, 469, -472] for i in range(n)])
    batch = BatchSimulation(odd, n, engine=engine, seed=3)
    first, second = batch.run(0.5, commands, log=[4, 1], log_every=7)
    for log, i in ((first, 4), (second, 1)):
        alone = qc.Simulation(odd, engine=engine, seed=3 + i)
        alone.command(commands[i])
        assert log.table.tobytes() == alone.run(0.5, log_every=7).table.tobytes()
    assert batch.time.tolist() == pytest.approx([0.5] * n)


def test_the_log_of_a_vehicle_that_fails_ends_before_it():
    batch = BatchSimulation("quadrotor", 2, xacro_args={"sim_slow": 1, "max_velocity": 1e12})
    commands = np.array([[470.0, -470, 470, -470], [1e11, -1e11, 1e11, -1e11]])
    flies, fails = batch.run(1.0, commands, log=[0, 1], log_every=10)
    assert batch.failed.tolist() == [False, True] and len(flies) == 101 > len(fails) >= 1
    assert np.isfinite(fails.table).all()


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"log": [2]}, "log names vehicle 2. Use 0 to 1."),
        ({"log": [0], "log_every": 0}, "log_every is 0. Give a whole number >= 1"),
        ({"log": [0], "log_every": 20}, "log_every is 20 but the flight has 10 steps"),
        ({"log": [True, False]}, "log is True. Give a whole number"),
        ({"log": 1}, "log is 1. Give a list of vehicle numbers"),
        ({"log_every": "a"}, "log_every is 'a'. Give a whole number"),
        ({"commands": [1, 2]}, "commands"),
    ],
)
def test_what_cannot_be_logged_of_a_batch_is_refused(given, what):
    batch = BatchSimulation("quadrotor", 2)
    with pytest.raises(qc.InputError, match=what):
        batch.run(0.01, **given)
    assert not batch.time.any()


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_on_the_ground_a_run_remembers_what_came_before(engine):
    world = {"world": "default", "spawn": (0, 0, 0.3, 0.3, 0.2, 0), "engine": engine}
    batch, alone = BatchSimulation("quadrotor", 1, **world), qc.Simulation("quadrotor", **world)
    command = 0.6 * alone.hover_speed
    batch.step([command], 400)
    alone.command(command)
    alone.step(400)
    (log,) = batch.run(0.3, log=[0])
    assert log.table[:, 1:].tobytes() == alone.run(0.3).table[:, 1:].tobytes()


def test_a_command_that_a_failed_vehicle_is_given_holds_when_it_flies_again():
    options = {
        "parameters": {
            "motorpid_plugin.ki": 1e-4,
            "motorpid_plugin.iMax": 1e-6,
            "motorpid_plugin.iMin": -1e-6,
        },
        "xacro_args": {"sim_slow": 1, "max_velocity": 1e12},
    }
    batch = BatchSimulation("quadrotor", 1, **options)
    alone = qc.Simulation("quadrotor", engine="eigen", **options)
    start, hover = batch.read_state(), alone.hover_speed
    batch.step([hover * 1e9], 2000)
    assert batch.failed.all()
    batch.step([hover])
    batch.set_state(start)
    batch.step(None, 100)
    alone.command(hover)
    alone.step(100)
    assert batch.state.rotor_velocity[0] == pytest.approx(alone.state.rotor_velocity, rel=0.2)


@pytest.mark.parametrize("model", ["quadrotor", "firefly"])
def test_rows_of_logs_are_as_wide_as_those_of_single_flights(model):
    batch = BatchSimulation(model, 1)
    log = Simulation(model, engine="eigen").run(0.01)
    assert batch.log_width == log.table.shape[1] == len(_core.log_columns(batch.command_width))
    assert batch.state_width == batch.log_width - 1 + batch.command_width
