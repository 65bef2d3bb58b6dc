"""Fits to recordings of real flights, and predictions of them."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from processes import run_command, run_refused
from test_player import content_of

import quadcore as qc
from quadcore.formats.recordings import Recording, read_recording
from quadcore.formats.recordings.series import Series
from quadcore.studies.fit.alignment import find_lags, find_mount, turn_pose
from quadcore.studies.fit.cleaning import clean_recording
from quadcore.studies.fit.coordinates import Coordinates, check_bodies
from quadcore.studies.fit.fitted_model import FittedModel
from quadcore.studies.fit.prepared import prepare_flight
from quadcore.studies.fit.recorded import fit_recordings
from quadcore.studies.fit.smoothing import estimate_noise, fit_locally

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

REAL = Path(__file__).resolve().parents[1] / "data" / "recordings"
REP4 = REAL / "nanobench/rep4_excerpt.csv.gz"
REP11 = REAL / "nanobench/rep11_excerpt.csv.gz"
CRAZYPAD = REAL / "crazypad"


class Excited:
    """A geometric controller with sines on top of its commands."""

    rate = 100.0
    spins = ()

    def __init__(self, seed):
        random = np.random.default_rng(seed)
        self.inner = qc.controllers.geometric(rate=self.rate)
        self.phases = random.uniform(0, 2 * np.pi, (4, 4))
        self.rates = random.uniform(1, 6, (4, 4))

    def reset(self, simulation):
        self.inner.reset(simulation)

    def __call__(self, t, state, reference):
        sines = np.sin(2 * np.pi * self.rates * t + self.phases).sum(axis=1)
        return self.inner(t, state, reference) * (1 + 0.01 * sines)


def fly(reference, parameters, duration=8.0, seed=0):
    simulation = qc.Simulation(
        "crazyflie", engine="eigen", parameters=parameters, spawn=(0, 0, 2), seed=seed
    )
    return simulation.run(duration, controller=Excited(seed), reference=reference, log_every=10)


@pytest.fixture(scope="module")
def motion():
    """Position, orientation, rates and specific force of a flight at 1 kHz, and their times."""
    simulation = qc.Simulation("crazyflie", engine="eigen", spawn=(0, 0, 2))
    return simulation.run(12, controller=Excited(3), reference="eight")


@pytest.mark.parametrize("lag", [-0.02, 0.0, 0.0137, 0.1])
def test_lags_of_topics_are_found_within_two_milliseconds(motion, lag):
    random = np.random.default_rng(1)
    rows = slice(0, None, 10)
    time = motion.time[rows]
    rates = motion.angular_velocity[rows] + random.normal(0, 0.05, (len(time), 3))
    recording = Recording(
        "flight",
        {
            "position": Series(
                time, motion.position[rows] + random.normal(0, 5e-4, (len(time), 3))
            ),
            "orientation": Series(time, motion.orientation[rows]),
            "velocity": Series(time + 0.03, motion.linear_velocity[rows]),
            "rates": Series(time + lag, rates),
        },
        None,
    )
    lags = find_lags(recording)
    assert lags["rates"] == pytest.approx(lag, abs=2e-3)
    assert lags["velocity"] == pytest.approx(0.03, abs=2e-3)


@pytest.mark.parametrize("vector", [[0.05, -0.03, 0.02], [0, np.radians(2), 0], [0, 0, 0]])
def test_axes_of_the_pose_are_turned_to_those_of_the_imu_if_they_differ(motion, vector):
    from scipy.spatial.transform import Rotation

    random = np.random.default_rng(4)
    time, rows = motion.time[::10], slice(0, None, 10)
    mount = Rotation.from_rotvec(vector)
    turned = Rotation.from_quat(motion.orientation[rows]) * mount.inv()
    acceleration = np.gradient(motion.linear_velocity, motion.time, axis=0)[rows] + [0, 0, 9.81]
    force = Rotation.from_quat(motion.orientation[rows]).inv().apply(acceleration)
    recording = Recording(
        "flight",
        {
            "position": Series(time, motion.position[rows]),
            "orientation": Series(time, turned.as_quat()),
            "rates": Series(
                time, motion.angular_velocity[rows] + random.normal(0, 0.05, force.shape)
            ),
            "acceleration": Series(time, force + random.normal(0, 0.1, force.shape)),
        },
        None,
    )
    found = find_mount(recording)
    if not any(vector):
        assert found is None
        return
    assert Rotation.from_quat(found).as_rotvec() == pytest.approx(vector, abs=3e-3)
    again = turn_pose(recording, found).quantities["orientation"].values
    apart = Rotation.from_quat(again).inv() * Rotation.from_quat(motion.orientation[rows])
    assert apart.magnitude().max() < 5e-3


def test_repeated_samples_and_glitches_are_left_out():
    time = np.arange(0, 4, 0.01)
    position = np.column_stack([np.sin(time), np.cos(time), 0.1 * time])
    position[100] = position[99]
    position[200:202] += [0.3, 0, 0]
    recording = Recording("flight", {"position": Series(time, position)}, None)
    cleaned, removals = clean_recording(recording)
    assert {(r.reason, r.samples) for r in removals} == {("repeated sample", 1), ("glitch", 2)}
    left = cleaned.quantities["position"].time
    assert not np.isin(time[[100, 200, 201]], left).any()
    assert len(left) == len(time) - 3


def test_commands_out_of_range_are_all_left_out():
    recording = read_recording(REAL / "nanobench/rep2_excerpt_bad_pwm.csv.gz")
    commands = recording.quantities["commands"].values
    wrong = int(((commands < 0) | (commands > 1)).any(axis=1).sum())
    cleaned, removals = clean_recording(recording)
    assert wrong > 10
    assert [r.samples for r in removals if r.reason == "out of range"] == [wrong]
    left = cleaned.quantities["commands"].values
    assert len(left) == len(commands) - wrong
    assert ((left >= 0) & (left <= 1)).all()


def test_rotor_speeds_that_do_not_exist_are_left_out():
    time = np.arange(0, 4, 0.01)
    speeds = 1800 + 300 * np.sin(time[:, None] + np.arange(4))
    speeds[:100] = 250  # idle on the ground
    speeds[200, 2], speeds[300, 0] = 65535, -40000
    cleaned, removals = clean_recording(
        Recording("flight", {"rotors": Series(time, speeds)}, None, {"rotors": 3})
    )
    assert [tuple(r) for r in removals] == [
        ("rotors", "incomplete", 3),
        ("rotors", "out of range", 2),
    ]
    assert np.isin(time, cleaned.quantities["rotors"].time).sum() == len(time) - 2


def test_saturated_samples_of_an_imu_are_left_out():
    time = np.arange(0, 4, 0.01)
    rates = np.radians(2400) * np.sin(2 * time[:, None] + np.arange(3))
    clipped = np.clip(rates, -np.radians(1998), np.radians(1998))
    saturated = (np.abs(rates) > np.radians(1998)).any(axis=1)
    quiet = np.round(np.random.default_rng(0).normal(0, 0.6, (400, 3)))  # few steps of the ADC
    given = {"rates": Series(time, clipped), "acceleration": Series(time, 0.05 * quiet)}
    cleaned, removals = clean_recording(Recording("flight", given, None))
    left_out = {r.topic: r.samples for r in removals if r.reason == "saturated"}
    assert left_out == {"rates": saturated.sum()}
    assert not np.isin(time[saturated], cleaned.quantities["rates"].time).any()


def test_local_polynomials_are_exact_for_cubics_and_noise_is_estimated():
    time = np.sort(np.random.default_rng(0).uniform(0, 2, 200))
    values = np.column_stack([time**3 - time, 2 * time**2])
    found, slope = fit_locally(time, values, np.array([0.5, 1.1]), 0.05)
    assert found == pytest.approx(np.array([[-0.375, 0.5], [0.231, 2.42]]), abs=1e-9)
    assert slope == pytest.approx(np.array([[-0.25, 2.0], [2.63, 4.4]]), abs=1e-8)
    noise = np.random.default_rng(0).normal(0, 0.3, (5000, 1))
    assert estimate_noise(noise)[0] == pytest.approx(0.3, rel=0.1)


def test_a_copy_of_a_fitted_flight_is_refused(tmp_path):
    copy = tmp_path / "other.csv.gz"
    shutil.copy(REP4, copy)
    said = run_refused(
        "fit", "crazyflie", "--log", REP4, "--judge", copy, "-o", tmp_path / "a.urdf"
    )
    assert "100 % of the rows are those of" in said and "Judge on another flight." in said


def test_a_missing_log_is_refused_whatever_follows(tmp_path):
    said = run_refused(
        "fit", "crazyflie", "--log", tmp_path / "missing.csv", "--log", REP4, "-o",
        tmp_path / "a.urdf",
    )  # fmt: skip
    assert "missing.csv" in said


@pytest.mark.parametrize("seed", range(5))
def test_every_point_of_the_search_is_a_body_that_can_exist(seed):
    names = ["a.mass", "frame.ixx", "frame.iyy", "frame.izz"]
    start = np.array([2.0, 1.6e-5, 1.7e-5, 2.9e-5])
    products = {"frame.ixy": 8e-7, "frame.ixz": 7e-7, "frame.iyz": 1.8e-6}
    coordinates = Coordinates(names, start, np.ones(4), np.array([[0, np.inf]] * 4), products)
    assert coordinates.decode(coordinates.encode(start)) == pytest.approx(start)
    x = coordinates.encode(start) + np.random.default_rng(seed).normal(0, 3, 4)
    x = np.maximum(x, coordinates.low)
    named = {**products, **coordinates.name(x)}
    inertia = np.diag([named[f"frame.{moment}"] for moment in ("ixx", "iyy", "izz")])
    for (i, j), name in zip(((0, 1), (0, 2), (1, 2)), ("ixy", "ixz", "iyz")):
        inertia[i, j] = inertia[j, i] = named[f"frame.{name}"]
    moments = np.linalg.eigvalsh(inertia)
    assert moments[0] > 0 and moments[0] + moments[1] > moments[2]
    slope = coordinates.decode_derivative(x)
    for k in range(4):
        step = 1e-6 * np.eye(4)[k]
        change = (coordinates.decode(x + step) - coordinates.decode(x - step)) / 2e-6
        assert slope[:, k] == pytest.approx(change, rel=1e-5, abs=1e-12)


def test_a_start_that_no_body_has_is_refused():
    with pytest.raises(qc.InputError, match="no body has its moments of inertia"):
        Coordinates(
            ["b.ixx", "b.iyy", "b.izz"],
            np.array([1.0, 1, 3]),
            np.ones(3),
            np.array([[0, np.inf]] * 3),
            {},
        )


@pytest.mark.parametrize(("value", "exists"), [(1.6e-5, True), (6e-5, False)])
def test_a_single_free_moment_that_no_body_has_is_an_error(value, exists):
    free = ["frame.ixx", "drone_plugin.hubMomentCoeff"]
    fitted = FittedModel(free, "crazyflie", "eigen", None, None, None, None, ())
    model = fitted.make_model({"frame.ixx": value, "drone_plugin.hubMomentCoeff": 0.0})
    if exists:
        check_bodies(model, free)
    else:
        with pytest.raises(qc.FlightError, match="link frame: no body has the fitted moments"):
            check_bodies(model, free)


def test_measured_rotor_speeds_without_commands_give_back_the_truth(tmp_path):
    true = {"drone_plugin.hubMomentCoeff": 2e-4, "frame.ixx": 1.6e-5, "frame.iyy": 1.7e-5}
    logs = []
    random = np.random.default_rng(0)
    for seed, reference in enumerate(("circle:radius=0.8,rate=2", "eight")):
        table = fly(reference, {name: repr(v) for name, v in true.items()}, seed=seed).table.copy()
        table[:, 14:] += random.normal(0, 5, (len(table), 4))  # rad/s
        logs.append(tmp_path / f"{seed}.csv")
        qc.Log(table).to_csv(logs[-1])
    found = fit_recordings("crazyflie", logs, free=list(true)).found
    for name, value in true.items():
        assert found.values[name] == pytest.approx(value, rel=0.06)
        assert found.deviations[name] < 0.1 * value
    assert np.all(found.trims[:, 0] < 5e-3)


@pytest.fixture(scope="module")
def late_rotors(tmp_path_factory):
    """Flight whose rotor speeds are logged 20 ms late."""
    table = fly("eight", {"frame.ixx": "1.6e-5"}, duration=5).table
    late = table[2:].copy()
    late[:, 14:] = table[:-2, 14:]
    late[:, 0] -= late[0, 0]
    path = tmp_path_factory.mktemp("late") / "flight.csv"
    qc.Log(late).to_csv(path)
    return path


@pytest.mark.parametrize("names", [[], ["inputs.delay"]])
def test_the_delay_of_the_inputs_is_free(late_rotors, names):
    given = {"inputs.delay": "0.01"} if names else {}
    found = fit_recordings(
        "crazyflie", [late_rotors], free=["frame.ixx", *names], parameters=given
    ).found
    assert found.trims[0, 0] == pytest.approx(-0.02, abs=5e-4)
    assert found.values["frame.ixx"] == pytest.approx(1.6e-5, rel=0.01)


def test_a_long_delay_of_noisy_rotor_speeds_is_found(tmp_path):
    """Predictions of the wrong delay have a minimum near 0, too."""
    table = fly("eight", {}, duration=10).table
    late = table[10:].copy()
    late[:, 14:] = table[:-10, 14:]
    late[:, 0] -= late[0, 0]
    random = np.random.default_rng(0)
    for columns, noise in ((slice(1, 4), 5e-4), (slice(11, 14), 0.05), (slice(14, 18), 20)):
        late[:, columns] += random.normal(0, noise, late[:, columns].shape)
    qc.Log(late).to_csv(tmp_path / "flight.csv")
    free = ["frame.ixx", "frame.iyy"]
    found = fit_recordings("crazyflie", [tmp_path / "flight.csv"], free=free).found
    assert found.trims[0, 0] == pytest.approx(-0.1, abs=2e-3)


def test_a_given_delay_is_fixed_in_fit_and_prediction(late_rotors, tmp_path):
    fitted = tmp_path / "fitted.urdf"
    done = run_command(
        "fit", "crazyflie", "--log", late_rotors, "--log", late_rotors, "--free", "frame.ixx",
        "--set", "inputs.delay=-0.015", "-o", fitted,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert re.search(r"inputs.delay +-0.015 +-0.015 +fixed +s", done.stdout)
    assert "flight.csv: commands delayed by -15 ms" in done.stdout
    assert "delay: -0.015\n" in (tmp_path / "fitted.inputs.yaml").read_text()
    errors = {}
    for delay in ("", "-0.02"):
        given = ("--set", f"inputs.delay={delay}") if delay else ()
        run_command("predict", fitted, "--log", late_rotors, "--out", tmp_path / "p", *given)
        row = (tmp_path / "p/errors.csv").read_text().splitlines()[2]
        errors[delay] = float(row.split(",")[5])
    assert errors["-0.02"] < 0.7 * errors[""]


@pytest.mark.parametrize(
    "value, message",
    [
        ("inputs.delai=0.01", "Did you mean 'inputs.delay'"),
        ("inputs.delay=1", "'1' is no number from -0.12 to 0.12"),
        ("inputs.speed=fast", "'fast' is no number from 0 to inf"),
    ],
)
def test_a_wrong_value_of_the_inputs_is_refused(value, message, tmp_path):
    assert message in run_refused(*FIT, "--set", value, "-o", tmp_path / "a.urdf")


def test_the_centre_of_mass_is_found_beside_a_constant_torque(tmp_path):
    """Both turn the vehicle; only the first grows with the thrust."""
    true = {"frame.com_x": 2e-3, "frame.com_y": -1.5e-3}
    parameters = {name: repr(value) for name, value in true.items()}
    parameters["drone_plugin.constantTorqueY"] = "1e-4"
    table = fly("eight", parameters, duration=10).table.copy()
    random = np.random.default_rng(0)
    for columns, noise in ((slice(1, 4), 5e-4), (slice(11, 14), 0.05), (slice(14, 18), 5)):
        table[:, columns] += random.normal(0, noise, table[:, columns].shape)
    qc.Log(table).to_csv(tmp_path / "flight.csv")
    found = fit_recordings("crazyflie", [tmp_path / "flight.csv"], free=list(true)).found
    for name, value in true.items():
        assert abs(found.values[name] - value) < 3 * found.deviations[name] < 5e-4
    assert found.trims[0, 3] == pytest.approx(1e-4, abs=3e-5)


@pytest.mark.parametrize(("reference", "known"), [("eight", True), ("circle:radius=0.5", False)])
def test_noisy_rotor_speeds_do_not_bias_moments_of_inertia(tmp_path, reference, known):
    """Noise attenuates the effect of the torques; a steady circle shows nothing else."""
    true = {"frame.ixx": 1.6e-5, "frame.iyy": 1.7e-5}
    parameters = {name: repr(value) for name, value in true.items()}
    if known:
        table = fly(reference, parameters, duration=10).table.copy()
    else:
        simulation = qc.Simulation("crazyflie", engine="eigen", parameters=parameters)
        log = simulation.run(10, controller="geometric", reference=reference, log_every=10)
        table = log.table.copy()
    random = np.random.default_rng(2)
    for columns, noise in ((slice(1, 4), 5e-4), (slice(11, 14), 0.05), (slice(14, 18), 20)):
        table[:, columns] += random.normal(0, noise, table[:, columns].shape)
    qc.Log(table).to_csv(tmp_path / "noisy.csv")
    found = fit_recordings("crazyflie", [tmp_path / "noisy.csv"], free=list(true)).found
    for name, value in true.items():
        assert np.isfinite(found.deviations[name]) == known
        if known:
            assert abs(found.values[name] - value) < 3 * found.deviations[name] < 0.5 * value


def test_one_log_without_commands_is_fitted(tmp_path):
    qc.Log(fly("eight", {}, duration=5).table).to_csv(tmp_path / "flight.csv")
    done = run_command(
        "fit", "crazyflie", "--log", tmp_path / "flight.csv", "--free", "frame.ixx",
        "-o", tmp_path / "fitted.urdf",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    fitted = qc.Simulation(tmp_path / "fitted.urdf", engine="eigen")
    start = qc.Simulation("crazyflie", engine="eigen")
    assert fitted.inertia[0, 0] == pytest.approx(start.inertia[0, 0], rel=0.01)


def test_a_fit_to_one_real_flight_predicts_another_better_than_baselines(tmp_path):
    done = run_command(
        "fit", "crazyflie", "--log", REP4, "--judge", REP11, "-o", tmp_path / "fitted.urdf",
        "--out", tmp_path / "report", "--free",
        "inputs.speed,inputs.battery,drone_plugin.inducedDragCoeff,drone_plugin.rollDampingCoeff,"
        "drone_plugin.pitchDampingCoeff,frame.ixx,frame.iyy,frame.izz",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    rows = (tmp_path / "report/errors.csv").read_text().splitlines()
    assert rows[0] == "model,channel,unit,0.05s,0.1s,0.25s,0.5s"
    errors = {tuple(row.split(",")[:2]): [*map(float, row.split(",")[3:])] for row in rows[1:]}
    constant = "constant velocity and rates"
    for channel, factor in (("position", 0.7), ("attitude", 1)):
        assert errors["fitted model", channel][2] < factor * errors[constant, channel][2]
    assert "frame.izz" in done.stdout and "turned by" in done.stdout
    page = (tmp_path / "report/report.html").read_text()
    assert "The fitted model predicts the position better than the initial model" in page
    assert [flight["name"] for flight in content_of(page)["flights"]] == ["measured", "predicted"]
    assert "exponent: 1.0" in (tmp_path / "fitted.inputs.yaml").read_text()
    again = run_command(
        "predict", tmp_path / "fitted.urdf", "--log", REP11, "--out", tmp_path / "p"
    )
    assert again.returncode == 0, again.stderr
    found = (tmp_path / "p/errors.csv").read_text().splitlines()[1]
    assert float(found.split(",")[5]) == pytest.approx(errors["fitted model", "position"][2])


def test_a_model_worse_than_a_baseline_ends_with_status_3_unless_forced(tmp_path):
    wrong = ("--set", "drone_plugin.rollDampingCoeff=0.01", "--out", tmp_path / "p")
    done = run_command("predict", "crazyflie", "--log", REP4, *wrong)
    assert done.returncode == 3
    assert re.search(r"at 0.25 s: the model errs by .* or add --force", done.stderr)
    assert run_command("predict", "crazyflie", "--log", REP4, *wrong, "--force").returncode == 0


def test_a_cut_propeller_is_named(tmp_path):
    sound = [
        word
        for n in (0, 1)
        for word in ("--sound", f"{CRAZYPAD}/normal_flight_E8_log0{n}_excerpt.gz")
    ]
    done = run_command(
        "fit", "crazyflie", "--log", CRAZYPAD / "cut_propeller_M3_3mm_E8_log01_excerpt.gz", *sound,
        "--free", "rotors.factor", "-o", tmp_path / "damaged.urdf",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    loss = re.search(r"rotor 3 \(rotor3\) has lost (\d+) % of its thrust", done.stdout)
    assert loss and 15 < int(loss[1]) < 30
    rotors = qc.Simulation(tmp_path / "damaged.urdf", engine="eigen")
    assert rotors.rotor_count == 4
    alone = run_refused(
        "fit", "crazyflie", "--log", CRAZYPAD / "cut_propeller_M3_3mm_E8_log01_excerpt.gz",
        "--free", "rotors.factor", "-o", tmp_path / "damaged.urdf",
    )  # fmt: skip
    assert "--sound FILE" in alone


FIT = ("fit", "crazyflie", "--log", REP4)
DAMAGED = (*FIT, "--free", "rotors.factor", "--sound", REP11)


@pytest.mark.parametrize(
    "words, message",
    [
        (
            (*FIT, "--engine", "ode"),
            "--engine does not apply to a fit of several logs or recordings",
        ),
        ((*FIT, "--dt", "0.002"), "--dt does not apply"),
        ((*FIT, "--horizon", "1"), "--horizon does not apply"),
        ((*FIT, "--force"), "--force does not apply to a fit without --judge"),
        ((*DAMAGED, "--judge", REP11), "--judge does not apply to --free rotors.factor"),
        ((*DAMAGED, "--bound", "frame.mass=0:1"), "--bound does not apply"),
        ((*DAMAGED, "--engine", "gazebo11"), "--engine does not apply"),
        ((*DAMAGED, "--horizon", "0.5"), "--horizon does not apply"),
        (("fit", "crazyflie", "--log", "log.csv", "--sound", REP11), "--sound does not apply"),
    ],
)
def test_options_without_effect_on_a_fit_are_refused(words, message, tmp_path, monkeypatch):
    qc.Simulation("crazyflie", engine="eigen").run(0.1, topics=["vel_cmd"]).to_csv(
        tmp_path / "log.csv"
    )
    monkeypatch.chdir(tmp_path)
    refused = run_refused(*words, "-o", "fitted.urdf")
    assert message in refused and refused.endswith("Remove it.\n")


def test_an_output_that_ends_in_urdf_is_the_model_of_a_judged_fit(tmp_path):
    done = run_command(
        *FIT, "--judge", REP11, "--force", "--free", "inputs.speed", "--out",
        tmp_path / "fitted.urdf",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert qc.Simulation(tmp_path / "fitted.urdf", engine="eigen").rotor_count == 4
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fitted.inputs.yaml", "fitted.urdf"]
    both = run_refused(*FIT, "-o", tmp_path / "a.urdf", "--out", tmp_path / "b.urdf")
    assert "name two models. Give one of them." in both


def test_a_recording_without_rates_cannot_be_fitted():
    with pytest.raises(qc.InputError, match="neither rates nor an orientation"):
        prepare_flight(CRAZYPAD / "normal_flight_E8_log00_excerpt.gz")
