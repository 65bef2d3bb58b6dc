"""What all bridges to autopilots share: stack files, rotor map, motor curve, bench, phases."""

import numpy as np
import pytest
from autopilot_files import nothing_remains  # noqa: F401

import quadcore as qc
from quadcore.autopilots import Autopilot, Betaflight, Sticks, read_autopilot
from quadcore.autopilots.motor_curve import MotorCurve
from quadcore.autopilots.rotor_map import map_channels


class Recorder(Autopilot):
    """Hovers, and records the order of its calls."""

    layout = Betaflight.layout

    def __init__(self, **options):
        super().__init__(**options)
        self.calls, self.readings = [], []

    def start(self, vehicle):
        self.calls.append("start")
        self.outputs = self.curve.find_outputs(np.abs(vehicle.hover_speed))

    def pilot(self, t, state, reference):
        self.calls.append("pilot" if t >= 0 else "before")
        return Sticks()

    def tick(self, readings, sticks):
        self.readings.append(readings)
        return self.outputs

    def close(self):
        self.calls.append("close")


def fly(autopilot, model="iris", duration=0.05, spawn=(0, 0, 10), **options):
    simulation = qc.Simulation(model, engine="eigen", dt=0.001, spawn=spawn, **options)
    return simulation.run(duration, controller=autopilot, reference="hover")


def test_the_phase_before_the_flight_is_not_part_of_it():
    autopilot = Recorder(hold=0.1)
    log = fly(autopilot, spawn=(1, 2, 3, 0.2, 0.1, 0.5))
    assert autopilot.calls == ["start", *["before"] * 10, *["pilot"] * 5, "close"]
    assert log.table.tolist() == fly(Recorder(), spawn=(1, 2, 3, 0.2, 0.1, 0.5)).table.tolist()
    held = autopilot.readings[:100]
    assert [each.time for each in held] == pytest.approx(np.arange(-100, 0) / 1000)
    assert all(np.all(each.angular_velocity == 0) for each in held)
    assert np.linalg.norm(held[0].specific_force) == pytest.approx(9.8, abs=0.01)


def test_ideal_readings_are_the_motion_of_the_vehicle():
    """In free fall the specific force vanishes; with hovering rotors it is that of gravity."""
    autopilot = Recorder()
    fly(autopilot, duration=0.5)
    force = autopilot.readings[-1].specific_force
    assert force == pytest.approx([0, 0, 9.8], abs=0.1)  # the rotors have reached their speed
    assert autopilot.readings[1].specific_force == pytest.approx([0, 0, 0], abs=0.1)


def test_the_imu_of_the_model_is_read_by_its_topic():
    autopilot = Recorder(imu="imu")
    fly(autopilot, duration=0.3)
    ideal = Recorder()
    fly(ideal, duration=0.3)
    noisy, exact = autopilot.readings[-1], ideal.readings[-1]
    assert noisy.specific_force != pytest.approx(exact.specific_force, abs=1e-9)
    assert noisy.specific_force == pytest.approx(exact.specific_force, abs=0.5)
    with pytest.raises(qc.InputError, match="no plugin publishes an IMU on topic 'nose'"):
        fly(Recorder(imu="nose"))


def test_the_log_has_the_outputs():
    autopilot = Recorder()
    log = fly(autopilot)
    assert log["controller.output3"][-1] == autopilot.outputs[2]


def test_outputs_reach_the_rotors_of_their_places():
    """iris: front right and rear left turn counter-clockwise."""
    rotors = qc.Simulation("iris", engine="eigen").rotors
    channels = map_channels(Betaflight.layout, rotors, [])
    assert [channel.rotor.joint[-7:] for channel in channels] == [
        *["3_joint", "0_joint"],
        *["1_joint", "2_joint"],
    ]
    assert str(channels[0]) == "1: rear right, clockwise: iris/rotor_3_joint"


@pytest.mark.parametrize(
    ("model", "options", "reason"),
    [
        ("quadrotor", {}, "model 'quadrotor': <reactionTorque> is thesis"),
        ("hummingbird", {}, "0 rotors are rear right, where the autopilot has motor 1. Use a mod"),
        ("firefly", {}, "The autopilot drives 4 motors, but the model has 6 rotors"),
        ("iris", {"rotors": ["a"] * 4}, "rotors: the model has no rotor 'a'"),
        ("iris", {"rotors": ["iris/rotor_0_joint"] * 4}, "rotors: 4 names. Give each of iris/rot"),
        ("iris", {"motor_curve": "cubic"}, "motor_curve is 'cubic'. Give speed, thrust"),
    ],
)
def test_a_vehicle_that_does_not_fit_is_refused(model, options, reason):
    with pytest.raises(qc.InputError, match=reason):
        fly(Recorder(**options), model)


def test_a_rotor_that_turns_the_other_way_is_named():
    rotors = qc.Simulation("iris", engine="eigen").rotors
    other_way = [place._replace(spin=-place.spin) for place in Betaflight.layout]
    with pytest.raises(
        qc.InputError, match=r"\(rear right\) turns clockwise, but the autopilot ex"
    ):
        map_channels(other_way, rotors, [])


@pytest.mark.parametrize(
    ("curve", "half"), [("speed", 450), ("thrust", 900 * np.sqrt(0.5)), ([[0, 100], [1, 700]], 400)]
)
def test_motor_curves(curve, half):
    found = MotorCurve(curve, np.array([900.0, 900.0]))
    assert found.find_speeds(np.array([0.5, 0.5])) == pytest.approx([half, half])
    assert found.find_outputs(np.array([half, half])) == pytest.approx([0.5, 0.5])


def test_a_curve_by_name_needs_a_maximum_speed():
    with pytest.raises(qc.InputError, match="motor_curve 'speed' needs the maximum speed"):
        MotorCurve("speed", np.array([np.inf]))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("autopilot: betaflight\n", ":1: program: is missing. Add it."),
        ("autopilot: btaflight\nprogram: sh\n", ":1: autopilot 'btaflight' does not exist. Did"),
        ("autopilot: betaflight\nprogram: sh\nhald: 3\n", ":3: a stack file has no 'hald'. Did"),
        ("autopilot: betaflight\nprogram: /no/such\n", ":2: program '/no/such' does not exist"),
        ("autopilot: betaflight\nprogram: sh\nhold: long\n", ":3: hold is not a number"),
        ("autopilot: betaflight\nprogram: sh\nhold: 1\n", ":3: hold is 1, but Betaflight needs"),
        ("autopilot: betaflight\nprogram: sh\nrotors: x\n", ":3: rotors is not a list"),
        ("autopilot: betaflight\nprogram: sh\nmotor_curve: x\n", ":3: motor_curve is 'x'. Give"),
        ("autopilot: betaflight\nprogram: sh\nmotor_curve: [1]\n", ":3: motor_curve needs pairs"),
        (
            "autopilot: betaflight\nprogram: sh\nmotor_curve: [[1, 2], [0, 3]]\n",
            ":3: motor_curve is .* both rising",
        ),
        ("autopilot: betaflight\nprogram: sh\npilot: none.py:x\n", ":3: none.py: cannot be read"),
        ("autopilot: betaflight\nprogram: sh\nprogram: sh\n", ":3: program is given twice"),
    ],
)
def test_errors_of_stack_files_have_a_line(tmp_path, text, reason):
    path = tmp_path / "stack.yaml"
    path.write_text(text)
    with pytest.raises(qc.InputError, match=f"stack.yaml{reason}"):
        read_autopilot(path)


def test_a_gains_file_is_still_one_and_an_autopilot_has_no_gains(tmp_path):
    gains = tmp_path / "gains.yaml"
    gains.write_text("law: geometric\n")
    assert qc.controllers.parse(str(gains)).name == "geometric"
    stack = tmp_path / "stack.yaml"
    stack.write_text("autopilot: betaflight\nprogram: sh\n")
    assert isinstance(qc.controllers.parse(str(stack)), Betaflight)
    with pytest.raises(qc.InputError, match="this controller has no gains to tune"):
        qc.controllers.read_own(str(stack))
