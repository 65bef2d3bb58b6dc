"""``quadcore run``: one flight."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InputError, QuadcoreError
from ..formats.rows import Recorder
from ..simulation.controller_pilot import Guided, controller_errors_as_failures
from ..simulation.engines import check_wrenches, list_engines
from ..simulation.flight import columns_of, fly, steps_within
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import check_log_path, log_file
from ..simulation.recording import TAIL, Errors, Fastest, Recording, Thinned
from ..simulation.simulation import Simulation
from ..simulation.trajectory import is_slow, per_command
from ..support import interrupts
from ..support.output_files import make_folder
from ..support.rotation import roll_pitch_yaw
from . import options, terminal
from .command_checks import warn_of_commands


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = options.subparser(commands, "run", "Fly once.", run)
    options.add_model(parser)
    options.add_flight(parser, flown=list_engines())
    options.add_commands(parser)
    options.add_controller(parser)
    options.add(parser, "controller_rate", "delay", "scenario")
    options.add_out(parser, "log.csv and plots")
    parser.add_argument(
        "--log",
        metavar="FILE",
        type=Path,
        action="append",
        default=[],
        help="write the log here, .csv, .mat or .bag; repeatable",
    )
    options.add_log_topics(parser)
    options.add_wrenches(parser)


def run(arguments: argparse.Namespace) -> None:
    """Fly, write what was asked for, and print a summary."""
    plan = options.flight_plan(arguments)
    simulation = plan.simulation()
    pilot = plan.pilot(simulation)
    columns = columns_of(simulation, plan.topics, pilot)
    fastest, drawn, errors = Fastest(simulation), None, None
    others: list[Recorder] = [fastest]
    if pilot is not None:
        errors = Errors(columns)
        others.append(errors)
    if arguments.wrenches:
        check_wrenches(simulation.engine)
    terms = simulation.wrench_terms if arguments.wrenches else []
    if arguments.out is not None and not arguments.no_plots:
        steps = steps_within(plan.duration, simulation.dt)
        drawn = Thinned(1 + steps // plan.log_every, columns, terms)
        others.append(drawn)
    files = _log_files(arguments)
    logs = [log_file(file, columns, terms, simulation.ignored) for file in files]
    recording = Recording(logs, others)
    started = time.perf_counter()
    try:
        with terminal.progress(arguments.quiet) as progress, controller_errors_as_failures(
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
            )
    except (QuadcoreError, KeyboardInterrupt, MemoryError):
        with interrupts.hold_signals():
            for file in recording.close():
                terminal.say(f"log until t = {fastest.time:.6g} s: {file}")
        raise
    elapsed = time.perf_counter() - started
    with interrupts.hold_signals():
        files = recording.close()
    size = per_command(simulation)
    if drawn is not None:
        log = drawn.log()
        log.per_command = size
        log.title = ", ".join(filter(None, (_what(simulation), log.title)))
        files += log.plot(arguments.out)
    if not arguments.quiet:
        rows = _flown(simulation, fastest.speed, size, elapsed)
        if pilot is not None and errors is not None:
            rows += _guided(arguments, plan, pilot, errors)
        rows += [("" if i else "written", str(file)) for i, file in enumerate(files)]
        table = terminal.table("", "", show_header=False)
        for row in rows:
            table.add_row(*row)
        terminal.console().print(table)
    recording.check()
    warn_of_commands(simulation, plan)


def _log_files(arguments: argparse.Namespace) -> list[Path]:
    """Name the logs to write and try each now: after the flight would be too late."""
    files = list(arguments.log)
    if arguments.out is not None:
        make_folder(arguments.out)
        files.insert(0, arguments.out / "log.csv")
    for i, file in enumerate(files):
        check_log_path(file)
        if os.path.realpath(file) in [os.path.realpath(other) for other in files[:i]]:
            raise InputError(f"{file}: would be written twice; name each log once")
    return files


def _what(simulation: Simulation) -> str:
    return f"{simulation.model.name}, {simulation.engine}"


def _flown(
    simulation: Simulation, fastest: float, size: float, elapsed: float
) -> list[tuple[str, str]]:
    steps = round(simulation.time / simulation.dt)
    attitude = np.degrees(roll_pitch_yaw(simulation.state.orientation))
    commanded = f", as commanded {fastest / size:.1f}" if is_slow(size) else ""
    rows = [
        ("flown", _what(simulation)),
        ("duration", f"{simulation.time:.9g} s"),
        ("steps", f"{steps}, {steps / elapsed:,.0f} per s, log included"),
        ("final position", f"{_fixed(simulation.state.position, 6)} m"),
        ("final roll, pitch, yaw", f"{_fixed(attitude, 4)} deg"),
        ("fastest rotor", f"{fastest:.3f} rad/s{commanded}"),
    ]
    counts = [
        simulation.topic(name)["steps"]
        for name, topic in simulation.topics.items()
        if topic.kind == "saturation"
    ]
    if counts:
        rows.append(("saturated steps", f"{max(counts):.0f}"))
    return rows


def _guided(
    arguments: argparse.Namespace, plan: FlightPlan, pilot: Guided, errors: Errors
) -> list[tuple[str, str]]:
    """Rows on how well the controller did."""
    reference = arguments.reference or "hover at the spawn"
    begins = ", which the flight begins on" if plan.on_reference else ""
    late = f"the last {TAIL:g} s" if plan.duration > TAIL else "the flight"
    return [
        ("controller", f"{arguments.controller}, {pilot.rate:g} Hz, delay {pilot.delay:g} s"),
        ("reference", f"{reference}{begins}"),
        ("max error", f"{errors.max:.4g} m, of {late} {errors.final:.4g} m"),
        ("RMS error", f"{errors.rms:.4g} m"),
        ("saturated updates", f"{pilot.saturated} of {pilot.updates}"),
    ]


def _fixed(values: np.ndarray, digits: int) -> str:
    # Rounded before -0 becomes 0, so that no -0.0000 is printed.
    return ", ".join(f"{round(float(value), digits) + 0.0:.{digits}f}" for value in values)
