"""Commands, paths and logs in whatever way MATLAB, Simulink and Octave leave them."""

import shutil
import subprocess

import numpy as np
import pytest
import scipy.io

import quadcore as qc
from quadcore.control import references
from quadcore.formats.mat import LAYOUTS
from quadcore.simulation.commands import read_commands

TABLE = np.array([[0.0, 480, -470], [0.25, 490, -480], [1.0, 470, -490.5]])
T, W1, W2 = (TABLE[:, [i]] for i in range(3))


def signal(values, **more):
    return {"values": values, "label": "speeds", "dimensions": float(values.shape[-1]), **more}


def two_signals():
    signals = np.empty((1, 2), dtype=[("values", object), ("label", object)])
    signals[0, 0], signals[0, 1] = (W1, "a"), (W2, "b")
    return signals


HELD = {
    "vectors": {"t": T, "w1": W1, "w2": W2.T},
    "a matrix": {"anything": TABLE},
    "a matrix beside a number": {"anything": TABLE, "dt": 0.1, "note": "of a flight"},
    "a struct": {"s": {"t": T, "w1": W1, "w2": W2}},
    "time and signals": {"out": {"time": T, "signals": signal(TABLE[:, 1:])}},
    "a signal for each": {"out": {"time": T, "signals": two_signals(), "blockName": "m/s"}},
    "vector signals": {"out": {"time": T, "signals": signal(TABLE[:, 1:].T.reshape(2, 1, 3))}},
    "a timeseries": {"ts": {"Time": T, "Data": TABLE[:, 1:], "Name": "speeds"}},
}


@pytest.mark.parametrize("version", ["4", "5"])
@pytest.mark.parametrize("held", HELD)
def test_commands_are_read_however_they_are_held(held, version, tmp_path):
    if version == "4" and any(isinstance(value, dict) for value in HELD[held].values()):
        pytest.skip("version 4 has no structs")
    scipy.io.savemat(tmp_path / "c.mat", HELD[held], format=version, do_compression=version == "5")
    np.testing.assert_array_equal(read_commands(tmp_path / "c.mat", 2), TABLE)


def test_one_row_is_a_command_that_is_held(tmp_path):
    path = tmp_path / "c.mat"
    for held in (
        {"hover": TABLE[:1]},
        {"t": 0.0, "w1": 480.0, "w2": -470.0},
        {"s": {"t": 0.0, "w1": 480.0, "w2": -470.0}},
    ):
        scipy.io.savemat(path, held)
        np.testing.assert_array_equal(read_commands(path, 2), TABLE[:1])
    for held in (
        {"t": TABLE[:1]},
        {"turned": TABLE[:1].T},
        {"a": TABLE[:1], "b": TABLE[:1]},
        {"text": "abc"},
    ):
        scipy.io.savemat(path, held)
        with pytest.raises(qc.InputError, match="save t, w1, w2, or one matrix or struct of them"):
            read_commands(path, 2)


def write_73(path, held):
    """As MATLAB does: columns first, structs as groups, arrays of structs by reference."""
    h5py = pytest.importorskip("h5py")

    def put(group, name, value, file):
        if isinstance(value, dict):
            inner = group.create_group(name)
            inner.attrs["MATLAB_class"] = np.bytes_(b"struct")
            for field, part in value.items():
                put(inner, field, part, file)
        elif isinstance(value, str):
            data = group.create_dataset(name, data=np.array([[ord(c)] for c in value], "u2"))
            data.attrs["MATLAB_class"] = np.bytes_(b"char")
        elif getattr(value, "dtype", None) is not None and value.dtype.names:
            inner = group.create_group(name)
            for field in value.dtype.names:
                references = []
                for i, part in enumerate(value[field].flat):
                    place = f"{name}{field}{i}"
                    put(file.require_group("#refs#"), place, part, file)
                    references.append(file["#refs#"][place].ref)
                inner.create_dataset(field, data=np.array([references], h5py.ref_dtype).T)
        else:
            data = group.create_dataset(name, data=np.atleast_2d(value).astype(float).T)
            data.attrs["MATLAB_class"] = np.bytes_(b"double")

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in held.items():
            put(file, name, value, file)


@pytest.mark.parametrize("held", HELD)
def test_commands_of_version_7_3_are_read(held, tmp_path):
    write_73(tmp_path / "c.mat", HELD[held])
    np.testing.assert_array_equal(read_commands(tmp_path / "c.mat", 2), TABLE)


def test_without_h5py_the_remedies_are_named(tmp_path, monkeypatch):
    write_73(tmp_path / "c.mat", HELD["vectors"])
    monkeypatch.setitem(__import__("sys").modules, "quadcore.formats.mat_73", None)
    with pytest.raises(
        qc.InputError, match=r"7\.3 file \(or save it .* -v7\) .*quadcore\[matlab\]"
    ):
        read_commands(tmp_path / "c.mat", 2)


OCTAVE = """
t = [0; 0.25; 1]; w1 = [480; 490; 470]; w2 = [-470; -480; -490.5];
m = [t w1 w2]; s.t = t; s.w1 = w1; s.w2 = w2; g.time = t; g.signals.values = [w1 w2];
g.signals.label = 'speeds';
save -v6 a.mat t w1 w2; save -v7 b.mat m; save -v7 c.mat s; save -v6 d.mat g; save -v4 e.mat m;
save -hdf5 f.mat m; save -hdf5 g.mat s; save -hdf5 h.mat g; save text.mat m
"""


@pytest.mark.skipif(shutil.which("octave-cli") is None, reason="needs Octave: apt install octave")
def test_what_octave_saves_is_read_and_its_text_refused_with_the_remedy(tmp_path):
    ran = subprocess.run(
        ["octave-cli", "--norc", "--quiet", "--eval", OCTAVE], cwd=tmp_path, capture_output=True
    )
    assert ran.returncode == 0, ran.stderr
    for name in "abcdefgh":
        read = read_commands(tmp_path / f"{name}.mat", 2)
        np.testing.assert_array_equal(read, TABLE, err_msg=name)
    with pytest.raises(qc.InputError, match=r"is a text file of Octave\. Save it with"):
        read_commands(tmp_path / "text.mat", 2)


@pytest.mark.parametrize(
    ("held", "says"),
    [
        (
            {"a": TABLE, "b": TABLE},
            "contains a, b. For 2 rotors, save t, w1, w2, or one m",
        ),
        ({"a": TABLE[:, :2]}, "a is an array of 3x2 float64. For 2 rotors, save"),
        ({"a": np.hstack([TABLE, W1])}, "a is an array of 3x4 float64. For 2 rotors"),
        ({"s": {"t": T, "w1": W1}}, "s is a struct of t, w1. For 2 rotors"),
        ({"s": {"t": T, "w1": W1, "w2": W2, "w3": W2}}, "s contains t, w1, w2, w3. For 2 rotors"),
        ({"s": {"t": T, "w1": W1, "w2": W2[:2]}}, "w2 has 2 values, t has 3"),
        ({"s": {"time": T, "signals": {"label": "a"}}}, "s is a struct of time, signals. For"),
        ({"s": {"time": T, "signals": signal(TABLE[:2, 1:])}}, "s is a struct of time, signals"),
        ({"a": TABLE.astype(complex) * 1j}, "a is an array of 3x3 complex128. For 2 rotors"),
        ({"a": "text"}, "contains a. For 2 rotors, save"),
    ],
)
def test_a_variable_that_is_no_table_is_refused(held, says, tmp_path):
    scipy.io.savemat(tmp_path / "c.mat", held)
    with pytest.raises(qc.InputError, match=says):
        read_commands(tmp_path / "c.mat", 2)


def test_a_path_is_read_from_a_matrix_and_from_signals(tmp_path):
    rows = np.array([[0, 0, 0, 10, 0.3], [2, 1, -0.5, 11, 0.1], [4, 2, 0, 10.5, -0.2]])
    for name, held in (
        ("m", {"way": rows}),
        ("s", {"way": {"time": rows[:, [0]], "signals": signal(rows[:, 1:])}}),
        ("four", {"way": rows[:, :4]}),
    ):
        scipy.io.savemat(tmp_path / f"{name}.mat", held)
        read = references.parse(f"series:{tmp_path / name}.mat").rows
        np.testing.assert_array_equal(read, rows[:, : read.shape[1]])


@pytest.fixture(scope="module")
def log():
    simulation = qc.Simulation("quadrotor", "eigen", parameters={"odometry.rate": 250})
    flown = simulation.run(0.05, [[0, 480, -470, 490, -475]], topics=["odom"], wrenches=True)
    flown.ignored.append("libcamera.so")
    return flown


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_log_comes_back_from_each_layout_bit_for_bit(layout, log, tmp_path):
    log.to_mat(tmp_path / "log.mat", layout)
    read = qc.Log.of_file(tmp_path / "log.mat")
    np.testing.assert_array_equal(read.table, log.table)
    np.testing.assert_array_equal(read.wrenches["thrust"], log.wrenches["thrust"])
    assert list(read.wrenches) == list(log.wrenches) and read.ignored == log.ignored
    for field, column in log.topics["odom"].items():
        np.testing.assert_array_equal(read.topics["odom"][field], column)


def test_a_bare_matrix_is_a_log_if_it_has_its_columns(log, tmp_path):
    scipy.io.savemat(tmp_path / "log.mat", {"log": log.table})
    np.testing.assert_array_equal(qc.Log.of_file(tmp_path / "log.mat").table, log.table)


def test_a_layout_that_there_is_not_is_refused(log, tmp_path):
    with pytest.raises(qc.InputError, match="layout 'table' does not exist"):
        log.to_mat(tmp_path / "log.mat", "table")
    assert not (tmp_path / "log.mat").exists()


@pytest.mark.parametrize(
    ("held", "says"),
    [
        ({"wrench_thrust": np.zeros((3, 5))}, "wrench_thrust is not a matrix of 6 columns"),
        ({"wrench_thrust": np.zeros((2, 6))}, "wrench_thrust has 2 rows, the log 3"),
        ({"wrench_thrust": "text"}, "wrench_thrust is not a matrix of 6 columns"),
        ({"log": np.zeros((3, 5))}, "log has 5 columns, 14 are named"),
        ({"log": {"time": [0, 1], "signals": {"values": [1, 2]}}}, "give each a label and values"),
        ({"log": {"time": [0, 1], "signals": 3}}, "give each a label and values"),
    ],
)
def test_a_file_that_is_no_log_is_refused(held, says, log, tmp_path):
    of_three = {name: column[:3] for name, column in zip(log.columns, log.table.T)}
    scipy.io.savemat(tmp_path / "odd.mat", {**({} if "log" in held else of_three), **held})
    with pytest.raises(qc.InputError, match=says):
        qc.Log.of_file(tmp_path / "odd.mat")
