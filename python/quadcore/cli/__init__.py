"""The command ``quadcore``."""

from __future__ import annotations

import argparse
import os
import sys
from typing import NoReturn, Sequence

from .. import __version__, interrupts
from .._core import FlightError, InputError, QuadcoreError
from . import compare, info, run, terminal, validate


class _Parser(argparse.ArgumentParser):
    """Reports a wrong option like any other wrong input."""

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; see {self.prog} --help")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status.

    Parameters
    ----------
    argv
        Arguments after the command's name; by default those of the process.

    Returns
    -------
    int
        0 done; 2 bad input and 3 a flight that failed, each with one line ``error: ...`` on
        standard error; 130, 143, 129 ended by SIGINT, SIGTERM, SIGHUP, what was flown being kept.
    """
    try:
        with interrupts.heard():
            arguments = _parser().parse_args(argv)
            with terminal.warnings_as_lines():
                arguments.action(arguments)
            sys.stdout.flush()
    except QuadcoreError as error:
        print(f"error: {error}", file=sys.stderr)
        return 3 if isinstance(error, FlightError) else 2
    except MemoryError:
        print("error: no memory left for the log; shorten it by --log-every", file=sys.stderr)
        return 2
    except KeyboardInterrupt as stop:
        print("interrupted", file=sys.stderr)
        return interrupts.exit_status(stop)
    except BrokenPipeError:
        # The reader, such as `head`, has seen enough; the flush at exit must not fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="quadcore",
        description="A multirotor from its URDF, in flight.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"quadcore {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for command in (info, run, validate, compare):
        command.register(commands)
    return parser
