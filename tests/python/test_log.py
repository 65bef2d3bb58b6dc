"""The log of a flight and the files made from it."""

from __future__ import annotations

import base64
import re
import sys

import numpy as np
import pytest
import scipy.io
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from quadcore import InputError, Log
from quadcore.simulation.log import check_log_path
from quadcore.support.rotation import to_roll_pitch_yaw

COLUMNS = "t,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,j1,j2,j3,j4"
WRENCH = ("fx", "fy", "fz", "tx", "ty", "tz")


@pytest.fixture
def log():
    """A second of a turn, four rotors, two wrenches of which one is zero."""
    time = np.linspace(0, 1, 101)
    table = np.random.default_rng(1).normal(size=(101, 18))
    table[:, 0] = time
    table[:, 4:8] = np.stack([0 * time, 0 * time, np.sin(2 * time), np.cos(2 * time)], axis=1)
    wrenches = {"thrust": np.tile(np.arange(6.0), (101, 1)), "flapping": np.zeros((101, 6))}
    return Log(table, wrenches, "quadrotor, gazebo11")


@given(table=hnp.arrays(float, st.tuples(st.integers(1, 5), st.integers(14, 20))))
def test_a_csv_log_comes_back_bit_for_bit(tmp_path_factory, table):
    table = np.where(np.isnan(table), np.nan, table)  # which of the many nan is not kept
    path = tmp_path_factory.mktemp("log") / "log.csv"
    Log(table, {}).to_csv(path)
    back = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    assert np.array_equal(back.view("u8"), table.view("u8"))


def test_the_csv_header_names_the_columns(log, tmp_path):
    header = COLUMNS
    for wrenches in ({}, log.wrenches):
        header += "".join(f",wrench_{name}.{field}" for name in wrenches for field in WRENCH)
        Log(log.table, wrenches).to_csv(tmp_path / "log.csv")
        assert (tmp_path / "log.csv").read_text().split("\n")[0] == header
    assert ",".join(log.columns) == COLUMNS


def test_equal_logs_make_equal_csv_bytes(log, tmp_path):
    log.to_csv(tmp_path / "a.csv")
    Log(log.table.copy(), log.wrenches).to_csv(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_a_mat_log_holds_each_column_and_each_wrench(log, tmp_path):
    log.to_file(tmp_path / "log.mat")
    variables = scipy.io.loadmat(tmp_path / "log.mat")
    for i, name in enumerate(log.columns):
        assert np.array_equal(variables[name], log.table[:, i : i + 1])
    for name, wrench in log.wrenches.items():
        assert np.array_equal(variables[f"wrench_{name}"], wrench)


def test_properties_are_views_of_the_table(log):
    parts = (
        log.position,
        log.orientation,
        log.linear_velocity,
        log.angular_velocity,
        log.rotor_velocity,
    )
    assert np.array_equal(np.column_stack([log.time, *parts]), log.table)
    assert all(np.shares_memory(part, log.table) for part in (log.time, *parts))


def test_a_file_that_cannot_be_written_is_refused_before_and_after_the_flight(log, tmp_path):
    (tmp_path / "folder.csv").mkdir()
    for name in ("nowhere/log.csv", "folder.csv", "log.txt", "log"):
        with pytest.raises(InputError, match=name):
            check_log_path(tmp_path / name)
        with pytest.raises(InputError, match=name):
            log.to_file(tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.csv"]


def test_checking_a_path_leaves_it_as_it_is(tmp_path):
    old = tmp_path / "log.csv"
    old.write_text("old")
    check_log_path(old)
    check_log_path(tmp_path / "new.mat")
    assert list(tmp_path.iterdir()) == [old]
    assert old.read_text() == "old"


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(log, tmp_path, monkeypatch, failure):
    def fail(*_, **__):
        raise failure

    old = tmp_path / "log.csv"
    old.write_text("old")
    monkeypatch.setattr("quadcore.formats.csv.csv_rows", fail)
    with pytest.raises((InputError, KeyboardInterrupt)):
        log.to_csv(old)
    assert list(tmp_path.iterdir()) == [old]
    assert old.read_text() == "old"


def test_plots_are_written_and_the_same_for_the_same_flight(log, tmp_path):
    first = log.plot(tmp_path / "a")
    again = log.plot(tmp_path / "b")
    names = ["position", "attitude", "rates", "rotors", "wrenches", "path"]
    assert first == [tmp_path / "a" / f"{name}.png" for name in names]
    assert [a.read_bytes() for a in first] == [b.read_bytes() for b in again]


def test_a_log_of_one_row_can_be_plotted(log, tmp_path):
    one = Log(log.table[:1], {name: wrench[:1] for name, wrench in log.wrenches.items()})
    assert all(path.stat().st_size for path in one.plot(tmp_path))


def test_plots_into_a_file_are_refused(log, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot be made"):
        log.plot(tmp_path / "file")


@given(st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1)))
def test_angles_come_back_from_the_product_of_the_three_turns(angles):
    def times(a, b):
        return np.append(
            a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3]), a[3] * b[3] - a[:3] @ b[:3]
        )

    roll, pitch, yaw = (
        np.append(np.sin(angle / 2) * axis, np.cos(angle / 2))
        for angle, axis in zip(angles, np.eye(3))
    )
    assert to_roll_pitch_yaw(times(yaw, times(pitch, roll))) == pytest.approx(angles, abs=1e-9)


@pytest.mark.parametrize("suffix", [".csv", ".mat"])
def test_a_log_file_is_read_back_bit_for_bit(log, tmp_path, suffix):
    stamped = {"odom": {"x": np.sqrt(log.time), "y": np.where(log.time < 0.5, np.nan, log.time)}}
    kept = Log(log.table, log.wrenches, ignored=["libcamera.so", "a b"], topics=stamped)
    kept.to_file(tmp_path / f"log{suffix}")
    back = Log.of_file(tmp_path / f"log{suffix}")
    assert back.columns == log.columns and np.array_equal(back.table, log.table)
    assert back.ignored == kept.ignored
    assert list(back.topics) == ["odom"]
    for field, values in stamped["odom"].items():
        assert np.array_equal(back.topics["odom"][field], values, equal_nan=True)
    assert list(back.wrenches) == list(log.wrenches)
    for name, wrench in log.wrenches.items():
        assert np.array_equal(back.wrenches[name], wrench)


@pytest.mark.parametrize("suffix", [".csv", ".mat"])
def test_a_log_whose_orientation_is_none_is_refused(log, tmp_path, suffix):
    log.table[3, 4:8] = 0
    file = tmp_path / f"log{suffix}"
    getattr(log, f"to_{suffix[1:]}")(file)
    with pytest.raises(InputError, match="the orientation is no unit quaternion"):
        Log.of_file(file)


def test_a_column_goes_by_its_name_in_the_csv_file(log, tmp_path):
    topics = {"odom": {"x": log.time + 1}}
    whole = Log(log.table, log.wrenches, topics=topics)
    whole.to_csv(tmp_path / "log.csv")
    header = (tmp_path / "log.csv").read_text().split("\n")[0].split(",")
    written = np.loadtxt(tmp_path / "log.csv", delimiter=",", skiprows=1)
    for name, column in zip(header, written.T):
        assert np.array_equal(whole[name], column), name
    assert list(whole.to_dict()) == header
    with pytest.raises(InputError, match="Did you mean 'j1'"):
        whole["j11"]


def test_a_data_frame_has_the_columns_of_the_csv_file(log):
    frame = log.to_dataframe()
    assert frame.index.name == "t"
    assert np.array_equal(frame.index, log.time)
    for name in frame.columns:
        assert np.array_equal(frame[name], log[name])
    assert set(frame.columns) == set(log.to_dict()) - {"t"}


def test_without_pandas_a_line_says_what_to_install(log, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r"pip install 'quadcore\[pandas\]'"):
        log.to_dataframe()


def test_the_angles_are_those_of_the_rotation_about_z_then_y_then_x(log):
    whole = Rotation.from_quat(log.orientation).as_euler("ZYX")[:, ::-1]
    assert np.allclose(log.rpy, whole)


def test_a_notebook_shows_a_log_as_a_picture_in_the_page_itself(log):
    shown = log._repr_html_()
    assert "101 rows" in shown
    assert base64.b64decode(re.search(r"base64,([^\"]+)", shown).group(1)).startswith(b"\x89PNG")
