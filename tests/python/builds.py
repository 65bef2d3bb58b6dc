"""What is built outside the tree."""

from __future__ import annotations

import subprocess
from pathlib import Path

import quadcore as qc


def build(source: Path, folder: Path, *options: str) -> Path:
    """Build a CMake project against the installed package; returns its folder."""
    prefix = f"-DCMAKE_PREFIX_PATH={qc.cmake_prefix()}"
    configure = ["cmake", "-S", source, "-B", folder, prefix, *options]
    for command in (configure, ["cmake", "--build", folder]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder
