"""What ``--help`` says is what happens."""

from __future__ import annotations

import argparse
import shlex

import pytest
from processes import run_refused

from quadcore.cli import main, make_parser
from quadcore.simulation.engines import ENGINE, STUDY_ENGINE

PARSERS = next(iter(make_parser()._subparsers._group_actions)).choices
NOTHING = (None, False, [], argparse.SUPPRESS)
"""Defaults without which nothing is done."""


def read_help(capsys, command):
    with pytest.raises(SystemExit):
        main([command, "--help"])
    return " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("command", PARSERS)
def test_help_tells_the_default_of_every_option(command):
    for action in PARSERS[command]._actions:
        if action.required or action.default in NOTHING or action.dest == "port":
            continue
        values = action.default if isinstance(action.default, list) else [action.default]
        written = ",".join(f"{x:g}" if isinstance(x, float) else str(x) for x in values)
        assert f"(default: {written}" in action.help, action.dest


def test_help_tells_what_studies_fly_where_from_and_where_to(capsys):
    for command in ("evaluate", "sweep", "tune", "fit"):
        assert f"(default: {STUDY_ENGINE}) --" in read_help(capsys, command)
    assert f"(default: {ENGINE}) --dt" in read_help(capsys, "run")
    for command in ("evaluate", "tune"):
        assert "pose of the frame link in m and rad (default: on the reference)" in read_help(
            capsys, command
        )
    assert "(default: on the reference, or 0,0,10 with --commands)" in read_help(capsys, "sweep")
    assert "summary and plots (default: out/sweep)" in read_help(capsys, "sweep")


@pytest.mark.parametrize("command", PARSERS)
def test_help_is_grouped_and_ends_with_an_example_that_the_command_reads(command):
    parser = PARSERS[command]
    heading, *lines = parser.epilog.replace("\\\n", "").splitlines()
    assert heading in ("example:", "examples:") and lines
    for line in lines:
        program, *words = shlex.split(line.partition(">")[0])
        assert program == "quadcore" and words[0] == command
        make_parser().parse_args(words)
    shared = {action.dest for action in parser._optionals._group_actions}
    assert shared <= {"help", "port", "socket", "timeout", "output"}


def test_help_of_the_program_says_what_it_is_and_which_engine_is_the_default(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    help_text = capsys.readouterr().out
    assert "\n\nMultirotor simulator and controller test bench.\n\n" in help_text
    assert "run, compare, serve and export-fmu use the engine gazebo11" in help_text
    assert "quadcore run quadrotor" in help_text.splitlines()[-1]


def test_only_close_options_are_suggested(in_empty_folder):
    assert "--realtime. See" in run_refused("run", "quadrotor", "--realtime")
    assert "Did you mean '--json'?" in run_refused("run", "quadrotor", "--jsn")


@pytest.mark.parametrize(
    "words, expected",
    [
        (["tune", "pd", "-o", "gains.yaml"], "tuning writes no log. Leave --log-every out"),
        (["export-fmu", "quadrotor", "-o", "x.fmu"], "an FMU writes no log. Leave --log-every out"),
    ],
)
def test_what_writes_no_log_thins_none(words, expected, in_empty_folder):
    assert expected in run_refused(*words, "--log-every", "5")
