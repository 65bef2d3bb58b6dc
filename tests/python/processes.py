"""quadcore and Python as processes of their own."""

from __future__ import annotations

import atexit
import functools
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from quadcore.studies import executor

QUADCORE = [sys.executable, "-m", "quadcore"]
FALL = ["run", "quadrotor", "--engine", "eigen", "--duration", "0.05"]
FORKS = Path(__file__).with_name("forks.py")
# As they were before any test changed them: the process outlives the test that starts it.
ENVIRONMENT, TEMPORARY = dict(os.environ), tempfile.gettempdir()
LONG = 120.0  # s; generous, because waiting costs nothing when things work


@functools.lru_cache(maxsize=None)
def start_server():
    """Start the process whose forks run quadcore and Python, and return its address."""
    folder = tempfile.TemporaryDirectory(prefix="forks", dir=TEMPORARY)
    address = f"{folder.name}/socket"
    server = subprocess.Popen(
        [sys.executable, str(FORKS), address],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=ENVIRONMENT,
    )
    assert server.stdout.readline() == b"ready\n"
    atexit.register(lambda: (server.stdin.close(), server.wait(), folder.cleanup()))
    return address


def list_client(program):
    """List the words that run a program of `stand_in` in a fork."""
    return [sys.executable, "-IS", str(FORKS), start_server(), program]


def run_command(*arguments, **options):
    """A command, ended; its error output must be no traceback.

    Without options of the process, it runs in a fork, which starts a second sooner.
    """
    program = QUADCORE if options else list_client("run_quadcore")
    done = subprocess.run(
        [*program, *arguments],
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
