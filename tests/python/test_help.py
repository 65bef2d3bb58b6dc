"""What ``--help`` says is what happens."""

from __future__ import annotations

import argparse
import inspect

import pytest
from processes import refused

import quadcore as qc
from quadcore.cli import _COMMANDS, _parser, main

COMMANDS = [command.__name__.split(".")[-1].replace("_", "-") for command in _COMMANDS]
NOTHING = (None, False, [], argparse.SUPPRESS)
"""Defaults without which nothing is done."""


def told(capsys, command):
    with pytest.raises(SystemExit):
        main([command, "--help"])
    return " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("command", COMMANDS)
def test_help_tells_the_default_of_every_option(command):
    parsers = next(iter(_parser()._subparsers._group_actions)).choices
    for action in parsers[command]._actions:
        if action.required or action.default in NOTHING or action.dest == "port":
            continue
        values = action.default if isinstance(action.default, list) else [action.default]
        written = ",".join(f"{x:g}" if isinstance(x, float) else str(x) for x in values)
        assert f"({written})" in action.help, action.dest


def test_help_tells_what_studies_fly_where_from_and_where_to(capsys):
    functions = {"evaluate": qc.evaluate, "sweep": qc.sweep, "tune": qc.tune, "fit": qc.fit}
    for command, function in functions.items():
        parameters = inspect.signature(function).parameters
        engine = parameters.get("engines", parameters.get("engine")).default
        assert f"({engine}) --world" in told(capsys, command)
    assert "(gazebo11) --world" in told(capsys, "run")
    for command in ("evaluate", "tune"):
        assert "pose of the frame in m and rad (on the reference)" in told(capsys, command)
    assert "(on the reference; with --commands 0,0,10)" in told(capsys, "sweep")
    assert "a page here (out/sweep)" in told(capsys, "sweep")


@pytest.mark.parametrize(
    "words, told",
    [
        (["tune", "pd", "-o", "gains.yaml"], "tuning writes no log; leave --log-every out"),
        (["export-fmu", "quadrotor", "-o", "x.fmu"], "an FMU writes no log; leave --log-every out"),
    ],
)
def test_what_writes_no_log_thins_none(words, told, in_empty_folder):
    assert told in refused(*words, "--log-every", "5")
