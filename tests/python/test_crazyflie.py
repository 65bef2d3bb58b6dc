"""The bridge to the Crazyflie firmware: a stand-in, and a recorded flight of the real one."""

from pathlib import Path

import numpy as np
import pytest
from processes import run_command

import quadcore as qc
from quadcore.autopilots import Crazyflie, Readings, read_autopilot
from quadcore.autopilots.crazyflie import convert_readings
from quadcore.support.rotation import to_roll_pitch_yaw, turn

STAND_IN = Path(__file__).with_name("crazyflie_stand_in.py")
DATA = Path(__file__).parents[1] / "data"


def write_stack(folder, more="", program=STAND_IN):
    path = folder / "crazyflie.yaml"
    path.write_text(f"autopilot: crazyflie\nprogram: {program}\n{more}")
    return path


def fly(controller, duration, reference="circle:radius=0.5"):
    simulation = qc.Simulation("crazyflie", engine="eigen", dt=0.001)
    return simulation.run(
        duration,
        controller=controller,
        reference=qc.references.parse(reference),
        on_reference=True,
    )


def test_a_real_flight_of_the_firmware_is_repeated_bit_for_bit():
    """Recorded from the bindings of commit 2a18fc2: 1 s of a circle of 0.5 m."""
    done = run_command("autopilot", "replay", str(DATA / "crazyflie_2a18fc2.qcs"))
    assert "the flight is bit-identical to the recorded one" in done.stdout, done.stderr


def test_it_flies_a_circle_twice_with_equal_bytes(tmp_path):
    stack = write_stack(tmp_path)
    first, second = (fly(read_autopilot(stack), 2) for _ in range(2))
    assert first.table.tobytes() == second.table.tobytes()
    radius = np.hypot(*first.position[-1, :2])
    assert radius == pytest.approx(0.5, abs=0.02)


def test_the_firmware_turns_to_the_yaw_of_the_reference(tmp_path):
    log = fly(read_autopilot(write_stack(tmp_path)), 2, "step:dyaw=0.5")
    assert to_roll_pitch_yaw(log.orientation[-1])[2] == pytest.approx(0.5, abs=0.02)


def test_readings_have_the_units_and_signs_of_the_firmware():
    level = np.array([0.0, 0, 0, 1])
    orientation = turn(turn(level, np.array([0, 0, 0.4])), np.array([0, 0.3, 0]))
    rates, force = np.radians([10.0, -20.0, 30.0]), 9.80665 * np.array([1.0, -2.0, 3.0])
    place, velocity = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
    numbers = convert_readings(Readings(0.0, place, velocity, orientation, rates, force))
    assert numbers[:6] == [1, 2, 3, 4, 5, 6] and numbers[6:10] == orientation.tolist()
    # A lowered nose is a positive rotation about the left axis; the firmware calls it negative.
    assert numbers[10:13] == pytest.approx([0, -np.degrees(0.3), np.degrees(0.4)])
    assert numbers[13:] == pytest.approx([10, -20, 30, 1, -2, 3])


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ("parameters: {kp_xx: 1}\n", "controllerMellinger_t has no 'kp_xx'. Did you mean 'kp_xy'"),
        ("parameters: {kp_xy: much}\n", "crazyflie.yaml:3: kp_xy is much. Write a number."),
        ("hold: 601\n", "crazyflie.yaml:3: hold is 601. Use 0 to 600 s."),
        ("hold: -1\n", "crazyflie.yaml:3: hold is -1. Use 0 to 600 s."),
        ("hold: nan\n", "crazyflie.yaml:3: hold is not a number. Write one."),
        ("lockstep: strict\n", "yaml:3: lockstep: autopilot crazyflie does not use it. Leave it"),
    ],
)
def test_wrong_stack_files_are_one_line(tmp_path, more, reason):
    with pytest.raises(qc.InputError, match=reason):
        fly(read_autopilot(write_stack(tmp_path, more)), 0.1)


def test_a_module_that_is_missing_or_broken_is_one_line(tmp_path):
    with pytest.raises(qc.InputError, match=r"yaml:2: module '.*none.py' does not exist. Build it"):
        read_autopilot(write_stack(tmp_path, program="./none.py"))
    (tmp_path / "broken.py").write_text("import a_module_that_is_not_there\n")
    with pytest.raises(qc.InputError, match=r"broken.py: cannot be loaded: No module .* Run make"):
        fly(read_autopilot(write_stack(tmp_path, program="./broken.py")), 0.1)


def test_the_class_is_a_controller():
    with pytest.raises(qc.InputError, match=r"^hold is nan. Use 0 to 600 s."):
        Crazyflie(str(STAND_IN), hold=float("nan"))
    with qc.autopilots.Crazyflie(str(STAND_IN), {"kp_z": "2"}) as autopilot:
        log = fly(autopilot, 0.5, "hover")
    assert log.position[-1] == pytest.approx([0, 0, 10], abs=0.005)
