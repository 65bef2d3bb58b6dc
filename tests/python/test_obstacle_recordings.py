"""Contact with obstacles and free bodies in the engine gazebo11 against real Gazebo 11.

tests/data/gazebo11/obstacles contains a part of the recordings, with a summary. Each case was also
recorded with a start that differs by 1e-12 m/s and 1e-12 rad/s. Its growth decides until when a
case is calm and how far a flight may be from the recording (`calm_until_s`, `bar_m`). Where the
environment variable QUADCORE_RECORDINGS names a folder with more of them, those are flown too.
"""

from __future__ import annotations

import csv

import numpy as np
import pytest
from test_gazebo_recordings import FOLDERS, name_of
from test_random_recordings import make_simulation

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

CALM = 1e-9  # m


def read_summaries(with_fleets=False):
    """Folder and row of each case; those with several vehicles or those with one."""
    for folder in FOLDERS:
        summary = folder / "obstacles" / "summary.csv"
        if not summary.exists():
            continue
        with summary.open(newline="") as rows:
            for row in csv.DictReader(rows):
                if row["class"].startswith("V_") == with_fleets:
                    yield summary.parent / row["case"], row


CASES = list(read_summaries())


@pytest.mark.parametrize("case, row", CASES, ids=[name_of(case) for case, _ in CASES])
def test_contact_with_obstacles_is_that_of_the_recording(case, row, monkeypatch):
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(case.parent / "models"))
    simulation = make_simulation(case)
    recorded = np.loadtxt(case / "record.csv.gz", delimiter=",", skiprows=1)
    log = simulation.run(recorded[-1, 0], commands=case / "commands.csv")
    rows = np.rint(recorded[:, 0] / simulation.dt).astype(int)
    apart = np.linalg.norm(log.position[rows] - recorded[:, 1:4], axis=1)
    assert apart[recorded[:, 0] <= float(row["calm_until_s"])].max() < CALM
    assert apart.max() < float(row["bar_m"])
