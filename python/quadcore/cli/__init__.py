"""The command ``quadcore``."""

from __future__ import annotations

import argparse
import os
import sys
import textwrap
from typing import Sequence

from .. import __version__
from .._core import FlightError, QuadcoreError
from ..report.drawing import FORMATS, use_formats
from ..report.run_record import record_command
from ..simulation.engines import ENGINE, STUDY_ENGINE
from ..support import interrupts
from ..support.output_files import printable_name
from . import (
    autopilot,
    benchmark,
    compare,
    completion,
    convert,
    doctor,
    evaluate,
    examples,
    export_fmu,
    fit,
    info,
    list_names,
    measure,
    play,
    plot,
    predict,
    run,
    serve,
    sweep,
    terminal,
    tune,
    validate,
)
from .parser import Parser

_COMMANDS = (
    info,
    run,
    validate,
    compare,
    evaluate,
    benchmark,
    measure,
    sweep,
    play,
    plot,
    tune,
    fit,
    predict,
    convert,
    serve,
    autopilot,
    export_fmu,
    list_names,
    examples,
    doctor,
    completion,
)

_DESCRIPTION = (
    "Multirotor simulator and controller test bench.",
    f"By default run, compare, serve and export-fmu use the engine {ENGINE}; evaluate, sweep, "
    f"tune, fit, predict and benchmark use {STUDY_ENGINE}; validate compares all engines.",
)

_EPILOG = """\
Each command prints its options and an example with --help.

example:
  quadcore run quadrotor --controller geometric --reference spiral --out out/spiral"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line, and return its exit status.

    Parameters
    ----------
    argv
        Arguments after the command name (default: those of the process).

    Returns
    -------
    int
        0 for success, 2 for bad input, 3 for a failed flight. An error is a line ``error: ...`` on
        standard error. 130, 143 and 129 mean SIGINT, SIGTERM and SIGHUP; the data so far are kept.
    """
    terminal.prepare_streams()
    try:
        status = _run_command(argv)
    except KeyboardInterrupt as stop:
        terminal.print_message("interrupted")
        status = interrupts.exit_status(stop)
    return status


def _run_command(argv: Sequence[str] | None) -> int:
    try:
        with interrupts.raise_on_signals(), terminal.print_warnings():
            words = list(sys.argv[1:] if argv is None else argv)
            parser = make_parser()
            if "_ARGCOMPLETE" in os.environ:
                completion.complete(parser)
            if not words:
                parser.print_help()
            arguments = parser.parse_args(words)
            if "action" not in arguments:
                parser.error("name a COMMAND")
            arguments.words = words
            with record_command(words), use_formats(getattr(arguments, "format", FORMATS[:1])):
                arguments.action(arguments)
            sys.stdout.flush()
    except QuadcoreError as error:
        terminal.print_message(f"error: {error}")
        return 3 if isinstance(error, FlightError) else 2
    except MemoryError:
        terminal.print_message("error: out of memory. Shorten the log with --log-every.")
        return 2
    except BrokenPipeError:
        # The reader, such as `head`, needs no more output.
        terminal.discard_output()
    except OSError as error:
        terminal.discard_output()
        where = printable_name(error.filename) if error.filename else "standard output"
        terminal.print_message(f"error: {where}: {error.strerror or error}")
        return 2
    return 0


def make_parser() -> argparse.ArgumentParser:
    """Make the parser for all commands."""
    parser = Parser(
        prog="quadcore",
        description="\n\n".join(textwrap.fill(part, 78) for part in _DESCRIPTION),
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"quadcore {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND")
    for command in _COMMANDS:
        command.register(commands)
    return parser
