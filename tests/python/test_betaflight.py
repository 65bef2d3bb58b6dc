"""Betaflight's bridge against a stand-in that speaks its bytes."""

import os
import signal
import socket
import subprocess
import time

import numpy as np
import pytest
from autopilot_files import find_processes, nothing_remains, write_stack  # noqa: F401
from processes import QUADCORE, run_command, run_refused

import quadcore as qc
from quadcore.autopilots import Betaflight, Readings, Sticks, read_autopilot
from quadcore.autopilots.betaflight import frames, packets
from quadcore.model.earth import Location
from quadcore.support.rotation import compose_roll_pitch_yaw, to_matrix


def iris(spawn=(0, 0, 10)):
    return qc.Simulation("iris", engine="eigen", dt=0.002, spawn=spawn)


def fly(stack, duration, reference="hover", **options):
    simulation = iris()
    return simulation.run(
        duration,
        controller=read_autopilot(stack),
        reference=qc.references.parse(reference),
        on_reference=True,
        **options,
    )


def read_as_betaflight(fields):
    """What sitl.c makes of a packet: gyro, accelerometer and attitude, axes forward left up."""
    gyro = np.array([fields[0], -fields[1], fields[2]])
    accelerometer = -np.array(fields[3:6])
    w, x, y, z = fields[6], fields[7], -fields[8], -fields[9]
    k = np.sqrt(0.5)
    attitude = [k * (x - y), k * (y + x), k * (z + w), k * (w - z)]  # x, y, z, w in NWU
    return gyro, accelerometer, to_matrix(np.array(attitude))


@pytest.mark.parametrize("angles", [(0.3, -0.5, 0.7), (-1.2, 0.2, -2.5), (0.1, 1.1, 3.0)])
def test_betaflight_reads_the_rates_forces_and_attitude_of_the_vehicle(angles):
    turn = compose_roll_pitch_yaw(np.array(angles))  # body to east, north, up
    half = np.array(angles) / 2
    (sr, sp, sy), (cr, cp, cy) = np.sin(half), np.cos(half)
    orientation = [
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    ]
    rates, force = np.array([0.1, -0.2, 0.3]), np.array([1.0, 2.0, 9.0])
    velocity, position = np.array([3.0, -1.0, 0.5]), np.array([30.0, 50.0, 7.0])
    first = np.array([10.0, -20.0, 5.0])
    readings = Readings(1.0, position, velocity, np.array(orientation), rates, force)
    fields = frames.convert_readings(readings, first, Location(60.0, 10.0, 100.0))
    gyro, accelerometer, attitude = read_as_betaflight(fields)
    assert gyro == pytest.approx(rates) and accelerometer == pytest.approx(force)
    to_north_west_up = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    assert attitude == pytest.approx(to_north_west_up @ turn)
    assert fields[10:13] == pytest.approx(velocity)
    # Betaflight mirrors the place about that of the first packet.
    at_first = frames.convert_readings(
        readings._replace(position=first), first, Location(60.0, 10.0, 100.0)
    )
    longitude, latitude = 2 * np.array(at_first[13:15]) - np.array(fields[13:15])
    radius = 6378137.0
    assert np.radians(longitude - 10) * radius * np.cos(np.radians(60)) == pytest.approx(30)
    assert np.radians(latitude - 60) * radius == pytest.approx(50)
    assert fields[15] == pytest.approx(107)


def test_the_channels_of_the_radio_have_their_order_and_scale():
    sticks = Sticks(roll=0.5, pitch=-0.25, yaw=1.0, throttle=0.25, is_armed=True)
    packet = packets.pack_radio(2.0, sticks)
    assert len(packet) == 40
    assert np.frombuffer(packet, "<u2", offset=8)[:7].tolist() == [
        *[1750, 1375, 1250, 2000],
        *[2000, 2000, 1000],
    ]
    assert len(packets.pack_state(0.0, [0.0] * 17)) == 144


def test_it_reaches_a_point(tmp_path):
    log = fly(write_stack(tmp_path), 7, "step:dx=0.5,dy=-0.3,dz=0.2,time=0.2")
    assert log.position[-1] == pytest.approx([0.5, -0.3, 10.2], abs=0.01)


def test_flights_are_bit_identical_also_side_by_side_and_if_answers_are_lost(tmp_path):
    stack = write_stack(tmp_path)
    lossy = write_stack(tmp_path, "drop=200", name="lossy.yaml")  # each repeat takes 0.25 s
    arguments = ["iris", "--engine", "eigen", "--dt", "0.002", "--duration", "0.5", "--quiet"]
    command = [*QUADCORE, "run", *arguments, "--reference", "step:dx=1", "--controller"]
    logs = [tmp_path / f"{name}.csv" for name in ("a", "b", "lossy")]
    flights = [
        subprocess.Popen([*command, file, "--log", log], stderr=subprocess.DEVNULL)
        for file, log in zip((stack, stack, lossy), logs)
    ]
    assert [flight.wait(120) for flight in flights] == [0, 0, 0]
    run_command(
        "run", *arguments, "--reference", "step:dx=1", "--controller", stack, "--log", logs[0]
    )
    assert logs[0].read_bytes() == logs[1].read_bytes() == logs[2].read_bytes()


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("short=0.5", "a packet of motors has 12 bytes instead of 16"),
        ("nan=0.5", "a packet of motors contains a number that is not finite"),
        ("disarm=2", "at t = 0.4.* s: the autopilot disarmed"),
        ("no_arm", "t = 0.000000 s: the autopilot did not arm. Its last messages: .* ACC_CALIB"),
        ("die=2", r"at t = 0.40.* ended \(signal SIGKILL\)\. Its last messages: .* in the mixer"),
    ],
)
def test_a_broken_autopilot_ends_the_flight_with_one_line(tmp_path, fault, reason):
    with pytest.raises(qc.FlightError, match=reason) as failure:
        fly(write_stack(tmp_path, fault), 1)
    assert "\n" not in str(failure.value)


def test_a_killed_autopilot_is_exit_status_3(tmp_path):
    stack = write_stack(tmp_path, "die=2.1")
    done = run_command(
        *["run", "iris", "--engine", "eigen", "--dt", "0.002", "--controller", str(stack)],
        *["--reference", "hover", "--duration", "2", "--quiet"],
    )
    assert done.returncode == 3
    assert "error: the flight failed at t = 0.50" in done.stderr


def test_nothing_remains_of_a_simulator_that_is_killed(tmp_path):
    stack = write_stack(tmp_path)
    flight = subprocess.Popen(
        [
            *[*QUADCORE, "run", "iris", "--engine", "eigen", "--controller", stack, "--quiet"],
            *["--duration", "1000", "--reference", "hover"],
        ],
        stderr=subprocess.DEVNULL,
    )
    folder = tmp_path / "temporary"
    while len(find_processes(folder)) < 3:  # quadcore, the stand-in, and what watches it
        assert flight.poll() is None
        time.sleep(0.05)
    os.kill(flight.pid, signal.SIGKILL)
    flight.wait()
    until = time.monotonic() + 20
    while (find_processes(folder) or list(folder.iterdir())) and time.monotonic() < until:
        time.sleep(0.05)  # the fixture judges what remains


def test_a_port_that_is_taken_is_bad_input(tmp_path):
    stack = write_stack(tmp_path, ports="9002, 9003, 9004, 5761")  # Betaflight's own
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 9002))
        done = run_command("run", "iris", "--controller", str(stack), "--reference", "hover")
    assert done.returncode == 2
    assert "error: UDP port 9002: Address already in use. End the other autopilot" in done.stderr


def test_a_slow_autopilot_is_waited_for_with_a_warning(tmp_path):
    with pytest.warns(qc.QuadcoreWarning, match="has not answered for 2 s. quadcore waits"):
        log = fly(write_stack(tmp_path, "pause=1.7"), 0.2)
    assert log.position[-1] == pytest.approx([0, 0, 10], abs=0.02)


def test_parameters_are_written_and_read_back(tmp_path):
    for given, reason in (
        ("{bogus: 3}", r"stack.yaml:6: Betaflight refused a line: .*INVALID NAME: bogus = 3"),
        ("{stubborn: 3}", "stack.yaml:6: Betaflight has stubborn = 180 after it was set to 3"),
    ):
        with pytest.raises(qc.InputError, match=reason):
            fly(write_stack(tmp_path, more=f"parameters: {given}\n"), 0.1)


def test_the_thesis_quadrotor_is_refused_by_its_tag(tmp_path):
    done = run_refused("run", "quadrotor", "--controller", str(write_stack(tmp_path)), "--quiet")
    assert "<reactionTorque> is thesis" in done
    assert "--set drone_plugin.reactionTorque=opposing" in done


def test_a_flight_without_a_reference_is_refused(tmp_path):
    with pytest.raises(qc.InputError, match="Add --reference hover"):
        iris().run(0.1, controller=read_autopilot(write_stack(tmp_path)))


def test_its_own_pilot_flies(tmp_path):
    (tmp_path / "sticks.py").write_text(
        "from quadcore.autopilots import Sticks\n"
        "def fly(t, state, reference):\n"
        "    return Sticks(roll=0.2, throttle=0.75, is_armed=True)\n"
    )
    log = fly(write_stack(tmp_path, more="pilot: ./sticks.py:fly\n"), 1)
    assert log.position[-1, 1] < -0.1  # to the right


def test_an_evaluation_is_bit_identical(tmp_path):
    stack = write_stack(tmp_path)
    tables = []
    for name in ("first", "second"):
        done = run_command(
            *["evaluate", "--model", "iris", "--controller", f"geometric,{stack}"],
            *["--reference", "hover", "--duration", "0.2", "--dt", "0.002", "--seeds", "2"],
            *["--out", str(tmp_path / name), "--no-plots", "--quiet"],
        )
        assert done.returncode == 0, done.stderr
        tables.append((tmp_path / name / "table.csv").read_bytes())
    assert tables[0] == tables[1]
    # The true state replaces its sensors.
    assert b"stack.yaml (privileged)" in tables[0]


def test_the_class_is_a_controller(tmp_path):
    with pytest.raises(qc.InputError, match="hold is 1, but Betaflight needs at least 1"):
        Betaflight("true", hold=1)
