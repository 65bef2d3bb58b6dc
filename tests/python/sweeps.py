"""What tests of sweeps share."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import quadcore as qc

MASS = {"frame.mass": "uniform:0.9:1.1"}


def sweep(vary=MASS, **options):
    """Run a small sweep, in local processes by default."""
    given = {"duration": 0.5, "samples": 12, "xacro_args": {"sim_slow": 1}, **options}
    return qc.sweep("geometric", "circle", vary, **given)


def lines(folder):
    return (Path(folder) / "table.csv").read_bytes().splitlines()


def rows(folder):
    with (Path(folder) / "table.csv").open() as stream:
        return list(csv.DictReader(stream))


def ishigami(point):
    """Ishigami and Homma, 1990, with the usual 7 and 0.1."""
    x1, x2, x3 = (point[f"x{i}"] for i in (1, 2, 3))
    return math.sin(x1) + 7 * math.sin(x2) ** 2 + 0.1 * x3**4 * math.sin(x1)
