"""What scripts set up, and what happens on systems that have other packages or fail to build."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SLEEPER = """
import time


def test_that_sleeps_for_ever():
    time.sleep(10**6)


def test_that_comes_later():
    pass
"""


@pytest.fixture
def checkout(tmp_path):
    """Folder with the files that the set-up reads, and no others."""
    (tmp_path / "scripts").mkdir()
    for name in ("setup.sh", "fly"):
        shutil.copy(ROOT / "scripts" / name, tmp_path / "scripts")
    for name in ("CMakeLists.txt", "pyproject.toml", "constraints.txt"):
        shutil.copy(ROOT / name, tmp_path)
    for name in ("cpp", "python", "urdf", "worlds", "config", "launch", "msg", "srv", "web", "bin"):
        (tmp_path / name).mkdir()
    dpkg_query = tmp_path / "bin" / "dpkg-query"  # nothing is missing
    dpkg_query.write_text("#!/bin/sh\necho install ok installed\n")
    dpkg_query.chmod(0o755)
    return tmp_path


def fly(checkout, *arguments):
    path = f"{checkout / 'bin'}:{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "scripts/fly", *arguments],
        cwd=checkout, env={**os.environ, "PATH": path}, capture_output=True, text=True,
    )  # fmt: skip


def python_of_venv(checkout, program, configuration=""):
    folder = checkout / ".venv" / "bin"
    folder.mkdir(parents=True)
    (folder / "python").write_text(program)
    (folder / "python").chmod(0o755)
    (checkout / ".venv" / "pyvenv.cfg").write_text(configuration)


def test_a_failed_build_shows_its_last_40_lines_and_where_the_log_is(checkout):
    python_of_venv(checkout, "#!/bin/sh\nseq 1 100 | sed 's/^/line /'\nexit 1\n")
    done = fly(checkout)
    lines = done.stderr.splitlines()
    assert done.returncode == 2
    assert lines[:40] == [f"line {i}" for i in range(61, 101)]
    assert lines[40].endswith("The whole log is .venv/pip.log.")
    assert len(lines) == 41
    assert (checkout / ".venv" / "pip.log").read_text().splitlines()[0] == "line 1"


def test_a_virtual_environment_that_sees_system_packages_is_replaced(checkout):
    python_of_venv(checkout, "", "include-system-site-packages = true\n")
    (checkout / "constraints.txt").write_text("no requirement at all\n")  # pip stops here
    done = fly(checkout)
    assert "replacing .venv" in done.stdout
    assert done.returncode == 2
    configuration = (checkout / ".venv" / "pyvenv.cfg").read_text()
    assert "include-system-site-packages = false" in configuration


def test_help_of_a_script_prints_its_first_comment_and_installs_nothing(checkout):
    done = fly(checkout, "--help")
    assert done.returncode == 0
    assert done.stdout.startswith("Installs what is missing and ")
    assert not (checkout / ".venv").exists()


def test_fly_refuses_arguments_and_installs_nothing(checkout):
    done = fly(checkout, "quadrotor")
    assert (done.returncode, done.stderr) == (2, "quadcore: scripts/fly takes no arguments\n")
    assert not (checkout / ".venv").exists()


MIX = """
import sys, types
foreign = types.ModuleType("mpl_toolkits")
foreign.__path__ = [sys.argv[1]]
sys.modules["mpl_toolkits"] = foreign  # as python3-matplotlib does by its -nspkg.pth
from quadcore.cli import main
sys.exit(main(["info", "quadrotor", "--picture", sys.argv[2]]))
"""


def test_two_installations_of_matplotlib_are_named_with_the_command_that_repairs_them(tmp_path):
    (tmp_path / "mplot3d").mkdir()
    (tmp_path / "mplot3d" / "__init__.py").write_text("import matplotlib.tri.triangulation\n")
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", MIX, str(tmp_path), str(tmp_path / "picture.png")],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 2
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error:")]
    assert str(tmp_path) in line
    assert f"'{sys.executable} -m pip uninstall matplotlib'" in line
    assert "Traceback" not in done.stderr


def test_a_test_that_sleeps_for_ever_ends_with_its_name_and_stack(tmp_path):
    (tmp_path / "test_sleeper.py").write_text(SLEEPER)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-c", str(ROOT / "pyproject.toml"),
         "--rootdir", str(tmp_path), "-p", "no:cacheprovider", "-o", "timeout=1",
         "test_sleeper.py"],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 1
    assert "FAILED test_sleeper.py::test_that_sleeps_for_ever" in done.stdout
    assert "    time.sleep(10**6)" in done.stdout
    assert "1 failed, 1 passed" in done.stdout
