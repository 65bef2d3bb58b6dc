"""quadcore and Python as processes of their own."""

from __future__ import annotations

import subprocess
import sys

from quadcore.studies import executor

QUADCORE = [sys.executable, "-m", "quadcore"]
FALL = ["run", "quadrotor", "--engine", "eigen", "--duration", "0.05"]
LONG = 120.0  # s; generous, because waiting costs nothing when things work


def run_command(*arguments, **options):
    """A command, ended; its error output must be no traceback."""
    done = subprocess.run(
        [*QUADCORE, *arguments],
        stderr=subprocess.PIPE,
        stdout=options.pop("stdout", subprocess.PIPE),
        text=True,
        errors="replace",
        timeout=LONG,
        check=False,
        **options,
    )
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr
    return done


def script(text, **options):
    return subprocess.run(
        [sys.executable, "-c", text],
        capture_output=True,
        text=True,
        timeout=LONG,
        check=False,
        **options,
    )


def run_refused(*arguments, **options):
    done = run_command(*arguments, **options)
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith("error: ") and done.stderr.count("\n") == 1
    return done.stderr


def outcomes(function, cases, processes):
    """What became of cases in parallel, by index."""
    found = {}
    executor.run_cases(function, cases, found.__setitem__, processes)
    return found
