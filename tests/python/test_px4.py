"""PX4's bridge against a stand-in that speaks the MAVLink of its simulator interface."""

import contextlib
import functools
import math
import socket
import sys
from pathlib import Path

import numpy as np
import pytest
from autopilot_files import fly_iris, nothing_remains, turn_in_all_axes  # noqa: F401
from processes import run_command

import quadcore as qc
from quadcore.autopilots import Readings, read_autopilot
from quadcore.autopilots.axes import turn_body_vector, turn_heading, turn_orientation
from quadcore.autopilots.px4.sensors import SensorPackets, find_pressure
from quadcore.model.earth import Location
from quadcore.support.rotation import to_matrix

mavlink = pytest.importorskip("pymavlink.dialects.v20.common")
pytest.importorskip("pygeomag")

STAND_IN = Path(__file__).with_name("px4_stand_in.py")
DATA = Path(__file__).parents[1] / "data"
FLIGHT = ["run", "iris", "--engine", "eigen", "--dt", "0.004", "--quiet"]


def write_stack(folder, *faults, hold=8, more=""):
    fault = "".join(f", --fault, {each}" for each in faults)
    path = folder / "px4.yaml"
    path.write_text(
        f"autopilot: px4\nprogram: {sys.executable}\nhold: {hold}\n"
        f'arguments: [{STAND_IN}, -i, "{{instance}}"{fault}]\n{more}'
    )
    return path


fly = functools.partial(fly_iris, dt=0.004)


def test_px4_reads_the_sensors_in_its_axes_and_units():
    vectors = ([30, 50, 7.0], [3, -1, 0.5], [0.1, -0.2, 0.3], [1, 2, 9.0])
    position, velocity, rates, force = map(np.array, vectors)
    readings = Readings(0.0, position, velocity, turn_in_all_axes(), rates, force)
    field = np.array([2e-5, 1e-5, -4e-5])
    packets = SensorPackets(mavlink, field, Location(60.0, 10.0, 100.0))
    read = [packets.read_sensor(0, readings, True) for _ in range(400)]

    def mean(names):
        return np.mean([[getattr(each, name) for name in names.split()] for each in read], axis=0)

    assert mean("xgyro ygyro zgyro") == pytest.approx([0.1, 0.2, -0.3], abs=3e-4)
    assert mean("xacc yacc zacc") == pytest.approx([1, -2, -9], abs=5e-3)
    north_east_down = np.array([0.1, 0.2, 0.4])  # Gauss
    w, x, y, z = turn_orientation(turn_in_all_axes())
    assert mean("xmag ymag zmag") == pytest.approx(
        to_matrix(np.array([x, y, z, w])).T @ north_east_down, abs=2e-4
    )
    assert mean("abs_pressure") == pytest.approx([find_pressure(107.0)], abs=2e-3)
    gps = packets.read_gps(0, readings)
    assert (gps.vn, gps.ve, gps.vd, gps.alt) == (-100, 300, -50, 107000)
    assert gps.cog == round(100 * math.degrees(math.atan2(3, -1)))
    assert gps.lat == pytest.approx(6e8 + 50 / 111319.49 * 1e7, abs=1)
    assert gps.lon == pytest.approx(1e8 + 30 / 111319.49 * 2e7, abs=1)


def test_the_pressure_is_that_of_the_standard_atmosphere():
    """ISO 2533, table 1, at a geopotential altitude of 5 km."""
    assert find_pressure(0.0) == pytest.approx(1013.25)
    assert find_pressure(5000.0) == pytest.approx(540.20, abs=0.01)


def test_headings_turn_clockwise_from_north():
    assert turn_heading(0.0) == pytest.approx(math.pi / 2)
    assert turn_heading(math.pi / 2) == pytest.approx(0.0)
    assert turn_heading(math.pi) == pytest.approx(-math.pi / 2)
    assert turn_body_vector(np.array([1.0, 2, 3])) == [1, -2, -3]


def test_it_reaches_a_point_and_its_estimate_is_the_truth(tmp_path):
    log = fly(write_stack(tmp_path), 7, "step:dx=0.5,dy=-0.3,dz=0.2,time=0.2")
    assert log.position[-1] == pytest.approx([0.5, -0.3, 10.2], abs=0.01)
    x, y, z, roll, pitch, yaw = (
        log[f"controller.estimate_{name}"] for name in ("x", "y", "z", "roll", "pitch", "yaw")
    )
    assert [x[-1], y[-1], z[-1], yaw[-1]] == pytest.approx([*log.position[-1], 0.0], abs=0.02)
    known = np.isfinite(roll)
    up = np.array([to_matrix(each)[2] for each in log.orientation])
    sides = np.arctan2(up[:, 1], up[:, 2]), -np.arcsin(up[:, 0])
    assert max(sides[0][known]) > 0.02 and max(sides[1][known]) > 0.05
    late = 0.08  # rad; of ten ticks between two estimates
    assert roll[known] == pytest.approx(sides[0][known], abs=late)
    assert pitch[known] == pytest.approx(sides[1][known], abs=late)
    assert log["controller.mode"][1] == 6 and log["controller.armed"][1] == 1


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ("garbage=9.1", "t = 0.10.*: the autopilot has sent bytes that are not MAVLink 2"),
        ("checksum=9.1", "t = 0.10.*: the autopilot has sent bytes that are not MAVLink: "),
        ("nan=9.1", "t = 0.10.*: the autopilot answered with outputs"),
        ("leave=9.1", "t = 0.10.*: the autopilot has closed the connection"),
        ("disarm=9.1", "t = 0.1.*: the autopilot disarmed"),
        ("no_arm", "t = 0.00.* s: the autopilot did not arm. .*Arming denied: compass"),
        ("die=9.1", r"t = 0.10.*: the autopilot ended \(signal SIGKILL\).*Segmentation fault"),
    ],
)
def test_a_broken_autopilot_ends_the_flight_with_one_line(tmp_path, fault, reason):
    with pytest.raises(qc.FlightError, match=reason) as failure:
        fly(write_stack(tmp_path, fault), 1)
    assert "\n" not in str(failure.value)


def test_a_parameter_that_px4_does_not_accept_is_named(tmp_path):
    with pytest.raises(qc.InputError, match=r"yaml:5: PX4 has not accepted MPC_XY_P = 1. Correct"):
        fly(write_stack(tmp_path, more="parameters: {MPC_XY_P: 1}\n"), 1)
    with pytest.raises(qc.InputError, match=r"accepted .*THR_MDL_FAC = 0.5"):
        fly(write_stack(tmp_path, "stubborn", more="parameters: {THR_MDL_FAC: 0.5}\n"), 1)


def test_an_option_that_is_no_number_is_refused(tmp_path):
    with pytest.raises(qc.InputError, match="parameter MPC_XY_P: fast is no parameter of PX4"):
        fly(write_stack(tmp_path, more="parameters: {MPC_XY_P: fast}\n"), 1)


def test_a_taken_set_of_ports_is_refused(tmp_path):
    with contextlib.ExitStack() as stack:
        for port in range(4560, 4570):
            taken = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_STREAM))
            taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            with contextlib.suppress(OSError):  # by another test
                taken.bind(("127.0.0.1", port))
                taken.listen(1)
        with pytest.raises(qc.InputError, match="no port of the instances 0 to 9 of PX4 is free"):
            fly(write_stack(tmp_path), 1)


def test_the_hold_covers_the_alignment_of_the_estimator(tmp_path):
    with pytest.raises(qc.InputError, match="yaml:3: hold is 5, but PX4 needs at least 8 s"):
        read_autopilot(write_stack(tmp_path, hold=5))


def test_a_session_is_repeated_without_the_program(tmp_path):
    path, stack = tmp_path / "session.qcs", write_stack(tmp_path)
    done = run_command(
        *[*FLIGHT, "--duration", "0.3", "--controller", str(stack), "--reference", "step:dx=1"],
        *["--record", str(path)],
    )
    assert done.returncode == 0, done.stderr
    stack.unlink()
    assert "bit-identical" in run_command("autopilot", "replay", str(path)).stdout


def test_a_real_flight_of_px4_is_repeated_bit_for_bit():
    """Recorded from PX4 34160bb6: 3 s at 250 Hz, a step of 2 m."""
    done = run_command("autopilot", "replay", str(DATA / "px4_34160bb6.qcs"))
    assert "the flight is bit-identical to the recorded one" in done.stdout, done.stderr
