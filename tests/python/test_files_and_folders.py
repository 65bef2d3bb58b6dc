"""Odd files and folders: nothing is lost, and a fault is one clear line."""

from __future__ import annotations

import os
import resource
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from processes import FALL, run_command, run_refused, script

import quadcore as qc
from quadcore.cli import main
from quadcore.support.output_files import atomic_write

pytestmark = pytest.mark.usefixtures("in_empty_folder")


def test_a_log_through_a_link_keeps_link_and_mode():
    Path("there.csv").write_text("old")
    Path("there.csv").chmod(0o640)
    for name in ("here.csv", "here.mat"):
        Path(name).symlink_to("there.csv" if name == "here.csv" else "there.mat")
    Path("there.mat").write_text("old")
    Path("there.mat").chmod(0o640)
    assert main([*FALL, "--quiet", "--log", "here.csv", "--log", "here.mat"]) == 0
    for kind in ("csv", "mat"):
        assert Path(f"here.{kind}").is_symlink()
        assert Path(f"there.{kind}").stat().st_mode & 0o777 == 0o640
        assert Path(f"there.{kind}").stat().st_size > 1000


def test_a_device_is_written_and_stays_one():
    Path("null").symlink_to("/dev/null")
    with atomic_write(Path("null")) as stream:
        stream.write(b"nowhere")
    assert Path("null").is_char_device()


def test_a_log_that_cannot_be_written_does_not_take_the_other_with_it(capsys):
    Path("full.csv").symlink_to("/dev/full")
    assert main([*FALL, "--log", "full.csv", "--log", "good.csv", "--log", "good.mat"]) == 2
    error = capsys.readouterr().err
    assert error == "error: full.csv: cannot be written: No space left on device\n"
    assert len(np.loadtxt("good.csv", delimiter=",", skiprows=1)) == 51
    assert len(scipy.io.loadmat("good.mat")["t"]) == 51


def test_a_disk_that_fills_up_keeps_whole_rows(tmp_path):
    """A file size limit, which raises SIGXFSZ and EFBIG."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))

    run_refused(*FALL, "--log", "log.csv", preexec_fn=limit)
    text = Path("log.csv").read_text()
    assert text.endswith("\n") and 3000 < len(text) <= 4000
    rows = np.loadtxt("log.csv", delimiter=",", skiprows=1)
    assert rows[:, 0] == pytest.approx(1e-3 * np.arange(len(rows)))


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become nobody")
def test_a_folder_that_may_not_be_entered_is_one_line(tmp_path_factory):
    locked = tmp_path_factory.mktemp("locked")
    (locked / "in").mkdir()
    (locked / "in" / "a.urdf").touch()
    locked.chmod(0o700)
    path = str(locked / "in" / "a.urdf")
    program = f"""
import os, sys
from pathlib import Path
from quadcore.cli import main
import quadcore, quadcore.report.plots
os.setuid(65534)
for arguments in (["info", {path!r}], ["run", "quadrotor", "--world", {path!r}],
                  ["run", "quadrotor", "--log", {path!r}[:-5] + ".csv"],
                  ["run", "quadrotor", "--out", {path!r}],
                  ["run", "quadrotor", "--commands", {path!r}[:-5] + ".csv"]):
    assert main(arguments) == 2
try:
    quadcore.load_plugin_path({path!r})
except quadcore.InputError as error:
    print(error, file=sys.stderr)
"""
    lines = script(program).stderr.splitlines()
    assert len(lines) == 6 and all("ermission denied" in line for line in lines), lines


def test_a_name_that_is_too_long_is_one_line():
    name = "x" * 5000
    for arguments in (
        ["info", name],
        ["info", name + ".xacro"],
        [*FALL, "--world", name],
        [*FALL, "--log", name + ".csv"],
        [*FALL, "--out", name],
        [*FALL, "--commands", name + ".csv"],
    ):
        assert "File name too long" in run_refused(*arguments)


def test_a_name_that_is_no_utf8_is_a_name(toy):
    model = os.fsdecode(b"m\xff.urdf")
    Path(model).write_text(Path("toy.urdf").read_text())
    done = run_command("run", model, "--duration", "0.01", "--log", os.fsdecode(b"l\xff.csv"))
    assert done.returncode == 0 and "l\\udcff.csv" in done.stdout
    assert Path(os.fsdecode(b"l\xff.csv")).exists()
    vary = ["--vary", "motor.kp=1e-4,2e-4", "--out", "out", "--duration", "0.01"]
    assert run_command("compare", model, "toy.urdf", *vary).returncode == 0
    Path(model).write_text("<robot>")
    assert "m\\xff.urdf:1: " in run_refused("info", model)
    folder = os.fsdecode(b"p\xff")
    Path(folder).mkdir()
    qc.load_plugin_path(folder)
    assert os.path.realpath(folder) in qc.plugin_folders()


def test_a_name_cannot_steer_a_terminal(toy):
    Path("\x1b[31mred.urdf").write_text("<robot>")
    assert "\x1b" not in run_refused("info", "\x1b[31mred.urdf")
    done = run_command("run", "toy.urdf", "--duration", "0.01", "--log", "\x1b[31m.csv")
    assert "\x1b" not in done.stdout and "\\x1b[31m.csv" in done.stdout
