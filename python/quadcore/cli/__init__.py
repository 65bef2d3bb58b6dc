"""The command ``quadcore``."""

from __future__ import annotations

import argparse
import sys
from typing import Any, NoReturn, Sequence

from .. import __version__
from .._core import FlightError, InputError, QuadcoreError
from ..support import interrupts
from ..support.output_files import shown
from ..support.parameters import did_you_mean
from . import (
    compare,
    convert,
    evaluate,
    export_fmu,
    fit,
    info,
    play,
    plot,
    run,
    serve,
    sweep,
    terminal,
    tune,
    validate,
)

_COMMANDS = (
    info,
    run,
    validate,
    compare,
    evaluate,
    sweep,
    play,
    plot,
    tune,
    fit,
    convert,
    serve,
    export_fmu,
)


class _Parser(argparse.ArgumentParser):
    """Reports a wrong option like any other wrong input."""

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; see {self.prog} --help")

    def parse_known_args(self, *given: Any, **named: Any) -> Any:  # type: ignore[override]
        read, unknown = super().parse_known_args(*given, **named)
        if unknown:  # told by the command that does not know them
            options = [word.partition("=")[0] for word in unknown if word.startswith("-")]
            near = did_you_mean(options[0], list(self._option_string_actions)) if options else ""
            self.error(f"unrecognized arguments: {' '.join(unknown)}{near}")
        return read, unknown

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            near = did_you_mean(str(value), [str(choice) for choice in action.choices or ()])
            raise argparse.ArgumentError(action, f"{error.message}{near}") from None

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:
        sys.stdout.flush()  # while a full disk can still be told
        super().exit(status, message)


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
    terminal.prepare()
    try:
        status = _act(argv)
    except KeyboardInterrupt as stop:
        terminal.say("interrupted")
        status = interrupts.exit_status(stop)
    return status


def _act(argv: Sequence[str] | None) -> int:
    try:
        with interrupts.raise_on_signals(), terminal.warnings_as_lines():
            words = list(sys.argv[1:] if argv is None else argv)
            parser = _parser()
            if not words:
                parser.print_help()
            arguments = parser.parse_args(words)
            if "action" not in arguments:
                parser.error("name a COMMAND")
            arguments.words = words
            arguments.action(arguments)
            sys.stdout.flush()
    except QuadcoreError as error:
        terminal.say(f"error: {error}")
        return 3 if isinstance(error, FlightError) else 2
    except MemoryError:
        terminal.say("error: no memory left; make the log shorter by --log-every")
        return 2
    except BrokenPipeError:
        # The reader, such as `head`, has seen enough.
        terminal.forget_output()
    except OSError as error:
        terminal.forget_output()
        where = shown(error.filename) if error.filename else "standard output"
        terminal.say(f"error: {where}: {error.strerror or error}")
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="quadcore",
        description="A multirotor from its URDF, in flight.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"quadcore {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND")
    for command in _COMMANDS:
        command.register(commands)
    return parser
