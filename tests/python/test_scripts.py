"""Programs beside the package that no other test runs whole."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("benchmarks", "examples", "scripts")


def is_python(path):
    return path.suffix == ".py" or (
        not path.suffix and path.read_bytes().splitlines()[:1] == [b"#!/usr/bin/env python3"]
    )


PROGRAMS = [
    path
    for folder in FOLDERS
    for path in sorted((ROOT / folder).rglob("*"))
    if path.is_file() and is_python(path)
]


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_program_imports_of_quadcore_what_there_is(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if not isinstance(node, ast.ImportFrom) or not (node.module or "").startswith("quadcore"):
            continue
        if node.module in ("quadcore.msg", "quadcore.srv"):  # made by catkin
            continue
        module = importlib.import_module(node.module)
        for name in (alias.name for alias in node.names):
            if not hasattr(module, name):
                importlib.import_module(f"{node.module}.{name}")


def test_the_bindings_configure_with_the_sanitizers_of_the_scripts(tmp_path):
    pybind11 = pytest.importorskip("pybind11")
    sanitizers = re.search(
        r"^sanitizers=(.*)$", (ROOT / "scripts" / "sanitized.sh").read_text(), re.MULTILINE
    )
    options = {
        "QUADCORE_BUILD_PYTHON": "ON",
        "QUADCORE_SANITIZE": sanitizers[1],
        "QUADCORE_WITH_ROS": "OFF",
        "Python_EXECUTABLE": sys.executable,
        "pybind11_DIR": pybind11.get_cmake_dir(),
    }
    words = [f"-D{name}={value}" for name, value in options.items()]
    done = subprocess.run(
        ["cmake", "-S", ROOT, "-B", tmp_path, *words], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
