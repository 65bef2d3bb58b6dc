"""``quadcore run``: simulate one flight."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Sequence

from .._core import InputError, QuadcoreError
from ..formats.rows import Recorder
from ..simulation.clearance import Clearance
from ..simulation.controller_pilot import convert_controller_errors
from ..simulation.engines import check_wrenches, list_engines
from ..simulation.flight import count_steps, fly, list_columns
from ..simulation.log import check_log_path, make_log_file
from ..simulation.recording import DecimatedRows, FastestRotor, Recording, TrackingError
from ..studies.flight_folder import DOCUMENT
from ..studies.options import OUTPUT
from ..studies.output_folder import output_folder
from ..support import interrupts, parse
from . import options, reading, run_folder, terminal
from .command_checks import warn_of_commands, warn_of_yaw_zero
from .parser import add_command, find_group
from .run_summary import describe_result, summarize

if TYPE_CHECKING:
    from ..simulation.flight_plan import FlightPlan
    from ..simulation.live_view import LiveView
    from ..simulation.simulation import Simulation

_PATIENCE = 10.0  # s, for the browser to open a live view


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "run",
        "Simulate one flight.",
        run_flight,
        """
        quadcore run quadrotor --controller geometric --reference spiral --out out/spiral
        quadcore run hummingbird --world basic --controller mine.py --wind 3,0,0 --log mine.csv
        """,
    )
    options.add_model(parser)
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
    """Simulate, write what was asked for, and print a summary."""
    if arguments.wrenches:
        check_wrenches(arguments.engine)
    if arguments.pace is not None and not arguments.live:
        raise InputError("--pace: needs --live, which shows the flight. Add --live.")
    with output_folder(arguments.out, run_folder.FILES, DOCUMENT):
        _run(arguments)


def _run(arguments: argparse.Namespace) -> None:
    out = arguments.out
    plan = reading.make_flight_plan(arguments)
    if arguments.record is not None:
        _record_session(plan, arguments)
    simulation = plan.simulation()
    pilot = plan.pilot(simulation)
    columns = list_columns(simulation, plan.topics, pilot)
    fastest, drawn, errors = FastestRotor(simulation), None, None
    clearance = Clearance(plan.model, plan.world)
    others: list[Recorder] = [fastest, clearance]
    if pilot is not None:
        errors = TrackingError(columns)
        others.append(errors)
    terms = simulation.wrench_terms if arguments.wrenches else []
    if out is not None:
        steps = count_steps(plan.duration, simulation.dt)
        drawn = DecimatedRows(1 + steps // plan.log_every, columns, terms)
        others.append(drawn)
    files = _check_log_files(arguments)
    logs = [make_log_file(file, columns, terms, simulation.ignored) for file in files]
    described = []
    if out is not None:
        described = run_folder.write_description(arguments, plan, simulation)
    view = _open_view(arguments, plan, simulation, columns) if arguments.live else None
    if view is not None:
        others.append(view)
    recording = Recording(logs, others)
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
                pilot,
                plan.topics,
                _choose_pace(arguments),
            )
    except (QuadcoreError, KeyboardInterrupt, MemoryError) as error:
        with interrupts.hold_signals():
            for file in recording.close():
                terminal.print_message(f"log until t = {fastest.time:.6g} s: {file}")
        if view is not None and isinstance(error, QuadcoreError):
            view.page.wait_for_pages(_PATIENCE)
        raise
    elapsed = time.perf_counter() - started
    with interrupts.hold_signals():
        files = recording.close()
    result = summarize(arguments, plan, simulation, fastest, clearance, elapsed, pilot, errors)
    rows = describe_result(result)
    if drawn is not None:
        files += described
        files += run_folder.write_results(arguments, plan, simulation, drawn.log(), rows)
    if arguments.json:
        terminal.print_json({**result, "files": [str(file) for file in files]})
    elif not arguments.quiet:
        rows += [("" if i else "written", str(file)) for i, file in enumerate(files)]
        table = terminal.make_table("", "", show_header=False)
        for row in rows:
            table.add_row(*row)
        terminal.make_console().print(table)
    if view is not None:
        view.page.wait_for_pages(_PATIENCE)
    recording.check()
    warn_of_commands(simulation, plan)
    if errors is not None:
        warn_of_yaw_zero(simulation, errors.max)


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
    """Let the autopilot record its session."""
    from ..autopilots.autopilot import Autopilot

    if not isinstance(plan.controller, Autopilot):
        raise InputError("--record: needs an autopilot. Name its stack file as --controller.")
    plan.controller.record, plan.controller.words = arguments.record, arguments.words


def _choose_pace(arguments: argparse.Namespace) -> float:
    if not arguments.live:
        return 0.0
    return 1.0 if arguments.pace is None else float(arguments.pace)


def _check_log_files(arguments: argparse.Namespace) -> list[Path]:
    """Name the logs to write, and check now that they can be written after the flight."""
    files = list(arguments.log)
    if arguments.out is not None:
        files.insert(0, arguments.out / run_folder.LOG)
    for i, file in enumerate(files):
        check_log_path(file)
        if os.path.realpath(file) in [os.path.realpath(other) for other in files[:i]]:
            raise InputError(f"{file}: would be written twice. Name each log once.")
    return files
