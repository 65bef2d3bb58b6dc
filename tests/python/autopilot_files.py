"""Stack files for the stand-in of Betaflight, and what must not remain after a flight."""

import os
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest
from processes import LONG

import quadcore as qc
from quadcore.autopilots import read_autopilot
from quadcore.support.rotation import turn

STAND_IN = Path(__file__).with_name("betaflight_stand_in.py")
PORTS = '"{motors}", "{state}", "{radio}", "{msp}"'


def write_stack(folder, *faults, more="", ports=PORTS, name="stack.yaml"):
    """Write a stack file for the stand-in with faults, and return its path."""
    fault = "".join(f", --fault, {each}" for each in faults)
    path = folder / name
    path.write_text(
        "autopilot: betaflight\n"
        f"program: {sys.executable}\n"
        f"arguments: [{STAND_IN}, --ports, {ports}{fault}]\n"
        f"lockstep: plain\nhold: 1.6\n{more}"
    )
    return path


def fly_iris(stack, duration, reference="hover", dt=0.001):
    """Fly an iris with the autopilot of a stack file, from the full state of the reference."""
    return qc.Simulation("iris", engine="eigen", dt=dt).run(
        duration,
        controller=read_autopilot(stack),
        reference=qc.references.parse(reference),
        on_reference=True,
    )


def turn_in_all_axes():
    """Return an orientation that is not the same in any two axes."""
    orientation = np.array([0.0, 0, 0, 1])
    for step in ([0, 0, 0.7], [0, -0.5, 0], [0.3, 0, 0]):
        orientation = turn(orientation, np.array(step))
    return orientation


@pytest.fixture(autouse=True)
def nothing_remains(tmp_path, monkeypatch):
    """Fail a test that leaves a process or a folder of an autopilot behind."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    yield
    limit = time.monotonic() + LONG
    while find_processes(folder) and time.monotonic() < limit:  # a process may still be ending
        time.sleep(0.01)
    assert find_processes(folder) == []
    assert list(folder.iterdir()) == []


def find_processes(folder):
    """Processes that this test started, by their environment."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            try:
                if os.fsencode(folder) in (entry / "environ").read_bytes():
                    found.append(entry.name)
            except OSError:  # ended meanwhile, or another user's
                continue
    return found
