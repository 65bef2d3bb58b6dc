"""Checks for commands that are valid but probably a mistake."""

from __future__ import annotations

import argparse

import numpy as np

from .._core import InputError
from ..simulation.flight_plan import FlightPlan
from ..simulation.simulation import Simulation
from ..studies.evaluate.poles import describe_yaw_zero, find_yaw_zero
from ..studies.tracking_metrics import FAILURE_DISTANCE
from ..support.warning import warn


def warn_of_commands(simulation: Simulation, plan: FlightPlan) -> None:
    """Warn about a flight without commands, or with all rotors turning in the same direction."""
    topic = simulation.topics.get(simulation.command_topic)
    if plan.controller is not None or topic is None or topic.writer is not None:
        return
    if plan.commands is None:
        warn(
            "no rotor command is given, so the vehicle falls. Give --commands FILE, or "
            "--controller geometric, which hovers."
        )
    elif _turn_one_way(plan.commands[:, 1:]):
        try:
            hover = simulation.hover_speed
        except InputError:  # the rotors' coefficients are unknown
            return
        if not _turn_one_way(hover[None]):
            speeds = ", ".join(f"{speed:.0f}" for speed in hover)
            warn(
                "the commands turn all rotors the same way, so their reaction torques add up and "
                "the vehicle yaws. The sign of a speed is its sense of rotation: the vehicle "
                f"hovers at {speeds} rad/s."
            )


def refuse_log_every(arguments: argparse.Namespace, what: str) -> None:
    """Raise `InputError` if --log-every is given to a command that writes no log."""
    if arguments.log_every is not None:
        raise InputError(f"{what} writes no log. Leave --log-every out.")


def _turn_one_way(speeds: np.ndarray) -> bool:
    return speeds.shape[1] > 1 and bool(np.all(speeds > 0) or np.all(speeds < 0))


def warn_of_yaw_zero(simulation: Simulation, error: float) -> None:
    """Warn if a vehicle has a large tracking error and a right-half-plane zero in yaw.

    Parameters
    ----------
    simulation
        Simulation of the vehicle.
    error
        Maximum tracking error, m.
    """
    if error > FAILURE_DISTANCE:
        zero = describe_yaw_zero(find_yaw_zero(simulation))
        if zero:
            warn(f"the vehicle was {error:.3g} m from its reference; {zero}")
