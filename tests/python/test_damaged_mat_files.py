"""MATLAB files whose bytes are not what a writer meant: each is read, or refused in one line."""

import struct
import subprocess
import sys

import numpy as np
import pytest
import scipy.io

import quadcore as qc
from quadcore.formats.mat_variables import load

T = np.arange(3.0)
CELL = np.array(["one", "two"], dtype=object)
HELD = {
    "vectors": {"t": T, **{f"w{i}": T for i in range(1, 5)}},
    "nested": {"s": {"a": T, "b": "text"}, "c": CELL, "z": T * 1j},
}


def save(path, held, **how):
    scipy.io.savemat(path, held, **how)
    return path.read_bytes()


@pytest.mark.parametrize(
    ("held", "how"),
    [
        ("vectors", {"format": "5"}),
        ("vectors", {"format": "5", "do_compression": True}),
        ("vectors", {"format": "4"}),
        ("nested", {"format": "5"}),
    ],
)
def test_a_file_with_one_changed_byte_is_read_or_refused_in_one_line(held, how, tmp_path):
    path = tmp_path / "c.mat"
    data = save(path, HELD[held], **how)
    refused = 0
    for place, byte in enumerate(data):
        for value in {0, 255, byte ^ 1, byte ^ 2, byte ^ 8, byte ^ 128} - {byte}:
            path.write_bytes(data[:place] + bytes([value]) + data[place + 1 :])
            try:
                load(path, list)
            except qc.InputError as error:
                refused += 1
                assert str(error).startswith(f"{path}: ") and "\n" not in str(error)
    assert refused > len(data) / 2


@pytest.mark.parametrize("command", ["plot", "run"])
def test_a_damaged_file_ends_a_command_with_one_line(command, tmp_path):
    path = tmp_path / "c.mat"
    data = save(path, HELD["vectors"])
    damaged = data.replace(struct.pack("<2I", 9, 24), struct.pack("<2I", 9, 2**31), 1)
    assert damaged != data
    path.write_bytes(damaged)
    words = {"plot": ["plot", path], "run": ["run", "quadrotor", "--commands", path]}[command]
    ran = subprocess.run(
        [sys.executable, "-m", "quadcore", *map(str, words)], capture_output=True, text=True
    )
    assert ran.returncode == 2
    assert ran.stderr.count("\n") == 1 and "c.mat: not a MATLAB file: an element" in ran.stderr


@pytest.mark.parametrize("is_compressed", [False, True])
@pytest.mark.parametrize(
    "kind", ["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "c16", "?"]
)
def test_numbers_of_each_type_are_read_as_written(kind, is_compressed, tmp_path):
    values = np.arange(24).reshape(2, 3, 4).astype(kind)
    save(tmp_path / "c.mat", {"v": values}, do_compression=is_compressed)
    np.testing.assert_array_equal(load(tmp_path / "c.mat", list)["v"], values)


def test_texts_cells_and_structs_are_read_as_written(tmp_path):
    array = np.array([[(1.0, "a"), (2.0, "b")]], dtype=[("x", object), ("name", object)])
    held = {"text": "ä€", "cell": CELL, "one": {"a": {"b": T}}, "several": array, "none": []}
    save(tmp_path / "c.mat", held, do_compression=True)
    read = load(tmp_path / "c.mat", list)
    assert read["text"] == "ä€" and read["cell"] == ["one", "two"] and read["none"].size == 0
    np.testing.assert_array_equal(read["one"]["a"]["b"], [T])
    assert [row["name"] for row in read["several"]] == ["a", "b"]


def test_the_other_byte_order_is_read(tmp_path):
    path = tmp_path / "c.mat"
    elements = struct.pack(">2I2I", 6, 8, 6, 0) + struct.pack(">2I2i", 5, 8, 3, 1)
    elements += struct.pack(">HH4s", 1, 1, b"t") + struct.pack(">2I3d", 9, 24, *T)
    head = b"MATLAB 5.0".ljust(124) + b"\1\0MI" + struct.pack(">2I", 14, len(elements))
    path.write_bytes(head + elements)
    np.testing.assert_array_equal(load(path, list)["t"].ravel(), T)


def test_a_few_compressed_bytes_do_not_fill_the_memory(tmp_path):
    save(tmp_path / "c.mat", {"t": np.zeros(2 * 10**7)}, do_compression=True)
    with pytest.raises(qc.InputError, match="t has 20000000 values, more than 10000000"):
        load(tmp_path / "c.mat", list)


def test_cells_nested_without_end_are_refused(tmp_path):
    cell = np.zeros(1)
    for _ in range(40):
        outer = np.empty(1, dtype=object)
        outer[0] = cell
        cell = outer
    save(tmp_path / "c.mat", {"c": cell})
    with pytest.raises(qc.InputError, match="nested deeper than 32 levels"):
        load(tmp_path / "c.mat", list)


def test_sparse_matrices_are_refused_by_name(tmp_path):
    sparse = pytest.importorskip("scipy.sparse")
    save(tmp_path / "c.mat", {"t": sparse.csc_matrix(np.eye(3)), "x": T, "y": T, "z": T})
    with pytest.raises(qc.InputError, match="t is no vector of real numbers"):
        qc.references.parse(str(tmp_path / "c.mat"))
