"""Recordings of real flights: files written from their documentation, and public ones."""

from __future__ import annotations

import gzip
import math
import struct
from pathlib import Path

import numpy as np
import pytest
from processes import run_command, run_refused
from recording_files import (
    make_blackbox,
    make_crazyflie,
    make_ulog,
    write_four,
    write_three,
    write_unsigned,
)

import quadcore as qc
from quadcore.formats.recordings import read_recording, ulog
from quadcore.formats.recordings.bits import ENCODINGS, Reader

REAL = Path(__file__).resolve().parents[1] / "data" / "recordings"


def save(path, data):
    path.write_bytes(data)
    return path


def refusal(path, mapping=None):
    with pytest.raises(qc.InputError) as error:
        read_recording(path, mapping)
    assert "\n" not in str(error.value)
    return str(error.value)


# Crazyflie

EVENTS = {
    0xFFFF: ("fixedFrequency", ["gyro.x(f)", "gyro.y(f)", "gyro.z(f)", "motor.m1(I)"]),
    1: ("modeChanged", ["mode(B)"]),
}


def test_variables_of_each_event_have_their_own_times(tmp_path):
    rows = [(0xFFFF, 1000, (90, 0, 0, 5)), (1, 1500, (3,)), (0xFFFF, 3000, (0, 180, 0, 6))]
    file = save(tmp_path / "log00", make_crazyflie(EVENTS, rows))
    rates = read_recording(file).quantities["rates"]
    assert rates.time == pytest.approx([0, 0.002])
    assert rates.values == pytest.approx(np.radians([[90, 0, 0], [0, 180, 0]]))


def test_a_truncated_crazyflie_log_fails_by_its_checksum(tmp_path):
    data = make_crazyflie(EVENTS, [(0xFFFF, 1000, (1, 2, 3, 4))])
    for wrong in (data[:-1], data[:20], data[:30] + b"?" + data[31:]):
        assert "checksum" in refusal(save(tmp_path / "log00", wrong))


def test_another_version_of_crazyflie_logs_is_refused(tmp_path):
    file = save(tmp_path / "log00", make_crazyflie(EVENTS, [], version=9))
    assert "version 9 of Crazyflie logs is unknown. Use version 2." in refusal(file)


def test_rows_that_contradict_the_header_are_refused(tmp_path):
    broken = make_crazyflie(EVENTS, [(1, 1, (3,))])[:-4] + b"\x07\x00"
    import zlib

    file = save(tmp_path / "log00", broken + struct.pack("<I", zlib.crc32(broken)))
    assert "damaged" in refusal(file)


# ULog

PX4 = {
    "vehicle_local_position": (
        [f"float {name}" for name in ("x", "y", "z", "vx", "vy", "vz")],
        [(10**6, 1, 2, -3, 4, 5, -6), (2 * 10**6, 1, 2, -3, 4, 5, -6)],
    ),
    "vehicle_attitude": (
        ["float[4] q"],
        [(10**6, 1, 0, 0, 0), (2 * 10**6, math.sqrt(0.5), 0, 0, math.sqrt(0.5))],
    ),
    "vehicle_angular_velocity": (["float[3] xyz"], [(10**6, 0.1, 0.2, 0.3)]),
    "unrelated": (["int32_t n"], [(10**6, 7)]),
}


@pytest.mark.parametrize("version, flags", [(0, False), (1, True)])
def test_a_ulog_is_read_in_enu_and_flu(tmp_path, version, flags):
    pytest.importorskip("pyulog")
    recording = read_recording(save(tmp_path / "a.ulg", make_ulog(PX4, version, flags)))
    given = recording.quantities
    assert given["position"].values[0] == pytest.approx([2, 1, 3])
    assert given["velocity"].values[0] == pytest.approx([5, 4, 6])
    assert given["rates"].values[0] == pytest.approx([0.1, -0.2, -0.3], abs=1e-7)
    # Level and pointing north in NED: the body's x axis points along y of ENU, a yaw of 90 degrees;
    # then east: a yaw of 0.
    half = math.sqrt(0.5)
    q = given["orientation"].values
    assert np.abs(q @ [[0, 0], [0, 0], [half, 0], [half, 1]]).diagonal() == pytest.approx([1, 1])


def test_a_ulog_without_the_wanted_topics_is_refused(tmp_path):
    pytest.importorskip("pyulog")
    file = save(tmp_path / "a.ulg", make_ulog({"unrelated": PX4["unrelated"]}))
    assert "none of the columns" in refusal(file)


def test_a_ulog_is_the_same_whole_compressed_and_in_parts(tmp_path, monkeypatch):
    pytest.importorskip("pyulog")
    data = make_ulog(PX4)
    (tmp_path / "b.ulg").write_bytes(gzip.compress(data))
    whole = read_recording(save(tmp_path / "a.ulg", data)).quantities
    others = [read_recording(tmp_path / "b.ulg").quantities]
    for size in (40, 61, 100):  # also within messages
        monkeypatch.setattr(ulog, "_PART", size)
        others.append(read_recording(tmp_path / "a.ulg").quantities)
    for other in others:
        assert list(other) == list(whole)
        for name, (time, values) in other.items():
            assert np.array_equal(time, whole[name].time)
            assert np.array_equal(values, whole[name].values)


def test_a_ulog_that_ends_within_a_message_is_read_with_a_warning(tmp_path):
    pytest.importorskip("pyulog")
    data = make_ulog({name: PX4[name] for name in PX4 if name != "unrelated"})
    with pytest.warns(qc.QuadcoreWarning, match="a.ulg: the ULog ends within a message"):
        given = read_recording(save(tmp_path / "a.ulg", data[:-3])).quantities
    assert len(given["position"].time) == 2 and "rates" not in given


def test_a_damaged_ulog_ends_with_one_line(tmp_path):
    pytest.importorskip("pyulog")
    assert "ULog" in refusal(save(tmp_path / "a.ulg", b"ULog\x01\x12\x35\x01"))


# Blackbox

ROWS = [
    (n, 1000 * n + (7 if n > 5 else 0), n, -40 * n, 0, 1590 - n, 30 * n, -n, 500 - n,
     1200 + n, 1300, 1250 - 9 * n, 1100)
    for n in range(11)
]  # fmt: skip


@pytest.mark.parametrize("header", [(), ("Firmware type:Cleanflight",), ("gyro_scale:0x3f000000",)])
def test_a_blackbox_log_gives_back_the_fields(tmp_path, header):
    file = save(tmp_path / "a.bbl", b"noise" + make_blackbox(ROWS, header=header))
    given = read_recording(file).quantities
    rows = np.array(ROWS, dtype=float)
    assert given["rates"].time == pytest.approx((rows[:, 1] - rows[0, 1]) * 1e-6)
    scale = 0.5 if header and header[0].startswith("gyro") else 1
    assert given["rates"].values == pytest.approx(np.radians(scale * rows[:, 6:9]))
    assert given["commands"].values == pytest.approx((rows[:, 9:13] - 1000) / 1000)
    assert given["battery"].values[:, 0] == pytest.approx(rows[:, 5] / 100)


def test_iterations_follow_the_p_interval(tmp_path):
    from quadcore.formats.recordings.blackbox import read_blackbox

    rows = [(n, *row[1:]) for n, row in zip((0, 2, 4, 6), ROWS)]
    data = make_blackbox(rows, every=8, p_interval="1/2")
    columns = read_blackbox(Path("a.bbl"), data)
    assert columns.stack(["loopIteration"]).values[:, 0].tolist() == [0, 2, 4, 6]


def test_decoding_goes_on_behind_damage(tmp_path):
    data = make_blackbox(ROWS)
    at = data.index(b"I", data.rindex(b"H acc_1G")) + 1
    second = data.index(b"I", at + 3)
    broken = data[: second - 3] + b"\xff\xff\xff" + data[second:]
    with pytest.warns(qc.QuadcoreWarning, match="bytes of the blackbox log are damaged"):
        rates = read_recording(save(tmp_path / "a.bbl", broken)).quantities["rates"]
    assert len(rates.time) == len(ROWS) - 1


@pytest.mark.parametrize(
    "entry",
    [
        "gyro_scale:0xzz", "gyro_scale:0x7f800000", "minthrottle:\N{SUPERSCRIPT TWO}",
        "motorOutput:a,b", "vbatref:1.5", "motor_poles:0", "acc_1G:0",
    ],
)  # fmt: skip
def test_a_damaged_entry_of_a_blackbox_header_is_refused_in_one_line(tmp_path, entry):
    name, _, text = entry.partition(":")
    data = make_blackbox(ROWS, header=[entry]).replace("\N{SUPERSCRIPT TWO}".encode(), b"\xb2")
    message = refusal(save(tmp_path / "a.bbl", data))
    assert f"a.bbl: the header of the blackbox log is damaged: {name} is '{text}'" in message
    assert message.endswith("Download the log again.")


def test_a_truncated_blackbox_log_keeps_its_whole_frames(tmp_path):
    data = make_blackbox(ROWS)
    with pytest.warns(qc.QuadcoreWarning, match="damaged"):
        rates = read_recording(save(tmp_path / "a.bbl", data[:-2])).quantities["rates"]
    assert len(rates.time) == len(ROWS) - 1


def test_a_blackbox_log_without_frames_or_header_is_refused(tmp_path):
    assert "no frame" in refusal(save(tmp_path / "a.bbl", make_blackbox([])))
    cut = make_blackbox(ROWS).partition(b"H Field P encoding")[0]
    assert "header of the blackbox log is damaged" in refusal(save(tmp_path / "b.bbl", cut))


def test_the_longest_of_several_flights_is_read(tmp_path):
    data = make_blackbox(ROWS[:5]) + b"E\xffEnd of log\0" + make_blackbox(ROWS)
    with pytest.warns(qc.QuadcoreWarning, match="2 flights"):
        rates = read_recording(save(tmp_path / "a.bbl", data)).quantities["rates"]
    assert len(rates.time) == len(ROWS)


def test_encodings_match_the_examples_of_the_documentation():
    assert write_unsigned(23456) == b"\xa0\xb7\x01"
    assert Reader(b"\xa0\xb7\x01", 0).read_unsigned() == 23456
    assert [Reader(bytes([n]), 0).read_signed() for n in range(5)] == [0, -1, 1, -2, 2]
    assert ENCODINGS[6](Reader(b"\x14\x08\x10", 0), 5) == [0, 0, 4, 0, 8]
    assert ENCODINGS[8](Reader(b"\x52\x0d\x42", 0), 4) == [13, 0, 4, 2]


@pytest.mark.parametrize("size", [1, 7, 31, 5000, 2**31 - 1])
def test_groups_of_fields_survive_both_ways(size):
    values = [size, -size, size // 2]
    assert ENCODINGS[7](Reader(write_three(values), 0), 3) == values
    if size < 2**15:
        assert ENCODINGS[8](Reader(write_four([*values, 0]), 0), 4) == [*values, 0]


# CSV and mappings

TABLE = "ms,x,y,z,w,a,b,c\n0,1,2,3,1,0,0,0\n\n10,1,2,,1,0,0,0\n20,1,2,3,0.8,0.6,0,0\n"
MAPPING = """\
format: csv
time: {column: ms, unit: ms}
world: NED
position: {columns: [x, y, z], unit: cm}
orientation: {columns: [w, a, b, c], order: wxyz}
"""


def test_a_mapping_converts_units_and_frames(tmp_path):
    (tmp_path / "m.yaml").write_text(MAPPING + "body: FRD\n")
    file = save(tmp_path / "a.csv", TABLE.encode())
    recording = read_recording(file, tmp_path / "m.yaml")
    given = recording.quantities
    assert recording.incomplete == {"position": 1, "orientation": 0}
    assert given["position"].time == pytest.approx([0, 0.02])  # a row has no z
    assert given["position"].values[0] == pytest.approx([0.02, 0.01, -0.03])
    log = qc.Log.of_file(file, tmp_path / "m.yaml")
    assert log.rpy[0] == pytest.approx([0, 0, math.pi / 2], abs=1e-6)
    assert log.rpy[1, 0] == pytest.approx(2 * math.asin(0.6))


@pytest.mark.parametrize(
    "change, message",
    [
        (("unit: cm", "unit: furlong"), "unit 'furlong' is unknown"),
        (("[x, y, z]", "[x, y]"), "2 columns instead of 3"),
        (("[x, y, z]", "[x, y, u]"), "column 'u' does not exist"),
        (("column: ms", "column: us"), "column 'us' of the time does not exist"),
        (("format: csv", "format: ulog"), "maps ulog files"),
        (("position", "positoin"), "Did you mean 'position'"),
        (("world: NED", "world: ECEF"), "world is 'ECEF'. Use one of ENU, NED."),
        (("{columns: [x", "columns: [x"), ":4: this is not YAML"),
        (("unit: cm", "unit: cm, range: [0, 1]"), "position: 'range' is unknown"),
    ],
)
def test_a_wrong_mapping_is_refused(tmp_path, change, message):
    (tmp_path / "m.yaml").write_text(MAPPING.replace(*change))
    assert message in refusal(save(tmp_path / "a.csv", TABLE.encode()), tmp_path / "m.yaml")


def test_a_cell_that_is_no_number_is_refused_with_its_line(tmp_path):
    (tmp_path / "m.yaml").write_text(MAPPING)
    file = save(tmp_path / "a.csv", TABLE.replace("0.6", "six").encode())
    assert "a.csv:5: 'six' is no number." in refusal(file, tmp_path / "m.yaml")


def test_unknown_columns_need_a_mapping(tmp_path):
    assert "--mapping FILE.yaml" in refusal(save(tmp_path / "a.csv", TABLE.encode()))
    assert "mapping 'px5' does not exist" in refusal(
        save(tmp_path / "a.csv", TABLE.encode()), "px5"
    )


def test_time_that_goes_back_is_refused(tmp_path):
    (tmp_path / "m.yaml").write_text(MAPPING)
    file = save(tmp_path / "a.csv", TABLE.replace("20,1", "-5,1").encode())
    assert "goes back" in refusal(file, tmp_path / "m.yaml")


# Bags


def test_topics_of_a_bag_are_mapped(tmp_path):
    pytest.importorskip("rosbags")
    (tmp_path / "m.yaml").write_text(
        "format: bag\n"
        "position: {columns: [/ground_truth/odometry.pose.pose.position.x, "
        "/ground_truth/odometry.pose.pose.position.y, "
        "/ground_truth/odometry.pose.pose.position.z], unit: m}\n"
    )
    log = qc.Simulation("quadrotor", engine="eigen").run(0.1, log_every=10)
    log.to_file(tmp_path / "a.bag")
    position = read_recording(tmp_path / "a.bag", tmp_path / "m.yaml").quantities["position"]
    assert position.values == pytest.approx(log.position)
    assert position.time == pytest.approx(log.time, abs=1e-6)


# Public data


def test_shipped_mappings_read_the_public_excerpts():
    nanobench = read_recording(REAL / "nanobench/rep4_excerpt.csv.gz").quantities
    assert set(nanobench) >= {"position", "orientation", "rates", "acceleration", "commands"}
    assert np.median(nanobench["acceleration"].values[:, 2]) == pytest.approx(9.81, abs=0.3)
    # The gyro agrees with the derivative of the mocap's orientation.
    log = qc.Log.of_file(REAL / "nanobench/rep4_excerpt.csv.gz")
    from quadcore.formats.recordings.as_log import differentiate_orientation

    of_pose = differentiate_orientation(log.time, log.orientation)
    for axis in range(2):
        assert np.corrcoef(of_pose[:, axis], log.angular_velocity[:, axis])[0, 1] > 0.5
    arplab = read_recording(REAL / "arplab/log15_excerpt.gz").quantities
    assert np.median(np.diff(arplab["rates"].time)) == pytest.approx(1e-3, rel=0.05)
    assert 0 < arplab["commands"].values.min() < arplab["commands"].values.max() <= 1
    crazypad = read_recording(next((REAL / "crazypad").glob("cut*"))).quantities
    squares = np.mean(crazypad["commands"].values ** 2, axis=0)
    assert 1.6 < squares[2] / np.mean(squares[[0, 1, 3]]) < 1.9  # motor 3 works harder


def test_a_recording_without_a_pose_is_no_log():
    with pytest.raises(qc.InputError, match="has no position, but only rates"):
        qc.Log.of_file(REAL / "arplab/log15_excerpt.gz")


def test_a_damaged_compressed_file_ends_with_one_line(tmp_path):
    data = gzip.compress(TABLE.encode() * 100)
    assert "compressed file is damaged" in refusal(save(tmp_path / "a.csv.gz", data[:-20]))


def test_commands_read_recordings(tmp_path):
    recording = REAL / "nanobench/rep4_excerpt.csv.gz"
    run_command("convert", recording, tmp_path / "a.csv")
    log, again = qc.Log.of_file(recording), qc.Log.of_file(tmp_path / "a.csv")
    assert np.array_equal(log.table, again.table)
    assert "motors" in again.topics
    run_command("play", recording, "-o", tmp_path / "a.html")
    assert (tmp_path / "a.html").stat().st_size > 10_000
    run_command("plot", recording, "--mapping", "nanobench", "--out", tmp_path / "plots", "--quiet")
    assert list((tmp_path / "plots").glob("*.png"))
    said = run_refused("plot", recording, "--mapping", "px4", "--out", tmp_path / "plots")
    assert "maps ulog files" in said
