"""References through vectors of MATLAB files."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io

import quadcore as qc
from quadcore.control import references

ROWS = np.array([[0, 0, 0, 10, 0.3], [2, 1, -0.5, 11, 0.1], [4, 2, 0, 10.5, -0.2]])
VECTORS = dict(zip(("t", "x", "y", "z", "yaw"), ROWS.T))


@pytest.mark.parametrize("kind", ["waypoints", "series"])
@pytest.mark.parametrize("width", [4, 5])
def test_vectors_are_rows_and_a_yaw_among_them_is_flown(kind, width, tmp_path):
    file = tmp_path / "path.mat"
    held = dict(list(VECTORS.items())[:width])
    scipy.io.savemat(file, {**held, "comment": "of the measurement", "w1": 3.0})
    read = references.parse(f"{kind}:{file}")
    assert np.array_equal(read.rows, ROWS[:, :width])
    meant = getattr(references, kind)(ROWS[:, :width])
    assert np.array_equal(read(2).position, meant(2).position)
    assert read(2).yaw == meant(2).yaw == pytest.approx(0.1 if width == 5 else 0)


@pytest.mark.parametrize(
    ("held", "says"),
    [
        ({"t": [0, 1], "x": [0, 1], "y": [0, 1]}, r"contains t, x, y\. Save t, x, y, z\[, yaw\]"),
        ({}, r"contains no variables\. Save t, x, y, z\[, yaw\]"),
        ({**VECTORS, "yaw": [0, 1]}, "path.mat: yaw has 2 values, t has 3"),
        ({**VECTORS, "z": "high"}, "path.mat: z is no vector of real numbers"),
    ],
)
def test_a_value_that_is_no_path_is_refused(held, says, tmp_path):
    scipy.io.savemat(tmp_path / "path.mat", held)
    with pytest.raises(qc.InputError, match=says):
        references.parse(str(tmp_path / "path.mat"))


def test_files_of_other_kinds_are_refused_with_the_kinds_that_are_read(tmp_path):
    with pytest.raises(qc.InputError, match=r"p.txt: paths are read from .csv, .mat, .yaml, .yml"):
        references.waypoints(tmp_path / "p.txt")
