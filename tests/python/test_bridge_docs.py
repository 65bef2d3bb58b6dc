"""The pages for people who come from MATLAB, from Gazebo or with an FMU: their commands run."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from processes import LONG, ran

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("fmu", "matlab", "migrating")


def blocks(page):
    """(language, text) of each, in order."""
    text = (ROOT / "docs" / f"{page}.md").read_text()
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.M | re.S)


def call(line, folder):
    words = shlex.split(line, comments=True)
    assert words[0] == "quadcore", line
    if words[1] == "serve":  # until it is told to end
        words[words.index("--port") + 1] = "0"
        served = subprocess.Popen(
            [sys.executable, "-m", "quadcore", *words[1:]], cwd=str(folder), text=True,
            stdout=subprocess.PIPE,
        )  # fmt: skip
        assert served.stdout.readline().startswith("serving quadrotor at ")
        served.terminate()
        served.wait(timeout=LONG)
        return
    done = ran(*words[1:], cwd=str(folder))
    assert done.returncode == 0, f"{line}\n{done.stderr}"


@pytest.mark.parametrize("page", PAGES)
def test_every_command_of_the_page_runs_in_turn(page, tmp_path):
    count = 0
    for language, text in blocks(page):
        if language == "sh":
            for line in text.replace("\\\n", " ").splitlines():
                call(line, tmp_path)
                count += 1
        elif language == "python":
            done = subprocess.run(
                [sys.executable, "-c", text], cwd=str(tmp_path), capture_output=True, text=True
            )
            assert done.returncode == 0, done.stderr
            count += 1
        elif language == "octave":
            if shutil.which("octave-cli") is None:
                pytest.skip("needs Octave: apt install octave")
            done = subprocess.run(["octave-cli", "--norc", "--quiet", "--eval", text], cwd=tmp_path)
            assert done.returncode == 0
    assert count >= 2


def test_the_climb_of_the_fmu_arrives(tmp_path):
    [text] = [text for language, text in blocks("fmu") if language == "python"]
    done = subprocess.run(
        [sys.executable, "-c", text], cwd=str(tmp_path), capture_output=True, text=True
    )
    assert float(re.search(r"\d+\.\d+", done.stdout)[0]) == pytest.approx(3.0, abs=0.1)
