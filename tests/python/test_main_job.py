"""What scripts/fly and scripts/fly_controllers.py fly, in short."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from quadcore.control import references

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def program(monkeypatch):
    def load(path):
        spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, spec.name, module)
        monkeypatch.syspath_prepend((ROOT / path).parent)  # as Python does for what it starts
        spec.loader.exec_module(module)
        return module

    return load


def test_the_spiral_is_drawn_and_logged(program, tmp_path, capsys):
    spiral = program("examples/spiral.py")
    spiral.SETTINGS["duration"] = 1
    logs = spiral.fly()
    assert sorted({controller for controller, _ in logs}) == ["geometric", "pid"]
    figure = spiral.picture(logs)
    drawn = [line for axes in figure.axes for line in axes.lines if len(line.get_xdata()) > 1]
    assert len(drawn) == 2 * len(logs) == 12
    spiral.write(logs, tmp_path / "out")
    names = [f"{controller}_{engine}.csv" for controller, engine in logs]
    assert sorted(path.name for path in (tmp_path / "out/logs").iterdir()) == sorted(names)
    assert (tmp_path / "out/engines.png").stat().st_size > 10_000
    assert "6 logs" in capsys.readouterr().out


def test_what_works_ends_well_and_the_printed_gains_differ_in_the_controller_only():
    files = [ROOT / "config" / f"{name}.yaml" for name in ("spiral", "printed_gains")]
    works, crashes = (yaml.safe_load(file.read_text()) for file in files)
    assert (works.pop("controller"), crashes.pop("controller")) == (
        ["pid", "geometric"],
        ["pid_thesis"],
    )
    assert works == crashes


def test_the_flights_of_the_controllers_are_held_against_their_limits(program, monkeypatch, capsys):
    script = program("scripts/fly_controllers.py")
    names = {(case.name, case.engine, case.sim_slow) for case in script.cases()}
    assert len(names) == len(script.cases())
    one = replace(script.cases()[0], duration=0.2, seeds=2)
    circle = replace(one, name="circle", reference=lambda: references.circle())
    monkeypatch.setattr(
        script, "cases", lambda: [one, circle, replace(circle, limit=-1, name="fails")]
    )
    assert script.main() == 1
    rows = capsys.readouterr().out.splitlines()[1:]
    assert [row.endswith(" missed") for row in sorted(rows)] == [False, True, False]
