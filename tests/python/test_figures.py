"""Figures that several processes draw, and the summary that precedes them."""

from __future__ import annotations

import os
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
    with pytest.raises(QuadcoreError, match="its process ended with status 7"):
        draw_figures(figures, 2)
    with pytest.raises(RuntimeError, match="division by zero"):
        draw_figures({**figures, "other": lambda: 1 / 0}, 2)


def test_the_summary_of_a_run_is_printed_before_its_figures_are_drawn(
    tmp_path, monkeypatch, capsys
):
    def fail(*_):
        raise QuadcoreError("cannot draw")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("quadcore.studies.figures.draw_figures", fail)
    assert main(RUN) == 2
    printed = capsys.readouterr()
    assert "final position" in printed.out and "written" not in printed.out
    assert printed.err.endswith("error: cannot draw\n")
    assert Path("out/log.csv").exists() and not Path("out/report.html").exists()


@pytest.mark.parametrize("more", [[], ["--model", "quadrotor"]])
def test_a_reader_that_needs_no_summary_still_gets_the_files(tmp_path, monkeypatch, more):
    def end(*_):
        raise BrokenPipeError

    monkeypatch.chdir(tmp_path)
    for command in ("run", "run_fleet"):
        monkeypatch.setattr(f"quadcore.cli.{command}.print_result", end)
    monkeypatch.setattr("quadcore.cli.terminal.discard_output", lambda: None)
    assert main([word for word in RUN if not more or word != "quadrotor"] + more) == 0
    assert Path("out/report.html").exists() and list(Path("out").rglob("position.png"))
