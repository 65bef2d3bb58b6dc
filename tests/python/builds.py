"""What is built outside the tree."""

from __future__ import annotations

import fcntl
import os
import subprocess
from pathlib import Path

import pytest

import quadcore as qc

ROOT = Path(__file__).resolve().parents[2]


def build(source: Path, folder: Path, *options: str) -> Path:
    """Build a CMake project against the installed package; returns its folder."""
    prefix = f"-DCMAKE_PREFIX_PATH={qc.cmake_prefix()}"
    configure = ["cmake", "-S", source, "-B", folder, prefix, *options]
    for command in (configure, ["cmake", "--build", folder]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return folder


def build_once(source: Path, factory: pytest.TempPathFactory) -> Path:
    """Build a CMake project for all processes of this test run; returns its folder."""
    root = factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        root = root.parent
    folder = root / "_".join(["built", *source.relative_to(ROOT).parts])
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "built").exists():
            build(source, folder)
            (folder / "built").touch()
    return folder
