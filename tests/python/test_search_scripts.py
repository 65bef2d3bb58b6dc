"""The commands that look for memory errors."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BINDINGS = ROOT / "tests" / "fuzz" / "bindings"
TARGETS = ("arguments", "batches", "messages", "objects", "pickles")


@pytest.mark.parametrize("script", ["fuzz", "sanitize"])
def test_a_script_that_is_asked_for_help_prints_it_and_installs_nothing(script):
    for asked in ("-h", "--help"):
        command = ["/bin/bash", ROOT / "scripts" / script, asked]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.startswith(f"usage: scripts/{script} ") and "example:" in done.stdout
        assert "quadcore: " not in done.stdout  # as it begins what it installs or builds
    wrong = subprocess.run([*command[:2], "nonsense"], capture_output=True, text=True, timeout=60)
    assert wrong.returncode == 2 and wrong.stderr.startswith("usage:") and not wrong.stdout


@pytest.mark.parametrize("target", TARGETS)
def test_the_seeded_search_of_the_bindings_finds_nothing_in_its_first_inputs(target, tmp_path):
    number = tmp_path / "number"
    command = [sys.executable, BINDINGS, target, "--runs", "200", "--number", number]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith(f"{target}: 200 inputs") and "seed 1, no finding" in done.stdout
    assert int.from_bytes(number.read_bytes(), "little") == 199


def test_every_target_of_the_search_is_in_its_help():
    script = (ROOT / "scripts" / "fuzz").read_text()
    assert f'calls="{" ".join(TARGETS)}"' in script
    for target in TARGETS:
        assert f"\n             {target} " in script
