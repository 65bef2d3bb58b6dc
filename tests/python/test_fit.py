"""Parameters found from flights whose parameters are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from flights import NOISE
from processes import run_command, run_refused

import quadcore as qc
from quadcore.model.overrides import list_link_values
from quadcore.studies.fit.horizons import _make_commands as commands_from_speeds
from quadcore.studies.fit.model_text import write_values
from quadcore.studies.fit.record import read_record

DATA = Path(__file__).resolve().parents[1] / "data" / "gazebo11"

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

TRUE = {
    "drone_plugin.rotorThrustCoeff": 1.1487e-5,
    "drone_plugin.rotorTorqueCoeff": 2.69e-7,
    "motorpid_plugin.kp": 5e-4,
    "frame.ixx": 0.0068229166666667,
    "frame.iyy": 0.0068229166666667,
    "frame.izz": 0.0135416666666667,
    "drone_plugin.parasiticDragCoeff": 0.003,
}
LINEAR = {
    "drone_plugin.inducedDragCoeff": 0.01,
    "drone_plugin.translationalDragCoeff": 0.0025,
    "drone_plugin.profileDragCoeff": 0.005,
}
SUM = " + ".join(LINEAR)
WRONG = [1.0e-5, 3.2e-7, 4e-4, 0.008, 0.0058, 0.016, 0.004, 0.004, 0.004, 0.004]
BEGIN = dict(zip([*TRUE, *LINEAR], WRONG))


class Excited:
    """A controller that adds four sines to its commands, different for each rotor."""

    rate = 100.0
    spins = ()

    def __init__(self):
        self.inner = qc.controllers.geometric(rate=self.rate)

    def reset(self, simulation):
        self.inner.reset(simulation)
        self.rows = []

    def __call__(self, t, state, reference):
        sines = [
            [np.sin(2 * np.pi * f * t + k * phase) for k, f in enumerate((0.7, 1.3, 2.1, 3.7))]
            for phase in (0.3, 1.1, 2.2, 4.0)
        ]
        speeds = np.array(self.inner(t, state, reference))
        speeds += 12 * np.array([1, -1, 1, -1]) * np.sum(sines, axis=1)
        self.rows.append([t, *speeds])
        return speeds


def wide(t):
    """Up, down and across, so that every drag is felt."""
    reference = qc.Reference()
    rates, sizes = np.array([1.1, 0.8, 1.3]), np.array([3, 2, 2])
    reference.position = sizes * np.sin(rates * t) + [0, 0, 10]
    reference.velocity = sizes * rates * np.cos(rates * t)
    reference.acceleration = -sizes * rates**2 * np.sin(rates * t)
    reference.yaw, reference.yaw_rate = 0.8 * np.sin(0.5 * t), 0.4 * np.cos(0.5 * t)
    return reference


@pytest.fixture(scope="module")
def flown():
    """A flight under the thesis' noise, logged at 100 Hz, and its commands."""
    simulation = qc.Simulation(engine="eigen", xacro_args={"sim_slow": 1}, parameters=NOISE, seed=5)
    controller = Excited()
    log = simulation.run(
        10, controller=controller, reference=wide, log_every=10, topics=("odom", "vel_cmd")
    )
    return log, np.array(controller.rows)


@pytest.fixture(scope="module")
def found(flown):
    log, commands = flown
    return fit(log, commands=commands)


def fit(log, free=tuple(BEGIN), **options):
    given = {"xacro_args": {"sim_slow": 1}, "sensed": "odom", "parameters": BEGIN, **options}
    begin = {name: value for name, value in given["parameters"].items() if name in free}
    return qc.fit("quadrotor", log, free, **{**given, "parameters": begin})


def test_a_noisy_flight_gives_back_the_parameters_it_was_flown_with(found):
    for name, value in TRUE.items():
        assert found.values[name] == pytest.approx(value, rel=0.01), name
    (together,) = found.combinations
    assert str(together) == SUM
    assert together.value == pytest.approx(sum(LINEAR.values()), rel=0.01)
    assert together.deviation < 1e-4
    # One controller: one of three numbers.
    assert sum(value < 1e-3 for value in found.identified.singular_values) == 2
    assert all(np.isnan(found.identified.deviations[name]) for name in LINEAR)
    # What is left over is the noise of the odometry.
    for left in (found.train, found.held_out):
        assert left["position"][1] == pytest.approx(NOISE["odometry.positionNoise"], rel=0.1)
        assert left["position"][0] > 10 * left["position"][1]


def test_the_fitted_model_flies_as_the_one_that_was_measured(flown, found):
    log, commands = flown
    fitted = qc.Simulation(found.model, engine="eigen")
    fitted.set_state(_state(fitted, log))
    again = fitted.run(3, commands=commands, log_every=10)
    assert np.linalg.norm(again.position - log.position[:301], axis=1).max() < 0.01


def _state(simulation, log):
    state = simulation.state.copy()
    state.position, state.orientation = log.position[0], log.orientation[0]
    state.linear_velocity, state.angular_velocity = log.linear_velocity[0], log.angular_velocity[0]
    state.rotor_velocity = log.rotor_velocity[0]
    return state


def test_commands_are_read_from_the_log_that_has_them(flown):
    log, commands = flown
    assert np.array_equal(read_record(log, 4).commands, commands)


def test_measured_speeds_of_rotors_serve_in_place_of_commands(flown):
    log, _ = flown
    names = ("drone_plugin.rotorThrustCoeff", "frame.ixx")
    begin = {name: BEGIN[name] for name in names}
    bare = qc.Log(log.table, {}, topics={"odom": log.topics["odom"]})
    found = fit(bare, names, parameters=begin, horizon=0.5)
    for name in names:
        assert found.values[name] == pytest.approx(TRUE[name], rel=0.05), name


@pytest.mark.parametrize("model", ["firefly", "hexarotor"])
def test_commands_are_found_from_measured_speeds(model):
    """RotorS' joints turn ten times slower than commanded, every other one backwards."""
    simulation = qc.Simulation(model, engine="eigen", spawn=(0, 0, 10))
    time, hover = np.arange(0, 1, simulation.dt), simulation.hover_speed
    wanted = hover * (1 + 0.02 * np.sin(6 * time[:, None] + np.arange(6)))
    log = simulation.run(1, commands=np.column_stack([time, wanted]))
    record = read_record(log, simulation.rotor_count)
    found, steps = commands_from_speeds(record, simulation.dt, simulation.rotors)
    late = steps > 0.5 / simulation.dt
    np.testing.assert_allclose(found[late], wanted[steps[late]], rtol=0.003)


def test_a_lag_between_commands_and_measurements_is_found(flown):
    log, commands = flown
    late = commands.copy()
    short = qc.Log(log.table[:301], {}, topics={"odom": _first(log.topics["odom"], 301)})
    late[:, 0] += 0.006  # they were stamped too late: what is measured leads
    names = ("drone_plugin.rotorThrustCoeff", "motorpid_plugin.kp")
    begin = {name: BEGIN[name] for name in names}
    found = fit(short, names, commands=late, parameters=begin, shift=0.01, horizon=0.5)
    assert found.shift == pytest.approx(-0.006)
    for name in names:
        assert found.values[name] == pytest.approx(TRUE[name], rel=0.01), name


def _first(fields, rows):
    return {name: column[:rows] for name, column in fields.items()}


@pytest.mark.parametrize("record", ["S3_slow1_all", "S5_slow10_induced"])
def test_recordings_of_gazebo_give_back_what_gazebo_flew_with(record):
    shape, slow, drag = record.split("_")
    file = DATA / f"{record}.csv.gz"
    if not file.exists():
        pytest.skip(f"{file.name} is not among the recordings here")
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    log = qc.Log(rows[rows[:, 0] <= 5], {})
    names = ("drone_plugin.rotorThrustCoeff", "motorpid_plugin.kp", *LINEAR)
    begin = {name: BEGIN[name] for name in names}
    if drag == "induced":
        begin["drone_plugin.parasiticDragCoeff"] = 0
    found = qc.fit(
        "quadrotor",
        log,
        names,
        commands=DATA / f"commands_{shape}.csv",
        engine="gazebo11",
        xacro_args={"sim_slow": slow[4:]},
        parameters=begin,
    )
    for name in names[:2]:
        assert found.values[name] == pytest.approx(TRUE[name], rel=1e-3), name
    (together,) = found.combinations
    assert set(together.factors) == set(LINEAR)
    expected = 0.01 if drag == "induced" else sum(LINEAR.values())
    assert together.value == pytest.approx(expected, rel=1e-3)


def test_values_are_written_where_they_stand_and_added_where_they_do_not():
    model = qc.read_model("quadrotor")
    values = {
        "frame.izz": 0.015,
        "drone_plugin.parasiticDragCoeff": 0.125,
        "drone_plugin.rotorRadius": 0.07,
    }
    changed = write_values(model, values)
    assert list_link_values(changed.document)["frame.izz"] == "0.015"
    plugin = qc.Simulation(changed).plugins[0]
    tags = {tag.name: tag.value for tag in plugin.parameters}
    assert (tags["parasiticDragCoeff"], tags["rotorRadius"]) == ("0.125", "0.07")
    kept = qc.Simulation(model).plugins[0]
    assert (
        tags["rotorThrustCoeff"]
        == {tag.name: tag.value for tag in kept.parameters}["rotorThrustCoeff"]
    )


def test_an_interrupted_fit_has_the_best_so_far(flown):
    log, commands = flown

    def interrupt(done, _):
        if done == 2:
            raise KeyboardInterrupt

    name = "drone_plugin.rotorThrustCoeff"
    with pytest.raises(KeyboardInterrupt) as stop:
        fit(log, (name,), commands=commands, progress=interrupt)
    simulation = qc.Simulation(stop.value.model)
    tags = {tag.name: tag.value for tag in simulation.plugins[0].parameters}
    assert float(tags["rotorThrustCoeff"]) == pytest.approx(TRUE[name], rel=0.01)


def test_the_command_writes_the_model_and_tells_what_is_known(flown, in_empty_folder):
    log, commands = flown
    log.to_csv("log.csv")
    np.savetxt("c.csv", commands, fmt="%.17g", delimiter=",", header="t,w1,w2,w3,w4", comments="")
    words = [
        "fit",
        "quadrotor",
        "--xacro",
        "sim_slow:=1",
        "--log",
        "log.csv",
        "--commands",
        "c.csv",
    ]
    free = ["--free", ",".join(["drone_plugin.rotorThrustCoeff", *LINEAR, "frame.mass"])]
    done = run_command(
        *words, *free, "--sensed=odom", "--set", "frame.mass=0.9", "-o", "fitted.urdf"
    )
    assert done.returncode == 0, done.stderr
    assert f"only the sum is identifiable: {SUM} = " in done.stdout
    assert "singular values" in done.stdout and "held out" in done.stdout
    assert qc.Simulation("fitted.urdf").mass == pytest.approx(1.04, rel=0.01)
    for bad, expected in (
        (
            ["--free", "drone_plugin.k"],
            "free drone_plugin.k: model quadrotor has no such parameter",
        ),
        (
            ["--free", "drone_plugin.dragModel"],
            "'appendix' is not a number. Only numbers can be fitted.",
        ),
        (
            [*free, "--bound", "frame.mass=2:3"],
            "bound frame.mass: the start value 1 is not within 2 and 3",
        ),
        ([*free, "--bound", "frame.mass=2"], "'2' is not a range. Write LOW:HIGH"),
        ([*free, "--bound", "frame.ixx=0:3"], "bound frame.ixx: the parameter is not free"),
        ([*free, "--horizon", "99"], "the log is shorter than a horizon"),
        (
            [*free, "--sensed", "gps"],
            "topic 'gps' with pose and velocities does not exist (topics: odom",
        ),
    ):
        assert expected in run_refused(*words, *bad, "-o", "bad.urdf")
    assert not Path("bad.urdf").exists()


def test_states_of_a_batch_may_be_set():
    batch = qc.BatchSimulation(n=9, parameters={"frame.mass": np.repeat([1, 1.2, 1.4], 3)})
    simulations = [
        qc.Simulation(engine="eigen", parameters={"frame.mass": mass})
        for mass in np.repeat([1, 1.2, 1.4], 3)
    ]
    commands = np.tile([480.0, -470, 490, -480], (9, 1))
    batch.step(commands, 30)
    rows = batch.read_state()[::-1].copy()
    batch.set_state(rows)
    batch.step(0.9 * commands, 20)
    for i, simulation in enumerate(simulations):
        state = simulation.state.copy()
        parts = np.split(rows[i], [3, 7, 10, 13, 17])
        for name, part in zip(
            (
                "position",
                "orientation",
                "linear_velocity",
                "angular_velocity",
                "rotor_velocity",
                "rotor_angle",
            ),
            parts,
        ):
            setattr(state, name, part)
        simulation.set_state(state)
        simulation.command(0.9 * commands[i])
        simulation.step(20)
        assert batch.state.position[i].tolist() == simulation.state.position.tolist()
        assert batch.time[i] == simulation.time
    before = batch.read_state()
    rows[4, 3:7] = 0
    with pytest.raises(
        qc.InputError, match="vehicle 4: state: the orientation is not a unit quaternion"
    ):
        batch.set_state(rows)
    with pytest.raises(qc.InputError, match="states is not a 2-dimensional array of numbers"):
        batch.set_state([1, 2, 3])
    with pytest.raises(qc.InputError, match=r"states has the shape \(1, 3\). .* shape \(9, 21\)"):
        batch.set_state([[1, 2, 3]])
    assert np.array_equal(batch.read_state(), before)
