"""Stack files for the stand-in of Betaflight, and what must not remain after a flight."""

import os
import sys
import tempfile
import time
from pathlib import Path

import pytest
from processes import LONG

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
