"""``quadcore autopilot``: list the bridges, check an autopilot, or replay a session."""

from __future__ import annotations

import argparse
from typing import Any

from .._core import InputError
from ..model import resources
from ..studies.option_info import VEHICLE
from . import options, run, terminal
from .parser import Parser, add_command, complete_from, find_group

_ACTIONS = ("list", "check", "replay")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "autopilot",
        "List the bridges to autopilots, check an autopilot on a bench, or replay a session.",
        run_action,
        """
        quadcore autopilot list
        quadcore autopilot check betaflight.yaml --model iris
        quadcore autopilot replay session.qcs
        """,
    )
    parser.add_argument(
        "what",
        metavar="ACTION",
        choices=_ACTIONS,
        help="list: the bridges; check: tilt a vehicle on a bench, turn each motor, and report "
        "faults; replay: repeat a recorded flight without the program",
    )
    parser.add_argument("file", metavar="FILE", nargs="?", help="stack file to check, or session")
    model = find_group(parser, VEHICLE).add_argument(
        "--model", metavar="MODEL", default="iris", help=f"{options.MODEL} (default: iris)"
    )
    complete_from(model, list(resources.list_shipped("urdf")))
    options.add_options(parser, *options.CHANGES)


def run_action(arguments: argparse.Namespace) -> None:
    """List the bridges, check an autopilot, or replay a session."""
    if arguments.what == "list":
        if arguments.file is not None:
            raise InputError(f"autopilot list takes no file. Leave out {arguments.file}.")
        _print_stacks()
    elif arguments.file is None:
        raise InputError(f"autopilot {arguments.what} needs a file. Add FILE.")
    elif arguments.what == "check":
        _check(arguments)
    else:
        _replay(arguments.file)


def _print_stacks() -> None:
    from ..autopilots.stacks import STACKS

    table = terminal.make_table("", "", show_header=False)
    for name, stack in STACKS.items():
        table.add_row(name, stack.summary)
    terminal.make_console().print(table)


def _check(arguments: argparse.Namespace) -> None:
    """Print the assignment of the rotors, and the problems of an autopilot."""
    from ..autopilots.check import check_autopilot
    from ..autopilots.stacks import read_autopilot
    from ..simulation.simulation import Simulation
    from .reading import read_model_arguments

    autopilot = read_autopilot(arguments.file)
    simulation = Simulation(
        engine="eigen", dt=1 / autopilot.rate, **read_model_arguments(arguments)
    )
    problems = check_autopilot(autopilot, simulation)
    for channel in autopilot.channels:
        print(f"motor {channel}")
    for problem in problems:
        terminal.print_message(f"problem: {problem}")
    if problems:
        count = f"{len(problems)} problem{'s' if len(problems) > 1 else ''}"
        raise InputError(f"{arguments.file}: {count}. Correct the stack or the model.")
    print("Signs of the sensors, order and spin of the motors are right.")


def _replay(file: str) -> None:
    """Repeat the recorded command with the recorded answers."""
    from ..autopilots.session import Session
    from ..autopilots.stacks import make_replay

    session = Session(file)
    parser = Parser(prog="quadcore", allow_abbrev=False)
    run.register(parser.add_subparsers())
    flight = parser.parse_args(session.about["words"])
    flight.controller = make_replay(session)
    flight.words, flight.out, flight.record, flight.log = [], None, None, []
    flight.live, flight.pace, flight.json, flight.quiet = False, None, False, True
    run.run_flight(flight)
    if not session.is_at_end:
        raise InputError(f"{file}: the recorded flight is longer. Record it again.")
    print(f"{file}: the flight is bit-identical to the recorded one.")
