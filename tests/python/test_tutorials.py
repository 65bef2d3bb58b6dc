"""Each tutorial runs as it stands: files are written, commands and Python run in their order."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "tutorials"
PAGES = sorted(set(FOLDER.glob("*.md")) - {FOLDER / "own_node.md"})  # that one flies in tests/ros
BLOCK = re.compile(r"^(?:<!-- file: (\S+) -->\n)?```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_runs_as_it_stands(page, tmp_path):
    here = str(Path(sys.executable).parent)
    python = []
    for file, language, text in BLOCK.findall(page.read_text()):
        if file:
            (tmp_path / file).parent.mkdir(exist_ok=True)
            (tmp_path / file).write_text(text)
        elif language == "python":
            python.append(text)
        else:
            assert language == "sh", f"nothing runs a block of {language}"
            run(["bash", "-euo", "pipefail", "-c", text], tmp_path, here)
    if python:
        run([sys.executable, "-c", "\n".join(python)], tmp_path, here)


def run(command, folder, here):
    environment = {**os.environ, "PATH": f"{here}:{os.environ['PATH']}"}
    ran = subprocess.run(
        command,
        cwd=str(folder),
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
    )
    assert ran.returncode == 0, f"{command[-1]}\n{ran.stdout}"
