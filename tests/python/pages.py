"""What a page of the docs says to type, run from top to bottom in a folder of its own.

A block of Python, of a shell or of Octave runs as it stands, all Python of a page in one process.
An XML element `<gazebo>` flies in the shipped vehicle. Comments before a block, which no reader
sees, tell what else becomes of it:

    <!-- quoted: FILE -->  it stands in that file, which runs elsewhere
    <!-- file: NAME -->    it is a file that other blocks of the page use
    <!-- run: COMMAND -->  what a reader of the page has done before, in a shell
    <!-- python: CODE -->  the same in Python
    <!-- output -->        the block before prints it; ... stands for any text
    <!-- output: 0.02 -->  the same, with numbers within 2 %; more of them continue the first

Sweeps fly little, other flights are cut short except in tutorials, in READMEs and where the output
is shown. If the output that a page shows lists no plots, the command runs with `--no-plots`, except
in tutorials and READMEs. Programs of systems that are not here are stood in for (`stand_in.py`).
"""

from __future__ import annotations

import ast
import contextlib
import inspect
import os
import re
import shlex
import signal
import site
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
from processes import list_client

import quadcore as qc

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "README.md"
# These fly as long as they say.
WHOLE = (ROOT, ROOT / "python", ROOT / "docs" / "tutorials")
PAGES = sorted((ROOT / "docs").rglob("*.md"))
BLOCK = re.compile(
    r"^<!-- (?P<kind>run|python): (?P<before>.*?) -->$"
    r"|(?:^<!-- (?P<marker>quoted|file|output)(?:: (?P<file>\S+))? -->\n+)?"
    r"^ *```(?P<language>[^\n]*)\n(?P<text>.*?)^ *```$",
    re.DOTALL | re.MULTILINE,
)
NOT_RUN = re.compile(r"text|math|\{")
PLOTS = re.compile(r"\.png|figures")
ELSEWHERE = "roslaunch rosrun rostopic rosservice rosparam rosbag rospack catkin_make git "
ELSEWHERE += "sudo pip jupytext jupyter"
PIECE = """<robot name="piece" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:include filename="$(find quadcore)/urdf/quadrotor.urdf.xacro"/>
{}</robot>
"""
DRIVER = """
import contextlib, io, os, subprocess, sys
from pathlib import Path
from printed import check_printed

def _shell(*command, errors=subprocess.STDOUT, **environment):
    ran = subprocess.run(
        command, stdout=subprocess.PIPE, stderr=errors, text=True,
        env={**os.environ, **environment},
    )
    assert ran.returncode == 0, f"{command[-1]}\\n{ran.stdout}"
    print(ran.stdout, end="")

def _show(step, expected, tolerance):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(step, globals())
    printed = "".join(f"{line.rstrip()}\\n" for line in out.getvalue().splitlines())
    print(printed, end="")
    check_printed(expected, printed, tolerance)

def _octave(text):
    served = Path("served")
    if served.exists():
        text = text.replace("5005", served.read_text().split()[0])
    text = "addpath('quadcore/matlab');" + text
    # Octave may complain as it exits, which is no part of the output.
    _shell("octave-cli", "--norc", "--quiet", "--eval", text, errors=None)
"""


def blocks(page):
    """Each block of a page, and each command before one, as a dictionary of BLOCK's names."""
    found = []
    for match in BLOCK.finditer(page.read_text(encoding="utf-8")):
        block = match.groupdict()
        if block["marker"] == "output" and found[-1]["marker"] == "output":
            found[-1]["text"] += block["text"]
        else:
            found.append(block)
    return found


def run(page, folder):
    """Run a page; what its Python prints and its commands complain of. Raises where one fails."""
    prepare(folder)
    steps, pieces = [DRIVER], 0
    found = blocks(page)
    for block, after in zip(found, [*found[1:], {"marker": None}]):
        language, text = block["language"], block["text"]
        if block["marker"] == "file":
            file = folder / block["file"]
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        elif block["marker"] == "output":
            steps[-1] = f"_show({steps[-1]!r}, {text!r}, {float(block['file'] or 0)})"
        elif block["marker"] == "quoted" or NOT_RUN.match(language or ""):
            continue
        elif block["kind"] == "python" or language == "python":
            steps.append(text or block["before"])
        elif block["kind"] == "run" or language == "sh":
            shell = text or block["before"]
            whole = ""
            if after["marker"] == "output":
                draws = page.parent in WHOLE or PLOTS.search(after["text"])
                short = "no" if draws else "no-plots"
                whole = f", QUADCORE_SHORT={short!r}"
            steps.append(f"_shell('bash', '-eo', 'pipefail', '-c', {shell!r}{whole})")
        elif language in ("octave", "matlab"):
            steps.append(f"_octave({text!r})")
        elif language == "pycon":
            check_calls(text)
        elif language == "xml" and text.startswith("<launch>"):
            check_launch(text)
        elif language == "xml" and text.startswith("<gazebo>"):
            pieces += 1
            piece = folder / f"piece{pieces}.urdf.xacro"
            piece.write_text(PIECE.format(text))
            # Of the default drag some pieces would warn.
            qc.Simulation(piece, parameters={"drone_plugin.dragModel": "chapter2"}).step(9)
        else:
            raise AssertionError(f"{page.name}: nothing runs a block of '{language}':\n{text}")
    try:
        return call("\n".join(steps), folder, page.parent not in WHOLE)
    finally:
        if (folder / "served").exists():
            with contextlib.suppress(ProcessLookupError):
                os.kill(int((folder / "served").read_text().split()[1]), signal.SIGTERM)


def call(text, folder, short):
    environment = {
        **os.environ,
        "HOME": str(folder),
        "MPLCONFIGDIR": matplotlib.get_cachedir(),  # or each page would search for fonts again
        "PYTHONUSERBASE": site.getuserbase(),  # which lies in the other home
        "BASH_FUNC_pip%%": '() { "$HOME/stand_ins/pip" "$@"; }',  # in environments made here, too
        "PATH": f"{folder}/stand_ins:{Path(sys.executable).parent}:{os.environ['PATH']}",
        "QUADCORE_SHORT": "yes" if short else "",
    }
    ran = subprocess.run(
        [*list_client("python"), text], cwd=str(folder), env=environment, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, encoding="utf-8",
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout
    return ran.stdout


def check_calls(text):
    """What is typed where it cannot be here: functions of quadcore take what they are given."""
    source = re.sub(r"^(>>>|\.\.\.) ?", "", text, flags=re.MULTILINE)
    for node in ast.walk(ast.parse(source)):
        owner = getattr(getattr(node, "func", None), "value", None)
        if isinstance(owner, ast.Name) and owner.id == "qc":
            function = getattr(qc, node.func.attr)
            given = {keyword.arg: None for keyword in node.keywords}
            inspect.signature(function).bind_partial(*node.args, **given)


def check_launch(text):
    """What a launch file includes and starts is there; tests/ros loads it."""
    launch = ElementTree.fromstring(text)
    for include in launch.iter("include"):
        assert Path(include.get("file").replace("$(find quadcore)", str(ROOT))).is_file()
    for node in launch.iter("node"):
        assert node.get("pkg") != "quadcore" or list((ROOT / "scripts").rglob(node.get("type")))


def prepare(folder):
    """Make a folder like a checkout, with stand-ins for what is not here, or takes long."""
    for name in ("config", "urdf", "worlds", "matlab", "tests", "examples"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "quadcore").symlink_to(ROOT)
    stand_in = Path(__file__).with_name("stand_in.py")
    places = [folder / "stand_ins" / name for name in ("quadcore", *ELSEWHERE.split())]
    places += [folder / "scripts" / f.name for f in (ROOT / "scripts").iterdir() if not f.suffix]
    for place in places:
        place.parent.mkdir(exist_ok=True)
        is_forked = place.name == "quadcore"
        command = list_client("quadcore") if is_forked else [sys.executable, stand_in, place.name]
        words = " ".join(shlex.quote(str(word)) for word in command)
        place.write_text(f'#!/bin/sh\nexec {words} "$@"\n')
        place.chmod(0o755)
