#!/usr/bin/env python3
"""Reduce recordings of Gazebo 11 to the rows that the tests need.

``scripts/thin_recordings.py SOURCE``: SOURCE holds flights ``S*.csv.gz`` of the built-in
quadrotor with their ``commands_S*.csv``, a folder ``cases/NAME`` for each flight of another model
or world, ``random/NAME`` for random vehicles, and ``obstacles/NAME`` for contact with obstacles,
with ``obstacles/summary.csv``. A folder has ``model.urdf``, ``case.world``,
``commands.csv``, ``params.txt``, ``record.csv.gz`` and Gazebo's conversion ``model.sdf``. The
script copies all of it to ``tests/data/gazebo11``, with only some rows of the recordings. The
output is bit-identical each time.
"""

from __future__ import annotations

import gzip
import shutil
import sys
from pathlib import Path

TARGET = Path(__file__).resolve().parents[1] / "tests" / "data" / "gazebo11"

STRIDE = 25  # of the recorded rows
OBSTACLE_STRIDE = 5  # of those with obstacles, which have fewer rows
FIRST = range(1, 5)  # further rows, because all later steps depend on the first

# Times at which a contact begins or ends, s; all rows near them are kept.
EVENTS = {
    "C1_drop": (0.135,),
    "C2_takeoff_land": (0.135, 2.204, 5.021, 6.674),
}
NEAR = 0.0101


def thin(source: Path, target: Path, stride: int, events: tuple[float, ...] = ()) -> None:
    """Copy a recording, with some of its rows."""
    with gzip.open(source, "rt") as stream:
        header, *rows = stream.read().splitlines()
    kept = [header]
    for i, row in enumerate(rows):
        time = float(row.split(",", 1)[0])
        event = any(abs(time - at) < NEAR for at in events)
        if i % stride == 0 or i in FIRST or i == len(rows) - 1 or event:
            kept.append(row)
    # Without name and time in its header, the file depends only on the rows.
    with target.open("wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as stream:
        stream.write("".join(row + "\n" for row in kept).encode())


def main() -> None:
    """Thin every recording below SOURCE."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    source = Path(sys.argv[1])
    for path in sorted(source.rglob("*")):
        target = TARGET / path.relative_to(source)
        if path.is_dir() or path.name == "README.md":
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.name.endswith(".csv.gz"):
            stride = OBSTACLE_STRIDE if "obstacles" in path.parts else STRIDE
            thin(path, target, stride, EVENTS.get(path.parent.name, ()))
        else:
            shutil.copyfile(path, target)


if __name__ == "__main__":
    main()
