"""ArduPilot's bridge against a stand-in that speaks its JSON interface."""

import hashlib
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from autopilot_files import fly_iris as fly
from autopilot_files import nothing_remains, turn_in_all_axes  # noqa: F401
from processes import run_command

import quadcore as qc
from quadcore.autopilots import Readings, Sticks, read_autopilot
from quadcore.autopilots.ardupilot import convert_readings, pack_radio, pack_state, read_servos
from quadcore.support.rotation import to_matrix

STAND_IN = Path(__file__).with_name("ardupilot_stand_in.py")
FLIGHT = ["run", "iris", "--engine", "eigen", "--dt", "0.001", "--quiet"]


def write_stack(folder, *faults, hold=3.2):
    fault = "".join(f", --fault, {each}" for each in faults)
    path = folder / "ardupilot.yaml"
    path.write_text(
        f"autopilot: ardupilot\nprogram: {sys.executable}\nhold: {hold}\n"
        f'arguments: [{STAND_IN}, --ports, "{{motors}}", "{{radio}}", '
        f"--defaults, quadcore.parm{fault}]\n"
    )
    return path


def test_ardupilot_reads_the_axes_of_the_vehicle():
    orientation = turn_in_all_axes()
    vectors = [
        np.array(each) for each in ([30, 50, 7.0], [3, -1, 0.5], [0.1, -0.2, 0.3], [1, 2, 9.0])
    ]
    position, velocity, rates, force = vectors
    values = convert_readings(Readings(0.0, position, velocity, orientation, rates, force))
    assert values["position"] == [50, 30, -7] and values["velocity"] == [-1, 3, -0.5]
    assert values["gyro"] == [0.1, 0.2, -0.3] and values["accel_body"] == [1, -2, -9]
    to_north_east_down = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
    to_forward_right_down = np.diag([1, -1, -1])
    w, x, y, z = values["quaternion"]
    assert to_matrix(np.array([x, y, z, w])) == pytest.approx(
        to_north_east_down @ to_matrix(orientation) @ to_forward_right_down
    )


def test_the_state_is_a_line_without_spaces():
    """SIM_JSON.cpp:129 searches for a key, and needs a bracket after its quote and colon."""
    zero = np.zeros(3)
    packet = pack_state(1.5, Readings(0.0, zero, zero, np.array([0.0, 0, 0, 1]), zero, zero))
    assert packet.startswith(b"\n") and packet.endswith(b"\n") and b" " not in packet
    state = json.loads(packet)
    assert list(state) == ["timestamp", "imu", "position", "velocity", "quaternion", "no_time_sync"]
    assert state["timestamp"] == 1.5


def test_the_channels_of_the_radio_have_their_order_and_scale():
    sticks = Sticks(roll=0.5, pitch=-0.25, yaw=1.0, throttle=0.25, is_armed=True)
    channels = np.frombuffer(pack_radio(sticks), "<u2").tolist()
    assert channels == [1750, 1375, 1250, 2000, 2000, *[0] * 11]


def test_the_servos_are_pulses():
    packet = np.array([18458, 400, 7, 0, 1000, 1500, 2000, 900], "<u2").tobytes() + bytes(24)
    outputs, count, problem = read_servos(packet)
    assert outputs[:4] == [0, 0.5, 1, 0] and count == 7 and not problem


def test_it_reaches_a_point_twice_with_equal_bytes(tmp_path):
    stack = write_stack(tmp_path)
    first, second = (fly(stack, 7, "step:dx=0.5,dy=-0.3,dz=0.2,time=0.2") for _ in range(2))
    assert first.position[-1] == pytest.approx([0.5, -0.3, 10.2], abs=0.01)
    assert first.table.tobytes() == second.table.tobytes()


def test_lost_answers_change_nothing(tmp_path):
    whole = fly(write_stack(tmp_path), 0.3, "step:dx=1")
    lossy = fly(write_stack(tmp_path, "drop=700"), 0.3, "step:dx=1")
    assert whole.table.tobytes() == lossy.table.tobytes()


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("short=3.3", "t = 0.10.*: a packet of servos has 20 bytes instead of 40"),
        ("magic=3.3", "t = 0.10.*: a packet of servos begins with 29569 instead of 18458"),
        ("reset=3.3", "t = 0.10.*: the autopilot has restarted. Its last messages: Starting SITL"),
        ("disarm=3.3", "t = 0.1.*: the autopilot disarmed"),
        ("no_arm", "t = 0.000000 s: the autopilot did not arm"),
        ("die=3.3", r"t = 0.10.*: the autopilot ended \(signal SIGKILL\).*Floating point"),
    ],
)
def test_a_broken_autopilot_ends_the_flight_with_one_line(tmp_path, fault, reason):
    with pytest.raises(qc.FlightError, match=reason) as failure:
        fly(write_stack(tmp_path, fault), 1)
    assert "\n" not in str(failure.value)


def test_an_autopilot_that_ends_at_once_is_exit_status_3(tmp_path):
    stack = tmp_path / "ends.yaml"
    stack.write_text('autopilot: ardupilot\nprogram: sh\narguments: [-c, "echo no licence"]\n')
    done = run_command(*FLIGHT, "--controller", str(stack), "--reference", "hover")
    assert done.returncode == 3
    assert "30.000 s before the flight: the autopilot ended (exit status 0)" in done.stderr
    assert "no licence" in done.stderr


def test_a_session_is_repeated_without_the_program(tmp_path):
    path, stack = tmp_path / "session.qcs", write_stack(tmp_path)
    done = run_command(
        *[*FLIGHT[:-1], "--duration", "0.3", "--controller", str(stack)],
        *["--reference", "step:dx=1"],
        *["--record", str(path)],
    )
    assert done.returncode == 0, done.stderr
    digest = hashlib.sha256(Path(sys.executable).read_bytes()).hexdigest()[:12]
    assert f"{Path(sys.executable).name}, SHA-256 {digest}" in done.stdout
    assert "0 questions repeated" in done.stdout and " times real time" in done.stdout
    stack.unlink()
    assert "bit-identical" in run_command("autopilot", "replay", str(path)).stdout


def test_the_hold_covers_the_arming(tmp_path):
    with pytest.raises(qc.InputError, match="yaml:3: hold is 2, but ArduPilot needs at least 3 s"):
        read_autopilot(write_stack(tmp_path, hold=2))
