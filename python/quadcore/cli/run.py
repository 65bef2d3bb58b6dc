"""``quadcore run``: simulate one flight."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Sequence

from .._core import InputError, QuadcoreError
from ..simulation.controller_pilot import convert_controller_errors
from ..simulation.engines import check_wrenches, list_engines
from ..simulation.flight import fly
from ..studies.flight_folder import DOCUMENT
from ..studies.option_info import OUTPUT, VEHICLE
from ..studies.output_folder import output_folder
from ..support import interrupts, parse
from . import options, reading, run_folder, terminal
from .parser import add_command, find_group
from .run_summary import describe_result
from .run_vehicle import RunVehicle, print_files, print_result

if TYPE_CHECKING:
    from ..simulation.flight_plan import FlightPlan
    from ..simulation.live_view import LiveView
    from ..simulation.simulation import Simulation

_PATIENCE = 10.0  # s; time limit for the browser to open a live view


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "run",
        "Simulate one flight.",
        run_flight,
        """
        quadcore run quadrotor --controller geometric --reference spiral --out out/spiral
        quadcore run --duration 5 --model quadrotor --spawn 0,0,1 --model iris --spawn 0,0,3
        quadcore run hummingbird --world basic --controller mine.py --wind 3,0,0 --log mine.csv
        """,
    )
    options.add_model(parser, nargs="?")
    find_group(parser, VEHICLE).add_argument(
        "--model",
        dest="models",
        metavar="MODEL",
        action="append",
        default=[],
        help="one of several vehicles in one world; the options that follow are for this vehicle, "
        "those before the first --model for all; repeatable",
    )
    find_group(parser, VEHICLE).add_argument(
        "--name",
        metavar="NAME",
        help="name of a vehicle, after its --model (default: the model's, numbered if equal)",
    )
    parser.set_defaults(parser=parser)
    options.add_flight(parser, choices=list_engines())
    options.add_commands(parser)
    options.add_controller(parser)
    options.add_options(parser, "controller_rate", "delay", "scenario", "wind", "at")
    options.add_out(parser, "log, plots, page, expanded URDF and run.json")
    find_group(parser, OUTPUT).add_argument(
        "--log",
        metavar="FILE",
        type=Path,
        action="append",
        default=[],
        help="log to write, .csv, .mat or .bag; repeatable",
    )
    find_group(parser, OUTPUT).add_argument(
        "--live", action="store_true", help="show the flight in the browser as it runs"
    )
    find_group(parser, OUTPUT).add_argument(
        "--pace",
        metavar="X",
        type=parse.not_negative,
        help="simulated seconds per second with --live; 0: as fast as possible (default: 1)",
    )
    find_group(parser, OUTPUT).add_argument(
        "--record",
        metavar="FILE",
        type=Path,
        help="session of an autopilot to write, for quadcore autopilot replay",
    )
    options.add_log_topics(parser)
    options.add_wrenches(parser)
    options.add_json(parser)


def run_flight(arguments: argparse.Namespace) -> None:
    """Simulate a flight, write the requested files, and print a summary."""
    if arguments.models:
        from .run_fleet import run_fleet  # most flights have one vehicle

        return run_fleet(arguments)
    if arguments.model is None:
        arguments.parser.error("the following arguments are required: MODEL")
    if arguments.name is not None:
        raise InputError("--name: names one of several vehicles. Name each by --model.")
    if arguments.wrenches:
        check_wrenches(arguments.engine)
    if arguments.pace is not None and not arguments.live:
        raise InputError("--pace: needs --live, which shows the flight. Add --live.")
    with output_folder(arguments.out, run_folder.FILES, DOCUMENT):
        _run(arguments)


def _run(arguments: argparse.Namespace) -> None:
    plan = reading.make_flight_plan(arguments)
    if arguments.record is not None:
        _record_session(plan, arguments)
    simulation = plan.simulation()
    vehicle = RunVehicle(arguments, plan, simulation)
    view = None
    if arguments.live:
        view = _open_view(arguments, plan, simulation, vehicle.columns)
        vehicle.recorders.append(view)
    recording = vehicle.open_recording()
    started = time.perf_counter()
    try:
        with terminal.show_progress(arguments.quiet) as progress, convert_controller_errors(
            simulation
        ):
            fly(
                simulation,
                plan.duration,
                plan.commands,
                plan.log_every,
                recording.receive,
                recording.wrenches,
                progress,
                vehicle.pilot,
                plan.topics,
                _choose_pace(arguments),
            )
    except (QuadcoreError, KeyboardInterrupt, MemoryError) as error:
        with interrupts.hold_signals():
            vehicle.keep_logs()
        if view is not None and isinstance(error, QuadcoreError):
            view.page.wait_for_pages(_PATIENCE)
        raise
    elapsed = time.perf_counter() - started
    with interrupts.hold_signals():
        logs = recording.close()
    result = vehicle.summarize(elapsed)
    rows = describe_result(result)
    is_shown = not (arguments.json or arguments.quiet)
    if is_shown:
        with terminal.discard_if_unread():
            print_result(rows)  # before plots and page, which take longer than the flight
    files = vehicle.write_results(logs, rows)
    if is_shown:
        print_files(files, rows)
    elif arguments.json:
        terminal.print_json({**result, "files": [str(file) for file in files]})
    if view is not None:
        view.page.wait_for_pages(_PATIENCE)
    recording.check()
    vehicle.warn()


def _open_view(
    arguments: argparse.Namespace,
    plan: FlightPlan,
    simulation: Simulation,
    columns: Sequence[str],
) -> LiveView:
    """Show the flight in the browser of this machine."""
    from ..report.page_server import open_browser
    from ..simulation.live_view import LiveView  # jinja2 is slow to import

    view = LiveView(simulation, columns, plan.model, plan.log_every)
    if not open_browser(view.page.url) or not arguments.quiet:
        terminal.print_message(f"live view: {view.page.url}")
    return view


def _record_session(plan: FlightPlan, arguments: argparse.Namespace) -> None:
    """Make the autopilot record its session."""
    from ..autopilots.autopilot import Autopilot

    if not isinstance(plan.controller, Autopilot):
        raise InputError("--record: needs an autopilot. Name its stack file as --controller.")
    plan.controller.record, plan.controller.words = arguments.record, arguments.words


def _choose_pace(arguments: argparse.Namespace) -> float:
    if not arguments.live:
        return 0.0
    return 1.0 if arguments.pace is None else float(arguments.pace)
