"""What scripts/fly and scripts/fly_laws.py fly, in short."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

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


def test_the_picture_of_the_engines_is_drawn_of_flights_that_end_early_too(program):
    spiral = program("examples/spiral.py")
    spiral.SETTINGS["duration"] = 1
    # The rotors turn more than half a turn per step once the vehicle is a kilometre off, which ends
    # the flights of the engines with hinges.
    spiral.SETTINGS["reference"] = "step:dx=1000,time=0.5"
    spiral.SETTINGS["xacro"]["max_velocity"] = 1e6
    logs = spiral.fly()
    assert len(logs) == 9
    ends_early = {engine: logs["pid_thesis", engine].time[-1] < 0.99 for _, engine in logs}
    assert ends_early == {"gazebo11": True, "ode": True, "eigen": False}
    figure = spiral.picture(logs)
    drawn = [line for axes in figure.axes for line in axes.lines if len(line.get_xdata()) > 1]
    assert len(drawn) == 18
    for line in drawn[9:]:
        assert np.nanmax(line.get_ydata()) <= 5000  # mm; no longer drawn once it is lost


def test_the_flights_of_the_laws_are_held_against_their_bars(program, monkeypatch, capsys):
    told = program("scripts/fly_laws.py")
    names = {(case.name, case.engine, case.sim_slow) for case in told.cases()}
    assert len(names) == len(told.cases())
    one = replace(told.cases()[0], duration=0.2, seeds=2)
    circle = replace(one, name="circle", reference=lambda: references.circle())
    monkeypatch.setattr(told, "cases", lambda: [one, circle, replace(circle, bar=-1, name="lost")])
    assert told.main() == 1
    rows = capsys.readouterr().out.splitlines()[1:]
    assert [row.endswith(" missed") for row in sorted(rows)] == [False, True, False]
