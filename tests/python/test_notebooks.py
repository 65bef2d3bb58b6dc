"""The notebooks run from the first cell to the last, and show what their cells end with."""

from __future__ import annotations

import ast
import re
import warnings
from pathlib import Path

import pytest
from printed import check_printed

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.py"))


def cells(notebook):
    """Code of each cell, as jupytext tells them from text."""
    parts = re.split(r"^# %%(.*)\n", notebook.read_text(), flags=re.MULTILINE)
    return [code for kind, code in zip(parts[1::2], parts[2::2]) if not kind.strip()]


def run_cell(code, names):
    """What a notebook shows below a cell: its last expression, if it ends with one."""
    tree = ast.parse(code)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    if last is None:
        return ""
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    return value._repr_html_() if hasattr(value, "_repr_html_") else repr(value)


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_shows_its_results(notebook, monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "__main__"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        results = [run_cell(code, names) for code in cells(notebook)]
    assert len(results) > 3
    assert results[-1]
    page = (ROOT / "docs" / "notebooks.md").read_text()
    _, found, after = page.partition(f"`python notebooks/{notebook.name}`")
    if found:
        check_printed(after.split("```")[1].partition("\n")[2], capsys.readouterr().out, 1e-3)
    assert not [result for result in results if " at 0x" in result and "matplotlib" not in result]


def test_there_are_the_three_notebooks():
    names = [notebook.stem for notebook in NOTEBOOKS]
    assert names == ["identifying_a_vehicle", "tuning_a_controller", "why_gazebo_misled"]
