"""The rows of a sweep survive what happens to it."""

from __future__ import annotations

import contextlib
import functools
import os
import random
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from processes import LONG, QUADCORE, run_command, run_refused, script
from sweeps import lines, rows, sweep

import quadcore as qc
from quadcore.cli import main
from quadcore.studies.output_folder import output_folder

FLY = ["sweep", "--controller=geometric", "--reference=circle", "--xacro=sim_slow:=1", "--quiet"]
SMALL = [*FLY, "--vary=frame.mass=uniform:0.9:1.1", "--samples=40", "--duration=1", "--no-plots"]

pytestmark = pytest.mark.usefixtures("in_empty_folder")


def test_rows_are_in_order_whatever_the_processes_are():
    sweep(out="one", processes=1, seeds=3)
    sweep(out="three", processes=3, seeds=3)
    assert lines("one") == lines("three")
    assert [int(row["row"]) for row in rows("one")] == list(range(36))


def test_whatever_kills_a_sweep_it_goes_on_where_it_was():
    assert run_command(*SMALL, "--out=whole").returncode == 0
    chance = random.Random(7)
    for _ in range(3):
        process = subprocess.Popen([*QUADCORE, *SMALL, "--out=killed", "--resume"])
        end, wanted = time.monotonic() + LONG, len_of("killed") + chance.randrange(1, 8)
        while len_of("killed") < wanted and process.poll() is None and time.monotonic() < end:
            time.sleep(0.005)
        time.sleep(chance.random() * 0.05)
        process.send_signal(signal.SIGKILL)
        process.wait()
    before = len_of("killed")
    assert before > 3
    assert run_command(*SMALL, "--out=killed", "--resume").returncode == 0
    assert lines("killed") == lines("whole")


def len_of(folder):
    file = Path(folder) / "table.csv"
    return file.read_bytes().count(b"\n") if file.exists() else 0


def _counted(point):
    with open("calls", "a") as stream:
        stream.write(f"{point['a']:g}\n")
    return point["a"]


def test_nothing_is_flown_twice():
    vary = {"a": list(range(40))}
    qc.sweep(function=_counted, vary=vary, out="out")
    table = Path("out/table.csv")
    whole = table.read_bytes()
    head, *body = whole.splitlines(keepends=True)
    kept = [body[i] for i in (7, 3, 30)]
    table.write_bytes(head + b"".join(kept) + body[9][:-5])  # cut off as it was written
    Path("calls").unlink()
    qc.sweep(function=_counted, vary=vary, out="out", resume=True)
    calls = sorted(map(int, Path("calls").read_text().split()))
    assert calls == [i for i in range(40) if i not in (7, 3, 30)]
    assert table.read_bytes() == whole
    qc.sweep(function=_counted, vary=vary, out="out", resume=True)
    assert len(Path("calls").read_text().split()) == 37


def test_rows_that_cannot_be_flown_are_gone_on_with_too():
    masses = [f"{1 + 0.01 * i:.2f}" for i in range(20)]
    masses[10] = "heavy"  # between the first and the last, which are tried before anything flies
    options = {"vary": {"frame.mass": masses}, "samples": None, "duration": 0.05, "out": "out"}
    found = sweep(**options)
    assert "'heavy' is not a finite number" in found.columns["failure"][10]
    assert (found.columns["failure"] != "").sum() == 1
    table = Path("out/table.csv")
    whole = table.read_bytes()
    table.write_bytes(b"".join(whole.splitlines(keepends=True)[:15]))
    sweep(resume=True, **options)
    assert table.read_bytes() == whole


def test_rows_that_are_there_are_not_overwritten_unasked():
    sweep(out="out")
    before = lines("out")
    with pytest.raises(qc.InputError, match=r"the file contains rows. Add --resume, or name"):
        sweep(out="out")
    assert lines("out") == before


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"duration": 0.6}, "table.csv:2: the row has other inputs"),
        ({"parameters": {"odometry.positionNoise": 1e-3}}, "table.csv:2: the row has other"),
        ({"seed": 4}, "table.csv:2: the row has frame.mass"),
        ({"seeds": 2}, r"table.csv:3: the row has frame.mass .*, this sweep "),
        ({"samples": 11}, "table.csv:2: the row has frame.mass"),
        (
            {"vary": {"frame.mass": "uniform:0.9:1.1", "frame.ixx": [0.007, 0.008]}},
            ":1: the columns are not those of this sweep",
        ),
    ],
)
def test_changed_inputs_are_noticed(changed, expected):
    sweep(out="out")
    with pytest.raises(qc.InputError, match=expected):
        sweep(out="out", resume=True, **changed)
    assert len(lines("out")) == 13


def test_a_changed_file_is_noticed():
    Path("law.yaml").write_text("law: pd\nparameters: {kp_xy: 2.4}\n")
    Path("noticed.py").write_text(
        "def law(t, state, reference):\n    return [500, -500, 500, -500]\n"
    )

    def fly(**options):
        return qc.sweep(["law.yaml", "noticed:law"], "hover", duration=0.1, out="out", **options)

    fly()
    fly(resume=True)
    text = Path("noticed.py").read_text()
    Path("noticed.py").write_text(text.replace("500", "501"))
    with pytest.raises(qc.InputError, match=r"table.csv:3: the row has other inputs"):
        fly(resume=True)
    Path("noticed.py").write_text(text)
    Path("law.yaml").write_text("law: pd\nparameters: {kp_xy: 2.5}\n")
    with pytest.raises(qc.InputError, match=r"table.csv:2: the row has other inputs"):
        fly(resume=True)


def test_a_disk_that_fills_up_keeps_whole_rows():
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))

    error = run_refused(*SMALL, "--out=out", preexec_fn=limit)
    assert "table.csv: cannot be written: File too large" in error
    text = Path("out/table.csv").read_text()
    assert text.endswith("\n") and 2000 < len(text) <= 3000
    assert run_command(*SMALL, "--out=out", "--resume").returncode == 0
    assert [int(row["row"]) for row in rows("out")] == list(range(40))


def _deadly(point):
    mark = Path(f"killed_{point['a']:g}")
    if point["a"] == 3 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if point["a"] == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    if point["a"] == 6:
        return [0] * 2**40
    if point["a"] == 7:
        while True:
            pass
    return point["a"]


def test_what_kills_its_process_or_never_ends_is_one_row():
    """A worker that somebody kills once does not count against the row."""
    found = qc.sweep(function=_deadly, vary={"a": list(range(9))}, time_limit=1.0, processes=2)
    failures = dict(zip(found.columns["a"], found.columns["failure"]))
    assert [a for a, failure in failures.items() if not failure] == [0, 1, 2, 3, 4, 8]
    assert failures[5] == "its process was ended by SIGKILL, 3 times"
    assert failures[6] == "no memory left"
    assert failures[7] == "not done within the time limit of 1 s"
    assert all(found.columns["fingerprint"])
    assert np.isnan(found.columns["value"][5])


def test_a_flight_that_never_ends_is_one_row():
    Path("endless.py").write_text(
        "def law(t, state, reference):\n    while t > 0.05:\n        pass\n    return [500] * 4\n"
    )
    found = qc.sweep(["pd", "endless:law"], "hover", duration=0.2, time_limit=2)
    assert found.columns["failure"].tolist() == ["", "not done within the time limit of 2 s"]


HOLDER = """
import sys
from pathlib import Path
from quadcore.studies.output_folder import output_folder

with output_folder(Path("out")):
    print("held", flush=True)
    sys.stdin.read()
"""


@pytest.mark.parametrize(
    "command",
    [
        ["sweep", "--controller=pd", "--reference=hover"],
        ["evaluate", "--controller=pd", "--reference=hover"],
        ["compare", "quadrotor", "--vary=frame.mass=1,1.1"],
    ],
)
def test_two_studies_do_not_write_into_one_folder(command, monkeypatch, capsys):
    monkeypatch.setattr("quadcore.studies.output_folder._PATIENCE", 0.0)
    words = [*command, "--duration=0.05", "--no-plots", "--quiet", "--out=out"]
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        process.stdout.readline()
        assert main(words) == 2
        assert capsys.readouterr().err == (
            "error: out: another study is writing there. Wait, or name another folder.\n"
        )
        process.stdin.close()
    assert not any(Path("out").iterdir())
    assert main(words) == 0
    assert not [path for path in Path("out").iterdir() if path.name.startswith(".")]


def test_two_threads_do_not_write_into_one_folder():
    with output_folder(Path("out")), pytest.raises(qc.InputError, match="another study is writing"):
        sweep(out="out")
    sweep(out="out")


def test_the_lock_that_a_killed_study_left_is_taken_over():
    holder = subprocess.Popen(
        [sys.executable, "-c", HOLDER], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    holder.stdout.readline()
    holder.kill()
    holder.wait()
    holder.stdin.close()
    assert any(Path("out").iterdir())
    sweep(out="out")


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("rms_position", "abc"),
        ("rms_position", "nan"),
        ("rms_position", "1e999"),
        ("row", "1" * 5000),
        ("row", "\u00b2"),
        ("row", "-1"),
    ],
)
def test_a_damaged_table_is_refused_with_its_line(column, value):
    sweep(out="out")
    head, first, *others = Path("out/table.csv").read_text().splitlines(keepends=True)
    cells = first.split(",")
    cells[head.rstrip().split(",").index(column)] = value
    Path("out/table.csv").write_text("".join([head, ",".join(cells), *others]), encoding="utf-8")
    with pytest.raises(qc.InputError, match=r"table\.csv:2: .*Remove the line"):
        sweep(out="out", resume=True)


def test_a_model_whose_name_has_a_line_break_is_resumed():
    name = "of two\nlines\r.urdf"
    Path(name).write_text(qc.read_model("quadrotor").document.text)
    options = {"models": ["quadrotor", name], "samples": 4, "xacro_args": {}, "duration": 0.05}
    for resume in (False, True):
        found = sweep(out="out", resume=resume, **options)
        assert found.columns["failure"].tolist() == [""] * 8
        assert len(lines("out")) == 9


def test_ctrl_c_keeps_the_rows_and_says_how_to_go_on():
    process = subprocess.Popen([*QUADCORE, *SMALL, "--out=out"], stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + LONG
    while len_of("out") < 4 and time.monotonic() < end:
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=LONG)
    assert process.returncode == 130
    assert "rows so far: out/table.csv. Add --resume to continue." in error
    assert Path("out/table.csv").read_bytes().endswith(b"\n")


def test_the_parent_needs_no_more_memory_for_more_rows():
    measured = script(
        """
import resource
import quadcore as qc
from quadcore.studies.design import Design
from quadcore.studies.sweep.plan import Calls
from quadcore.studies.sweep.sweep import fly_plan
from pathlib import Path

def most(count, folder):
    Path(folder).mkdir()
    design = Design({"a": f"0:1:{count}"})
    fly_plan(Calls(design, lambda point: point["a"], ["value"], 9.0), Path(folder), processes=1)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

few = most(2000, "few")
print(few, most(10000, "many"))
"""
    )
    few, many = map(int, measured.stdout.split())
    assert many - few < 3000, measured.stderr  # kB; the rows are 1 MB


WAITS = """
import os, sys, time
import quadcore as qc

def waits(point):
    with open("calls", "a") as stream:
        stream.write("x")
    while point["a"] == 3 and not os.path.exists("go"):
        time.sleep(0.01)
    return point["a"]

if __name__ == "__main__":
    order = {"a": [3, 1, 2, 4]}
    qc.sweep(function=waits, vary=order, out="swept", resume=True, processes=2)
"""


def test_a_sweep_that_waited_for_another_finds_what_that_one_left():
    """It may have put the file in order meanwhile: another file has the name then."""
    Path("waits.py").write_text(WAITS)

    def start_process():
        return subprocess.Popen([sys.executable, "waits.py"])

    def until(wanted):
        end = time.monotonic() + LONG
        while not wanted():  # looked at without a pause: the file is open for moments only
            assert time.monotonic() < end

    first = start_process()
    until(lambda: len_of("swept") == 4)  # the head, and all rows but that which waits
    second = start_process()
    table = os.path.abspath("swept/table.csv")
    until(lambda: table in open_files(second.pid) or second.poll() is not None)
    Path("go").touch()
    assert first.wait() == 0
    if second.wait() != 0:  # a busy machine outlasts its patience
        assert start_process().wait() == 0
    assert Path("calls").read_text() == "xxxx"
    assert [row["a"] for row in rows("swept")] == ["3", "1", "2", "4"]


def open_files(pid):
    found = set()
    for link in Path(f"/proc/{pid}/fd").glob("*"):
        with contextlib.suppress(OSError):
            found.add(os.readlink(link))
    return found


@pytest.mark.parametrize("held", ["partial", "closure"])
def test_nobody_can_tell_what_a_function_holds_besides_its_text(held):
    def make_score(value):
        return lambda point: value

    for value in (1.0, 2.0):
        function = functools.partial(_second, value) if held == "partial" else make_score(value)
        call = functools.partial(qc.sweep, function=function, vary={"a": [1, 2]}, out="swept")
        if value == 1.0:
            call(processes=1)
        else:
            with pytest.raises(qc.InputError, match="cannot be compared"):
                call(processes=1, resume=True)


def _second(value, point):
    return value
