"""Comparison of a recorded flight with the mathematical model and the engines."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Callable, Iterator, NamedTuple, Optional, Sequence, Union

import numpy as np

from ..._core import FlightError, InputError
from ...simulation.commands import check_commands
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...simulation.state import State
from ...studies.fit.record import read_record
from ...studies.flight_differences import (
    DifferenceSizes,
    compute_differences,
    list_states,
    summarise_differences,
)
from ...support.output_files import encode_text
from ..chapter2 import GYROSTAT, MathematicalModel, Terms, Vehicle
from ..chapter2.vehicle import list_command_order

MODELS = {"chapter 2": Terms(), "chapter 2, as a gyrostat": GYROSTAT}


class Replay(NamedTuple):
    """Difference between a recording and a simulation with the same start and commands."""

    plant: str
    """Key of `MODELS`, or name of an engine."""
    difference: Optional[DifferenceSizes]
    """Recording minus simulation; None if the simulation failed."""
    failure: str
    """Reason why the difference is missing; "" for success."""


def replay(
    plan: FlightPlan,
    recording: Union[str, Path],
    commands: Union[str, Path, np.ndarray, None],
    engines: Sequence[str],
) -> Iterator[Replay]:
    """Simulate a recorded flight with the mathematical model and several engines.

    Parameters
    ----------
    plan
        Vehicle and world. The initial state is that of the recording.
    recording
        Log file: .csv, .mat or .bag.
    commands
        Table or file of commands. Default: topic ``vel_cmd`` of the recording.
    engines
        Names of the engines.

    Raises
    ------
    InputError
        If the recording or the commands are invalid, or do not match the vehicle.
    """
    log = Log.of_file(recording)
    vehicle = replace(plan, engine="eigen").simulation()
    if len(log) < 2:
        raise InputError(f"{recording}: has one row. Record a flight.")
    table = _read_commands(recording, commands, vehicle.rotor_count)
    if table[0, 0] > log.time[0] + 1e-9:
        raise InputError(
            f"{recording}: begins at t = {log.time[0]:g}, the commands at {table[0, 0]:g}. Give "
            "those of the whole recording."
        )
    duration = float(log.time[-1] - log.time[0])
    start = _read_state(log, vehicle.state.copy())
    order = list_command_order(vehicle)
    in_order = start.copy()
    in_order.rotor_velocity = start.rotor_velocity[order]
    due = table[np.searchsorted(table[:, 0], log.time[0] + 1e-9, side="right") - 1 :]
    for name, terms in MODELS.items():
        model = MathematicalModel(Vehicle.of(vehicle), terms)
        yield _replay(name, log, partial(model.fly, duration, due, in_order, vehicle.dt))
    for engine in engines:
        simulation = replace(plan, engine=engine).simulation()
        simulation.set_state(start)
        yield _replay(engine, log, partial(simulation.run, duration, table))


def _read_commands(
    recording: Union[str, Path], commands: Union[str, Path, np.ndarray, None], rotors: int
) -> np.ndarray:
    if commands is None:
        commands = read_record(recording, rotors).commands
    if commands is None:
        if Path(recording).suffix.lower() != ".bag":
            raise InputError(
                f"{recording}: has no topic vel_cmd. Give the --commands of the flight."
            )
        commands = recording
    return check_commands(commands, rotors)


def _read_state(log: Log, state: State) -> State:
    """Return the first state of a recording without rotor angles, which have no effect."""
    rotors = log.rotor_velocity.shape[1]
    if rotors != len(state.rotor_velocity):
        raise InputError(
            f"the recording has {rotors} rotors, the model {len(state.rotor_velocity)}"
        )
    state.time = float(log.time[0])
    state.position = log.position[0]
    state.orientation = log.orientation[0] / np.linalg.norm(log.orientation[0])
    state.linear_velocity = log.linear_velocity[0]
    state.angular_velocity = log.angular_velocity[0]
    state.rotor_velocity = log.rotor_velocity[0]
    return state


def _replay(name: str, log: Log, fly: Callable[[], Log]) -> Replay:
    try:
        flown = fly()
    except FlightError as error:
        return Replay(name, None, str(error))
    apart = compute_differences(flown, log)
    return Replay(
        name, summarise_differences(apart, list(list_states(log.rotor_velocity.shape[1]))), ""
    )


def write_table(rows: Sequence[Replay], rotors: int) -> bytes:
    """Write all differences as CSV: plant, state, unit, maximum, RMS, final, failure."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["plant", "state", "unit", "max", "rms", "final", "failure"])
    for row in rows:
        if row.difference is None:
            writer.writerow([row.plant, "", "", "", "", "", row.failure])
            continue
        for state, unit in list_states(rotors).items():
            parts = (row.difference.max, row.difference.rms, row.difference.final)
            writer.writerow([row.plant, state, unit, *(repr(part[state]) for part in parts), ""])
    return encode_text(stream.getvalue())
