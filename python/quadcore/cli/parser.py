"""Argument parser of ``quadcore`` and its commands."""

from __future__ import annotations

import argparse
import re
import sys
import textwrap
from typing import Any, Callable, NoReturn, Sequence

from .._core import InputError
from ..studies.option_info import GROUPS
from ..support.parameters import suggest


def end_sentence(message: str) -> str:
    """Add a full stop unless the message ends with a full stop or a question mark."""
    return message if message.endswith((".", "?")) else f"{message}."


class Parser(argparse.ArgumentParser):
    """Argument parser that raises `InputError` for invalid options."""

    def error(self, message: str) -> NoReturn:  # noqa: D102
        raise InputError(f"{end_sentence(message)} See {self.prog} --help.")

    def parse_known_args(self, *given: Any, **named: Any) -> Any:  # type: ignore[override]  # noqa: D102
        read, unknown = super().parse_known_args(*given, **named)
        if unknown:  # the command reports them, not the main parser
            options = [word.partition("=")[0] for word in unknown if word.startswith("-")]
            near = suggest(options[0], list(self._option_string_actions)) if options else ""
            self.error(f"unrecognized arguments: {' '.join(unknown)}.{near}")
        return read, unknown

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            near = suggest(str(value), [str(choice) for choice in action.choices or ()])
            raise argparse.ArgumentError(action, f"{error.message}.{near}") from None

    def exit(self, status: int = 0, message: str | None = None) -> NoReturn:  # noqa: D102
        sys.stdout.flush()  # report a full disk while this is still possible
        super().exit(status, message)


def add_command(
    commands: Any, name: str, summary: str, action: Callable[..., None], example: str
) -> Any:
    """Add a command, and return its parser.

    Parameters
    ----------
    commands
        Subparsers of ``quadcore``.
    name
        Name of the command.
    summary
        Summary in one sentence.
    action
        Function called with the parsed arguments.
    example
        One or more command lines for the end of the help.
    """
    lines = textwrap.dedent(example).strip()
    heading = "examples" if "\nquadcore" in lines else "example"
    parser = commands.add_parser(
        name,
        help=summary[0].lower() + summary[1:].rstrip("."),
        description=summary,
        epilog=f"{heading}:\n{textwrap.indent(lines, '  ')}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    # "-1,0,10" is a value, but argparse treats it as an option unless it looks like a number.
    parser._negative_number_matcher = re.compile(r"^-[\d.]")
    parser.set_defaults(action=action)
    for title in GROUPS:
        parser.add_argument_group(title)
    return parser


def find_group(parser: argparse.ArgumentParser, title: str) -> Any:
    """Return the option group of a command with this title."""
    return next(group for group in parser._action_groups if group.title == title)


def complete_from(action: argparse.Action, names: Sequence[str]) -> None:
    """Let a shell complete an argument from names; if no name matches, it completes files."""
    action.completer = lambda **_: list(names)  # type: ignore[attr-defined]
