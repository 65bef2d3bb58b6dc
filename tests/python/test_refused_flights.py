"""Exit status of studies: bad input if nothing could fly for that, else a flight that failed."""

from __future__ import annotations

from pathlib import Path

import pytest

from quadcore.cli import main

SLOW = "drone_plugin.sim_slow"
SPIRAL = "--reference spiral --duration 0.1 --quiet --no-plots"

pytestmark = pytest.mark.usefixtures("in_empty_folder")


@pytest.fixture(autouse=True)
def flies(in_empty_folder):
    Path("flies.py").write_text(
        "def hover(t, state, reference):\n    return [471, -471, 471, -471]\n"
        "def fails(t, state, reference):\n    raise ValueError('no idea')\n"
    )


@pytest.mark.parametrize(
    ("command", "told"),
    [
        (
            f"compare quadrotor --vary {SLOW}=1,2 --quiet",
            "2 of 2 flights were refused; the first, no. 1 (sim_slow 1): ",
        ),
        (
            f"compare quadrotor --vary engine=eigen,ode --controller flies:nope {SPIRAL}",
            "2 of 2 flights were refused; the first, no. 1 (engine eigen): controller 'flies:nope'",
        ),
        (
            f"evaluate --controller nowhere:law {SPIRAL} --seeds 2",
            "2 of 2 flights were refused; the first, nowhere:law on spiral in eigen, seed 0: ",
        ),
        (
            f"sweep --controller nowhere:law {SPIRAL} --seeds 2",
            "2 of 2 flights were refused; the first, row 0: controller 'nowhere:law': ",
        ),
    ],
)
def test_flights_that_are_all_refused_are_bad_input(capsys, command, told):
    assert main(command.split()) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {told}") and error.count("\n") == 1


@pytest.mark.parametrize(
    "command",
    [
        f"compare quadrotor --vary {SLOW}=1,10 --duration 0.1 --quiet",
        f"evaluate --controller nowhere:law,flies:hover {SPIRAL}",
        f"evaluate --controller nowhere:law,flies:fails {SPIRAL}",
        f"sweep --controller nowhere:law,flies:hover {SPIRAL}",
        f"sweep --controller flies:fails {SPIRAL}",
    ],
)
def test_flights_of_which_some_flew_are_flights_that_failed(capsys, command):
    assert main(command.split()) == 3
    assert " flights failed; the first, " in capsys.readouterr().err
