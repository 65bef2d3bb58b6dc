"""Result of a flight as plain values and as lines of a summary."""

from __future__ import annotations

import argparse
import math
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from ..simulation.clearance import Clearance, Encounter
from ..simulation.controller_pilot import ControllerPilot
from ..simulation.flight_plan import FlightPlan
from ..simulation.recording import TAIL, FastestRotor, TrackingError
from ..simulation.reference_pilot import PluginPilot
from ..simulation.simulation import Simulation
from ..simulation.trajectory import is_slow, per_command
from ..support.rotation import to_roll_pitch_yaw


def summarize(
    arguments: argparse.Namespace,
    plan: FlightPlan,
    simulation: Simulation,
    fastest: FastestRotor,
    clearance: Clearance,
    elapsed: float,
    pilot: Union[ControllerPilot, PluginPilot, None],
    errors: Optional[TrackingError],
) -> Dict[str, Any]:
    """Return the result as plain values by name."""
    duration = simulation.time - simulation.world.start_time
    steps = round(duration / simulation.dt)
    size = per_command(simulation)
    result: Dict[str, Any] = {
        "model": simulation.model.name,
        "engine": simulation.engine,
        "duration": duration,
        "steps": steps,
        "steps_per_second": steps / elapsed,
        "final_position": _round(simulation.state.position, 9),
        "final_roll_pitch_yaw": _round(
            np.degrees(to_roll_pitch_yaw(simulation.state.orientation)), 7
        ),
        "max_rotor_speed": float(fastest.speed),
    }
    if is_slow(size):
        result["max_rotor_speed_commanded"] = float(fastest.speed / size)
    if simulation.world.ignored_models:
        result["ignored_models"] = simulation.world.ignored_models
    if simulation.world.ignored_elements.unsimulated:
        result["unsimulated"] = simulation.world.ignored_elements.unsimulated
    if clearance.nearest is not None:
        result["clearance"] = clearance.minimum
        result["nearest_obstacle"] = clearance.nearest._asdict()
        result["collisions"] = [collision._asdict() for collision in clearance.collisions]
    counts = [
        simulation.topic(name)["steps"]
        for name, topic in simulation.topics.items()
        if topic.kind == "saturation"
    ]
    if counts:
        result["saturated_steps"] = int(max(counts))
    if pilot is not None and errors is not None:
        result.update(
            controller=arguments.controller,
            controller_rate=float(pilot.rate),
            delay=float(pilot.delay),
            reference=arguments.reference or "hover at the spawn",
            starts_on_reference=plan.on_reference,
            max_error=errors.max,
            final_error=errors.final,
            rms_error=errors.rms,
            saturated_updates=pilot.saturated,
            updates=pilot.updates,
        )
        if pilot.summary:
            result["answers"] = pilot.summary
        if pilot.program:
            result["program"] = pilot.program
    return result


def describe_result(result: Dict[str, Any]) -> List[Tuple[str, str]]:
    """Format the result as lines, each with a name and a text."""
    commanded = ""
    if "max_rotor_speed_commanded" in result:
        commanded = f" (commanded {result['max_rotor_speed_commanded']:.1f} rad/s)"
    rows = [
        ("model", result["model"]),
        ("engine", result["engine"]),
        ("duration", f"{result['duration']:.9g} s"),
        ("steps", f"{result['steps']}, {result['steps_per_second']:,.0f} per s with logging"),
        ("final position", f"{_join_numbers(result['final_position'], 6)} m"),
        ("final roll, pitch, yaw", f"{_join_numbers(result['final_roll_pitch_yaw'], 4)} deg"),
        ("max rotor speed", f"{result['max_rotor_speed']:.3f} rad/s{commanded}"),
    ]
    if "ignored_models" in result:
        names = ", ".join(result["ignored_models"])
        rows.append(("missing in the world", f"{names}: the vehicle passes through"))
    if "unsimulated" in result:
        rows.append(("not simulated", ", ".join(result["unsimulated"])))
    if "clearance" in result:
        nearest = Encounter(**result["nearest_obstacle"])
        rows.append(("clearance", f"{result['clearance']:.4g} m from {nearest}"))
        rows.append(("collisions", _count_collisions(result["collisions"])))
    if "vehicle_clearance" in result:
        other = Encounter(**result["nearest_vehicle"])
        rows.append(("nearest vehicle", f"{result['vehicle_clearance']:.4g} m from {other}"))
        meetings = _count_collisions(result["vehicle_collisions"])
        rows.append(("collisions with vehicles", meetings))
    if "saturated_steps" in result:
        rows.append(("saturated steps", str(result["saturated_steps"])))
    if "controller" in result:
        rows += _describe_control(result)
    return rows


def _count_collisions(collisions: Sequence[Dict[str, Any]]) -> str:
    first = f", the first with {Encounter(**collisions[0])}" if collisions else ""
    return f"{len(collisions)}{first}"


def _describe_control(result: Dict[str, Any]) -> List[Tuple[str, str]]:
    start = ", start in its full state" if result["starts_on_reference"] else ""
    late = f", {result['final_error']:.4g} m (last {TAIL:g} s)" if result["duration"] > TAIL else ""
    name = str(result["controller"])
    if not math.isnan(result["controller_rate"]):  # a plugin sets its own rate
        name += f", {result['controller_rate']:g} Hz, delay {result['delay']:g} s"
    rows = [
        ("controller", name),
        ("reference", f"{result['reference']}{start}"),
        ("max error", f"{result['max_error']:.4g} m (whole flight){late}"),
        ("RMS error", f"{result['rms_error']:.4g} m"),
    ]
    if result["updates"]:
        saturated = f"{result['saturated_updates']} of {result['updates']}"
        rows.append(("saturated updates", saturated))
    rows += [(name, result[name]) for name in ("program", "answers") if name in result]
    return rows


def _round(values: Any, digits: int) -> List[float]:
    # Round first, then turn -0 into 0.
    return [round(float(value), digits) + 0.0 for value in values]


def _join_numbers(values: List[float], digits: int) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in _round(values, digits))
