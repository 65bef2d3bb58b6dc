#!/usr/bin/env python3
"""Reduce recordings of RotorS' motors: ``scripts/thin_rotors_recordings.py SOURCE``.

SOURCE holds a folder for each flight of a RotorS vehicle in Gazebo 11: ``params.txt``,
``commands.csv`` and ``record.csv.gz``. The vehicles are those of ``urdf``, with the same numbers.
The script writes some rows of the first seconds to ``tests/data/rotors``, and for
``IMU_firefly_base_world`` the errors of the IMU. The output is bit-identical each time.
"""

from __future__ import annotations

import gzip
import shutil
import sys
from pathlib import Path

import numpy as np

TARGET = Path(__file__).resolve().parents[1] / "tests" / "data" / "rotors"

STRIDE = 20  # of the recorded rows
FIRST = 4  # further rows, because all later steps depend on the first
DURATION = 3.0  # s, except for flights with a landing
WHOLE = ("G1_firefly_takeoff_rotorsworld", "G4_iris_takeoff_plain")
DRAWN = "F3_firefly_multisine"  # a figure of the docs uses all its commands
UNIT = "IMU_firefly_base_world"
SAMPLES = 200  # of the IMU, from the first on


def cut(text: str, end: float) -> list[str]:
    """Return the header and the rows up to a time."""
    header, *rows = text.splitlines()
    return [header, *(row for row in rows if float(row.split(",", 1)[0]) <= end + 1e-9)]


def write(path: Path, text: str) -> None:
    """Write a compressed file, bit-identical each time."""
    with open(path, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as packed:
        packed.write(text.encode())


def thin(source: Path, target: Path) -> None:
    """Keep a part of a flight."""
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source / "params.txt", target / "params.txt")
    end = np.inf if source.name in WHOLE else DURATION
    commands = cut((source / "commands.csv").read_text(), np.inf if source.name == DRAWN else end)
    write(target / "commands.csv.gz", "\n".join(commands) + "\n")
    with gzip.open(source / "record.csv.gz", "rt") as stream:
        header, *rows = cut(stream.read(), end)
    kept = [row for i, row in enumerate(rows) if i % STRIDE == 0 or i <= FIRST]
    write(target / "record.csv.gz", "\n".join([header, *kept, rows[-1]]) + "\n")


def thin_unit(source: Path, target: Path) -> None:
    """Keep the errors of the IMU: measured minus true values."""
    rows = np.loadtxt(source / "imu.csv.gz", delimiter=",", skiprows=1)[:SAMPLES]
    errors = rows[:, 1:7] - rows[:, 7:13]
    lines = ["t,ax,ay,az,gx,gy,gz"]
    lines += [",".join(f"{x:.12g}" for x in (t, *row)) for t, row in zip(rows[:, 0], errors)]
    write(target / "imu_errors.csv.gz", "\n".join(lines) + "\n")


def main() -> None:
    """Reduce all recordings."""
    (source,) = map(Path, sys.argv[1:])
    for case in sorted(source.iterdir()):
        if (case / "record.csv.gz").is_file():
            thin(case, TARGET / case.name)
    thin_unit(source / UNIT, TARGET)


if __name__ == "__main__":
    main()
