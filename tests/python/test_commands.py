"""Open-loop commands from files and arrays."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from quadcore import InputError
from quadcore.simulation.commands import check_commands, read_commands

TABLE = np.array([[0.0, 1.0, -2.0], [0.5, 3.0, -4.0]])


@pytest.fixture
def csv(tmp_path):
    """Write lines into a CSV file and return its path."""

    def write(*lines):
        path = tmp_path / "c.csv"
        path.write_text("\n".join(lines))
        return path

    return write


@st.composite
def tables(draw):
    rows, rotors = draw(st.integers(1, 8)), draw(st.integers(1, 6))
    finite = st.floats(allow_nan=False, allow_infinity=False)
    times = sorted(draw(st.sets(st.floats(0, 1e6), min_size=rows, max_size=rows)))
    return np.column_stack([times, draw(hnp.arrays(float, (rows, rotors), elements=finite))])


@given(table=tables())
def test_csv_commands_come_back_bit_for_bit(tmp_path_factory, table):
    path = tmp_path_factory.mktemp("csv") / "c.csv"
    header = ",".join(["t"] + [f"w{i}" for i in range(1, table.shape[1])])
    np.savetxt(path, table, "%.17g", ",", header=header, comments="")
    assert read_commands(path, table.shape[1] - 1).tobytes() == table.tobytes()


@pytest.mark.parametrize("shape", [(2,), (2, 1), (1, 2)])
def test_mat_vectors_of_any_orientation_are_read(tmp_path, shape):
    names = ("t", "w1", "w2")
    columns = {name: column.reshape(shape) for name, column in zip(names, TABLE.T)}
    scipy.io.savemat(tmp_path / "c.mat", columns)
    assert np.array_equal(read_commands(tmp_path / "c.mat", 2), TABLE)


def test_blanks_and_a_byte_order_mark_do_not_matter(csv):
    assert np.array_equal(
        read_commands(csv("\ufefft, w1, w2", "0, 1,-2", "0.5,3,-4", ""), 2), TABLE
    )


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (("t,w1", "0,1"), ":1: the header is 't,w1'"),
        (("0,1,2",), ":1: the header"),
        ((), ":1: the header"),
        (("t,w1,w2", "0,1,2", "1,2"), ":3: 2 columns instead of 3"),
        (("t,w1,w2", "0,1,2", "", "1,2,3"), ":3: 1 columns instead of 3"),
        (("t,w1,w2", "0,one,2"), ":2: column 'w1' contains 'one'. Write a number such as -471.5.$"),
        (("t,w1,w2", "0,1,2", "1,2, "), ":3: column 'w2' contains ''. Write a number"),
        (("t,w1,w2", "1_0,1,2"), ":2: column 't' contains '1_0'. Write a number"),
        (("t,w1,w2", "0,1,\u0662"), ":2: column 'w2' contains '\u0662'. Write a number"),
        (("t,w1,w2", "0,1,nan"), ":2: w2 is nan"),
        (("t,w1,w2", "0,1,2", "0.1,-inf,2"), ":3: w1 is -inf"),
        (("t,w1,w2", "0,1,2", "1,1,2", "1,1,2"), ":4: t = 1 is not later than 1"),
        (("t,w1,w2",), ": holds no commands"),
    ],
)
def test_a_fault_in_a_csv_file_names_file_and_line(csv, lines, message):
    path = csv(*lines)
    with pytest.raises(InputError, match=message) as refused:
        read_commands(path, 2)
    assert str(refused.value).startswith(f"{path}:")


@pytest.mark.parametrize(
    ("variables", "message"),
    [
        ({"t": [0, 1], "w1": [1, 2]}, "save t, w1, w2"),
        ({"t": [0], "w1": [1], "w2": [1], "w3": [1]}, "save t, w1, w2"),
        ({"t": [0, 1], "w1": [1, 2], "w2": [1]}, "w2 has 1 values, t has 2"),
        ({"t": [0, 1], "w1": [1, 2], "w2": [1, np.nan]}, "row 2: w2 is nan"),
        ({"t": [1, 0], "w1": [1, 2], "w2": [1, 2]}, "row 2: t = 0 is not later than 1"),
        ({"t": [0, 1], "w1": [1, 2], "w2": np.eye(2)}, "w2 is no vector"),
        ({"t": [0], "w1": [1j], "w2": [1]}, "w1 is no vector of real numbers"),
        ({"t": [0], "w1": "text", "w2": [1]}, "w1 is no vector of real numbers"),
    ],
)
def test_a_fault_in_a_mat_file_names_the_variable(tmp_path, variables, message):
    path = tmp_path / "c.mat"
    scipy.io.savemat(path, variables)
    with pytest.raises(InputError, match=message):
        read_commands(path, 2)


def test_files_that_are_missing_or_of_another_kind_are_refused(tmp_path):
    (tmp_path / "text.mat").write_text("no matlab file")
    (tmp_path / "c.txt").write_text("t,w1")
    for name, message in (
        ("nope.csv", "cannot be read: No such file"),
        ("nope.mat", "cannot be read: No such file"),
        ("text.mat", "not a MATLAB file"),
        ("c.txt", "read from .csv, .mat, .bag"),
    ):
        with pytest.raises(InputError, match=message):
            read_commands(tmp_path / name, 1)


def test_arrays_and_paths_are_taken_alike(csv):
    path = csv("t,w1,w2", "0,1,-2", "0.5,3,-4")
    for commands in (TABLE, TABLE.tolist(), path, str(path), np.asfortranarray(TABLE)):
        checked = check_commands(commands, 2)
        assert np.array_equal(checked, TABLE)
        assert checked.flags.c_contiguous


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (TABLE[:, :2], r"shape \(2, 2\).*Give \(rows, 3\)"),
        (TABLE[0], r"shape \(3,\)"),
        ([[0, 1], [1]], "not a table of numbers"),
        ([[0, 1, np.inf]], "row 0: w2 is inf"),
        (TABLE[::-1], "row 1: t = 0 is not later than 0.5"),
        (TABLE[:0], "holds no commands"),
    ],
)
def test_a_wrong_array_is_refused(array, message):
    with pytest.raises(InputError, match=message):
        check_commands(array, 2)
