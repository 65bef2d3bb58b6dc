"""Figures that several processes draw, and the summary that precedes them."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from evaluations import evaluate

from quadcore import QuadcoreError
from quadcore.cli import main
from quadcore.report.plots import panels
from quadcore.studies.evaluate.plots import list_figures
from quadcore.studies.figures import draw_figures

RUN = ["run", "quadrotor", "--engine", "eigen", "--duration", "0.1", "--out", "out"]


def test_drawings_are_bit_identical_for_any_number_of_processes():
    found = evaluate(["pd", "lqr"], ["circle", "step"], duration=0.5)
    drawings = [draw_figures(list_figures(found), processes) for processes in (1, 2, 3)]
    assert drawings[0] == drawings[1] == drawings[2]
    assert list(drawings[0]) == list(drawings[1]) and len(drawings[0]) > 5


def test_a_process_that_dies_while_it_draws_is_an_error_and_so_is_a_figure_that_cannot_be_made():
    figures = {"one": lambda: panels("one", 1)[0], "other": partial(os._exit, 7)}
    with pytest.raises(QuadcoreError, match=r"figure 'other': its process ended with status 7"):
        draw_figures(figures, 2)
    with pytest.raises(RuntimeError, match="division by zero"):
        draw_figures({**figures, "other": lambda: 1 / 0}, 2)


def test_the_summary_of_a_run_is_printed_before_its_figures_are_drawn(
    tmp_path, monkeypatch, capsys
):
    def fail(*_):
        raise QuadcoreError("cannot draw")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("quadcore.report.log_plots.draw", fail)
    assert main(RUN) == 2
    printed = capsys.readouterr()
    assert "final position" in printed.out and "written" not in printed.out
    assert printed.err.endswith("error: cannot draw\n")
    assert Path("out/log.csv").exists() and not Path("out/report.html").exists()


@pytest.mark.parametrize("more", [[], ["--model", "quadrotor"]])
def test_a_reader_that_has_ended_still_gets_the_files(tmp_path, more):
    """With standard output in a buffer, as it is unless PYTHONUNBUFFERED is set."""
    words = [word for word in RUN if not more or word != "quadrotor"] + more
    read, write = os.pipe()
    os.close(read)
    environment = {key: x for key, x in os.environ.items() if key != "PYTHONUNBUFFERED"}
    command = [sys.executable, "-m", "quadcore", *words, "--controller", "pd"]
    done = subprocess.run(
        command, cwd=tmp_path, stdout=write, stderr=subprocess.PIPE, env=environment
    )
    os.close(write)
    assert done.returncode == 0 and b"rror" not in done.stderr
    assert list(tmp_path.rglob("report.html")) and list(tmp_path.rglob("position.png"))
