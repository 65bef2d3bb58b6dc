"""`BatchSimulation.run` with controllers."""

import numpy as np
import pytest

import quadcore as qc

NOISE = {"odometry.positionNoise": 0.002}
SLOW = {"sim_slow": 1}
N = 10


def assert_alike(log, alone):
    for name in ("time", "position", "orientation", "rotor_velocity"):
        np.testing.assert_array_equal(getattr(log, name), getattr(alone, name), name)
    np.testing.assert_array_equal(log.topics["error"]["x"], alone.topics["error"]["x"])
    assert log.per_command == alone.per_command


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_one_controller_of_all_vehicles(engine):
    thrust = np.linspace(8.4e-6, 8.6e-6, N)
    batch = qc.BatchSimulation(
        "quadrotor",
        N,
        engine,
        {**NOISE, "drone_plugin.rotorThrustCoeff": thrust},
        seed=3,
        xacro_args=SLOW,
    )
    logs = batch.run(
        1.0, log=[0, 4, N - 1], log_every=5, controller="geometric", reference="spiral"
    )
    for vehicle, log in zip((0, 4, N - 1), logs):
        sim = qc.Simulation(
            "quadrotor",
            engine,
            parameters={**NOISE, "drone_plugin.rotorThrustCoeff": thrust[vehicle]},
            seed=3 + vehicle,
            xacro_args=SLOW,
        )
        assert_alike(log, sim.run(1.0, log_every=5, controller="geometric", reference="spiral"))


def test_a_controller_and_a_reference_for_each_vehicle():
    controllers = ["lqr", qc.controllers.geometric(rate=250), "pid"]
    references = ["spiral", qc.references.circle(), "eight"]
    batch = qc.BatchSimulation("quadrotor", 3, xacro_args=SLOW)
    logs = batch.run(0.8, log=[0, 1, 2], controller=controllers, reference=references)
    for seed, log in enumerate(logs):
        sim = qc.Simulation("quadrotor", "eigen", seed=seed, xacro_args=SLOW)
        alone = sim.run(0.8, controller=controllers[seed], reference=references[seed])
        assert_alike(log, alone)
    batch.reset()
    again = batch.run(0.8, log=[1], controller=controllers, reference=references)
    np.testing.assert_array_equal(again[0].position, logs[1].position)


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_the_last_commands_remain_in_effect(engine):
    """Also those of vehicles on the ground, which the batch simulates alone."""
    heights = np.linspace(0, 4, 5)
    batch = qc.BatchSimulation(
        "quadrotor", 5, engine, NOISE, [(0, 0, z) for z in heights], xacro_args=SLOW
    )
    batch.run(1.0, controller="geometric", reference="hover")
    batch.step(steps=50)
    for seed, (z, position) in enumerate(zip(heights, batch.state.position)):
        sim = qc.Simulation(
            "quadrotor", engine, parameters=NOISE, spawn=(0, 0, z), seed=seed, xacro_args=SLOW
        )
        sim.run(1.0, controller="geometric", reference="hover")
        sim.step(50)
        np.testing.assert_array_equal(position, sim.state.position)


class Hover:
    vectorized = True

    def __call__(self, t, state, reference):
        return np.tile([470.0, -470.0, 470.0, -470.0], (len(state.position), 1))


def test_a_vectorized_controller():
    batch = qc.BatchSimulation("quadrotor", 3, xacro_args=SLOW)
    (log,) = batch.run(0.5, log=[2], controller=Hover(), reference="hover")
    sim = qc.Simulation("quadrotor", "eigen", seed=2, xacro_args=SLOW)
    assert_alike(log, sim.run(0.5, controller=Hover(), reference="hover"))


@pytest.mark.parametrize("controller", ["geometric", Hover()])
def test_a_vehicle_that_is_listed_twice_has_two_equal_logs(controller):
    batch = qc.BatchSimulation("quadrotor", 2, xacro_args=SLOW)
    logs = batch.run(0.1, log=[1, 0, 1], controller=controller, reference="hover")
    for log, seed in zip(logs, (1, 0, 1)):
        sim = qc.Simulation("quadrotor", "eigen", seed=seed, xacro_args=SLOW)
        assert_alike(log, sim.run(0.1, controller=controller, reference="hover"))


def follow_in_the_core(batch, controllers, logged):
    """Call the core without the checks of `BatchSimulation.run`."""
    n = len(controllers)
    shape = qc.references.hover().shape
    rates, delays = np.full(n, 500.0), np.zeros(n)
    return batch._follow(controllers, [shape] * n, rates, delays, "odom", 10, 1, logged)


def controller_of(model):
    controller = qc.controllers.geometric()
    controller.reset(qc.Simulation(model, "eigen"))
    return controller.core


def test_the_core_writes_one_log_of_each_vehicle():
    batch = qc.BatchSimulation("quadrotor", 2)
    with pytest.raises(qc.InputError, match="logged lists vehicle 1 twice"):
        follow_in_the_core(batch, [controller_of("quadrotor")] * 2, [0, 1, 1])
    assert batch.time.tolist() == [0, 0]


def test_the_core_refuses_a_controller_of_another_number_of_rotors():
    batch = qc.BatchSimulation("firefly", 2)
    with pytest.raises(qc.InputError, match=r"controller of vehicle 1 drives 4 rotors.* takes 6"):
        follow_in_the_core(batch, [controller_of(name) for name in ("firefly", "quadrotor")], [0])
    assert batch.time.tolist() == [0, 0]


@pytest.mark.parametrize(
    "options, message",
    [
        (
            {"controller": ["pid"], "reference": "spiral"},
            "controller lists 1 values for 3 vehicles",
        ),
        ({"reference": "spiral"}, "a reference needs a controller"),
        ({"controller": lambda t, state, reference: None}, "takes built-in controllers"),
        ({"controller": "pid"}, "takes built-in controllers"),
        (
            {"controller": "pid", "commands": np.zeros((3, 4))},
            "takes commands or a controller",
        ),
    ],
)
def test_wrong_arguments_move_nothing(options, message):
    batch = qc.BatchSimulation("quadrotor", 3)
    with pytest.raises(qc.InputError, match=message):
        batch.run(0.1, **options)
    assert batch.time.tolist() == [0, 0, 0]


class Late(Hover):
    """Hovers for 0.05 s, then returns other commands."""

    def __init__(self, change):
        self.change = change

    def __call__(self, t, state, reference):
        commands = super().__call__(t, state, reference)
        return commands if t < 0.0495 else self.change(commands)


def spoil(commands):
    commands[-1, 1] = np.nan
    return commands


@pytest.mark.parametrize("change", [spoil, lambda commands: commands[:, :3]], ids=["nan", "shape"])
def test_errors_of_a_vectorized_controller_contain_what_those_of_single_flights_contain(change):
    found = []
    for make in (qc.BatchSimulation, qc.Simulation):
        simulation = make("quadrotor", engine="eigen", xacro_args=SLOW)
        with pytest.raises(qc.QuadcoreError) as failure:
            simulation.run(0.1, controller=Late(change), reference="hover")
        found.append(failure.value)
    batch, alone = found
    assert type(batch) is type(alone)
    assert batch.time == pytest.approx(alone.time) == pytest.approx(0.05)
    assert str(batch).replace(" for vehicle 0", "") == str(alone)


def test_a_command_that_is_not_finite_names_its_vehicle():
    batch = qc.BatchSimulation("quadrotor", 3)
    with pytest.raises(qc.FlightError, match=r"for vehicle 2: the command for rotor 2 is not a f"):
        batch.run(0.1, controller=Late(spoil))


@pytest.mark.parametrize(
    "control",
    [{}, {"controller": "pid", "reference": "hover"}, {"controller": Hover()}],
    ids=["commands", "built in", "vectorized"],
)
def test_a_log_of_no_steps_contains_the_present_row(control):
    batch = qc.BatchSimulation("quadrotor", 2, xacro_args=SLOW)
    _, log = batch.run(0, log=[0, 1], **control)
    alone = qc.Simulation("quadrotor", engine="eigen", seed=1, xacro_args=SLOW)
    expected = alone.run(0, **control)
    np.testing.assert_array_equal(log.table, expected.table[:, : log.table.shape[1]])
    assert batch.time.tolist() == [0, 0]


@pytest.mark.parametrize("reference", [None, "hover"])
def test_a_vectorized_controller_with_columns_for_the_log_is_refused(reference):
    controller = Hover()
    controller.log = {"thrust": 1.0}
    batch = qc.BatchSimulation("quadrotor", 3)
    with pytest.raises(qc.InputError, match=r"^controller: its log has the values of one vehicle"):
        batch.run(0.1, log=[0], controller=controller, reference=reference)
    assert batch.time.tolist() == [0, 0, 0]


def test_vehicles_under_way_take_no_controller():
    batch = qc.BatchSimulation("quadrotor", 2)
    batch.step()
    with pytest.raises(qc.InputError, match="is not at its start"):
        batch.run(0.1, controller="pid", reference="spiral")


@pytest.mark.parametrize(
    "engine, n, controllers",
    [("eigen", 1, "geometric"), ("eigen", 20, "px4"), ("gazebo11", 9, "pid"), ("ode", 3, "lqr")],
)
def test_a_long_run_can_be_interrupted_and_continued(alarm, engine, n, controllers):
    """The vehicles stop where they are, at the times that the batch states."""
    batch = qc.BatchSimulation("quadrotor", n, engine, NOISE, threads=2, xacro_args=SLOW)
    alarm(0.2)
    with pytest.raises(KeyboardInterrupt):
        batch.run(1e6, controller=controllers, reference="spiral")
    times = batch.time
    assert 0 < times.max() < 1e5
    last = int(times.argmax())
    before = batch.state.position[last]
    batch.step(steps=20)
    np.testing.assert_array_equal(batch.time[last], times[last] + 20 * batch.dt)
    sim = qc.Simulation("quadrotor", engine, parameters=NOISE, seed=last, xacro_args=SLOW)
    sim.run(times[last], log_every=10**6, controller=controllers, reference="spiral")
    np.testing.assert_array_equal(before, sim.state.position)
    sim.step(20)
    np.testing.assert_array_equal(batch.state.position[last], sim.state.position)


def test_a_run_is_interrupted_while_the_calling_thread_waits_for_the_others(alarm):
    """The vehicles of that thread, the first eight, fail at once."""
    references = ["hover:height=1e9"] * 8 + ["spiral"] * 16
    free = {"sim_slow": 1, "max_velocity": 1e12}
    batch = qc.BatchSimulation("quadrotor", 24, threads=2, xacro_args=free)
    alarm(0.5)
    with pytest.raises(KeyboardInterrupt):
        batch.run(1e6, controller="pd", reference=references)
    assert batch.failed.tolist() == [True] * 8 + [False] * 16
    assert 0 < batch.time.max() < 1e5
