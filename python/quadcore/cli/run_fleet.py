"""``quadcore run`` with several vehicles in one world."""

from __future__ import annotations

import argparse
import itertools
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from .._core import FlightError, InputError, QuadcoreError
from ..model.obstacles import draw_world
from ..model.visuals import read_vehicle
from ..simulation.controller_pilot import convert_controller_errors
from ..simulation.fleet import Fleet, name_vehicles
from ..simulation.fleet_clearance import FleetClearance
from ..simulation.fleet_flight import FlightOfVehicle, fly_fleet
from ..simulation.trajectory import find_speed_limit
from ..studies.flight_folder import DOCUMENT, WrittenFlight, write_flights
from ..studies.output_folder import output_folder
from ..support import interrupts
from . import reading, run_folder, terminal
from .run_summary import describe_result
from .run_vehicle import RunVehicle, print_result

MODEL = "--model"

_OF_ALL = (
    "engine",
    "world",
    "at",
    "dt",
    "duration",
    "log_every",
    "wrenches",
    "out",
    "no_plots",
    "format",
    "json",
    "quiet",
)
_OF_ONE = ("live", "pace", "record")


def run_fleet(arguments: argparse.Namespace) -> None:
    """Simulate several vehicles, write the requested files, and print a summary of each."""
    vehicles = split_vehicles(arguments)
    for vehicle in vehicles:
        for name in _OF_ONE:
            if getattr(vehicle, name):
                raise InputError(f"--{name}: is for one vehicle. Leave it out with --model.")
        for name in _OF_ALL:
            if getattr(vehicle, name) != getattr(vehicles[0], name):
                raise InputError(
                    f"--{name.replace('_', '-')}: is the same for all vehicles. Give it before the "
                    f"first {MODEL}."
                )
    logs = [log for vehicle in vehicles for log in vehicle.log]
    for log in logs:
        if logs.count(log) > 1:
            raise InputError(f"{log}: would be written twice. Give --log after each {MODEL}.")
    plans = [reading.make_flight_plan(vehicle) for vehicle in vehicles]
    names = [vehicle.name or plan.model.name for vehicle, plan in zip(vehicles, plans)]
    simulations = name_vehicles(names, [plan.simulation() for plan in plans])
    fleet = Fleet(simulations)
    out = vehicles[0].out
    with ExitStack() as stack:
        stack.enter_context(output_folder(out, (run_folder.PAGE, DOCUMENT), DOCUMENT))
        flown: Dict[str, RunVehicle] = {}
        for given, plan, (name, simulation) in zip(vehicles, plans, simulations.items()):
            for state in plan.list_placements(simulation):
                simulation.set_state(state)
            if out is not None:
                given.out = out / _check_folder_name(name)
                stack.enter_context(output_folder(given.out, run_folder.FILES, DOCUMENT))
            flown[name] = RunVehicle(given, plan, simulation)
        _check_starts(flown)
        _fly(fleet, flown, out)


def split_vehicles(arguments: argparse.Namespace) -> List[argparse.Namespace]:
    """Parse the options of each vehicle: those before the first ``--model``, then its own."""
    words = list(arguments.words[1:])
    starts = [i for i, word in enumerate(words) if word.split("=", 1)[0] == MODEL]
    common = words[: starts[0]]
    if arguments.model is not None:
        raise InputError(f"MODEL and {MODEL} exclude each other. Name each vehicle by {MODEL}.")
    vehicles = []
    for number, (start, end) in enumerate(zip(starts, [*starts[1:], len(words)])):
        own = words[start:end]
        model = own.pop(0).partition("=")[2] or own.pop(0)
        read = arguments.parser.parse_args([*common, *own, "--", model])
        read.words = arguments.words
        if not any(word.split("=", 1)[0] == "--seed" for word in own):
            read.seed += number  # otherwise equal sensors have equal noise
        vehicles.append(read)
    return vehicles


def _check_starts(flown: Dict[str, RunVehicle]) -> None:
    """Raise `InputError` if two vehicles start at the same position."""
    for (one, first), (other, second) in itertools.combinations(flown.items(), 2):
        if (first.simulation.state.position == second.simulation.state.position).all():
            raise InputError(
                f"vehicles '{one}' and '{other}' start at the same place. Give --spawn or "
                f"--reference after each {MODEL}."
            )


def _check_folder_name(name: str) -> str:
    if name in ("", ".", "..") or "/" in name:
        raise InputError(f"vehicle '{name}': this is no name of a folder. Give --name.")
    return name


def _fly(fleet: Fleet, flown: Dict[str, RunVehicle], out: Optional[Path]) -> None:
    first = next(iter(flown.values()))
    clearance = FleetClearance({name: vehicle.plan.model for name, vehicle in flown.items()})
    flights = []
    for name, vehicle in flown.items():
        vehicle.recorders.append(clearance.recorder(name))
        recording = vehicle.open_recording()
        flights.append(
            FlightOfVehicle(
                name,
                vehicle.simulation,
                recording.receive,
                vehicle.plan.commands,
                vehicle.pilot,
                recording.wrenches,
                vehicle.plan.topics,
            )
        )
    started = time.perf_counter()
    try:
        with terminal.show_progress(first.arguments.quiet) as progress, _name_controller_errors(
            fleet
        ):
            fly_fleet(fleet, first.plan.duration, flights, first.plan.log_every, progress)
    except (QuadcoreError, KeyboardInterrupt, MemoryError):
        with interrupts.hold_signals():
            for vehicle in flown.values():
                vehicle.keep_logs()
        raise
    elapsed = time.perf_counter() - started
    with interrupts.hold_signals():
        logs = {name: vehicle.recording.close() for name, vehicle in flown.items()}
    results = {}
    for name, vehicle in flown.items():
        results[name] = {**vehicle.summarize(elapsed), **clearance.summarize(name)}
        if fleet.warnings:
            unsimulated = [*results[name].get("unsimulated", []), "contact between vehicles"]
            results[name]["unsimulated"] = unsimulated
    rows = {name: describe_result(result) for name, result in results.items()}
    is_shown = not (first.arguments.json or first.arguments.quiet)
    if is_shown:
        with terminal.discard_if_unread():
            for name in flown:  # before plots and pages, which take longer than the flight
                print_result(rows[name], name)
    files = {name: flown[name].write_results(logs[name], rows[name]) for name in flown}
    shared = [] if out is None else _write_shared(out, flown, rows)
    if is_shown:
        terminal.print_written([*itertools.chain(*files.values()), *shared])
    elif first.arguments.json:
        _print_json(results, files, shared)
    for vehicle in flown.values():
        vehicle.recording.check()
        vehicle.warn()


@contextmanager
def _name_controller_errors(fleet: Fleet) -> Iterator[None]:
    """Convert controller errors as `convert_controller_errors`, and add the vehicle's name."""
    simulation = next(iter(fleet.vehicles.values()))
    try:
        with convert_controller_errors(simulation):
            yield
    except FlightError as error:
        cause = error.__cause__ or error
        name = getattr(cause, "vehicle", None)
        if name is None:
            raise
        named = FlightError(f"vehicle '{name}': {error}")
        named.time = error.time
        raise named from error


def _write_shared(
    out: Path, flown: Mapping[str, RunVehicle], rows: Mapping[str, Sequence[Tuple[str, str]]]
) -> List[Path]:
    """Write the page with all vehicles, and the list of all flights."""
    from ..report.page import write_page  # jinja2 is slow to import
    from ..report.player import PlayerFlight, make_section

    shown, written = [], []
    for name, vehicle in flown.items():
        limit = find_speed_limit(vehicle.simulation.rotors)
        assert vehicle.drawn is not None
        drawn = read_vehicle(vehicle.plan.model)
        shown.append(PlayerFlight(name, vehicle.drawn.log(), drawn, speed_limit=limit))
        log = f"{name}/{run_folder.LOG}"
        plan = vehicle.plan
        written.append(WrittenFlight(name, log, plan.model, plan.world, speed_limit=limit))
    world = next(iter(flown.values())).simulation.world
    page = out / run_folder.PAGE
    write_page(
        page,
        "run.html",
        title=", ".join(flown),
        rows=[(name, text) for name in flown for text in _describe_vehicle(rows[name])],
        player=make_section(shown, draw_world(world)),
        plots=[],
    )
    return [*write_flights(out, written), page]


def _describe_vehicle(rows: Sequence[Tuple[str, str]]) -> List[str]:
    return [f"{name}: {text}" for name, text in rows]


def _print_json(
    results: Mapping[str, Mapping[str, Any]],
    files: Mapping[str, Sequence[Path]],
    shared: Sequence[Path],
) -> None:
    """Print the results of all vehicles as JSON."""
    vehicles = {
        name: {**result, "files": [str(file) for file in files[name]]}
        for name, result in results.items()
    }
    terminal.print_json({"vehicles": vehicles, "files": [str(file) for file in shared]})
