"""`quadcore autopilot check` finds every error made on purpose."""

import re
from itertools import combinations

import pytest
from autopilot_files import nothing_remains, write_stack  # noqa: F401
from processes import run_command

import quadcore as qc
from quadcore.autopilots import read_autopilot
from quadcore.autopilots.check import check_autopilot

AXES = {"x": "forward", "y": "left", "z": "up"}


def check(stack):
    """Check at 250 Hz, a quarter of the usual rate."""
    return check_autopilot(read_autopilot(stack), qc.Simulation("iris", engine="eigen", dt=0.004))


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("sensor", ["gyro", "acc"])
def test_each_wrong_sign_of_a_sensor_is_named(tmp_path, sensor, axis):
    (problem,) = check(write_stack(tmp_path, f"{sensor}_{axis}"))
    name = {"gyro": "gyroscope about", "acc": "accelerometer along"}[sensor]
    assert re.search(rf"{name} the {AXES[axis]} axis .*has the wrong sign", problem)


@pytest.mark.parametrize("pair", list(combinations((1, 2, 3, 4), 2)))
def test_each_swapped_pair_of_motors_is_named(tmp_path, pair):
    problems = check(write_stack(tmp_path, "swap={}{}".format(*pair)))
    assert problems[-1].startswith("Motors {} and {} are swapped".format(*pair))
    for number, problem in zip(pair, problems):  # turned alone, the other one turns
        assert problem.startswith(f"Motor {number} was to turn alone, but the outputs were")
    assert len(problems) == 3


def test_a_wrong_order_in_the_stack_file_is_named(tmp_path):
    joints = [f"iris/rotor_{i}_joint" for i in (0, 3, 1, 2)]  # 3, 0, 1, 2 is right
    (problem,) = check(write_stack(tmp_path, more=f"rotors: [{', '.join(joints)}]\n"))
    assert problem == (
        "Motors 1 and 2 are swapped: output 1 must drive rotor 'iris/rotor_3_joint', and output 2 "
        "'iris/rotor_0_joint'."
    )


@pytest.mark.parametrize(
    ("fault", "start"),
    [
        ("yaw_spin", "All motors respond to yaw with the wrong sign"),
        ("dead=3", "Motor 3 was to turn alone, but the outputs were 0.00, 0.00, 0.00, 0.00."),
    ],
)
def test_a_wrong_spin_and_a_dead_motor_are_named(tmp_path, fault, start):
    assert check(write_stack(tmp_path, fault))[0].startswith(start)


def test_answers_with_wrong_magic_are_one_line(tmp_path):
    with pytest.raises(qc.InputError, match=r"starts with b'\$X>' instead of b'\$M>'"):
        check(write_stack(tmp_path, "magic"))


def test_the_command_prints_the_map_and_exits_with_2_if_something_is_wrong(tmp_path):
    done = run_command("autopilot", "check", str(write_stack(tmp_path)))
    assert done.returncode == 0, done.stderr
    assert "motor 1: rear right, clockwise: iris/rotor_3_joint" in done.stdout
    done = run_command("autopilot", "check", str(write_stack(tmp_path, "gyro_z")))
    assert done.returncode == 2
    assert "problem: The gyroscope about the up axis (yaw) has the wrong sign." in done.stderr
    assert "error: " in done.stderr and "stack.yaml: 1 problem." in done.stderr


def test_the_command_lists_the_bridges():
    listed = run_command("autopilot", "list").stdout.splitlines()
    assert [line.split()[0] for line in listed] == ["ardupilot", "betaflight", "crazyflie", "px4"]
