"""What can hardly be meant."""

from __future__ import annotations

import argparse

import numpy as np

from .._core import InputError
from ..simulation.flight_plan import FlightPlan
from ..simulation.simulation import Simulation
from ..support.warning import warn


def warn_of_commands(simulation: Simulation, plan: FlightPlan) -> None:
    """Warn of a flight that can hardly be meant: no commands, or all rotors turning one way."""
    topic = simulation.topics.get(simulation.command_topic)
    if plan.controller is not None or topic is None or topic.writer is not None:
        return
    if plan.commands is None:
        warn(
            "nothing commands the rotors, so that the vehicle falls; give --commands FILE, or "
            "--controller geometric, which hovers"
        )
    elif _one_way(plan.commands[:, 1:]):
        try:
            hover = simulation.hover_speed
        except InputError:  # of which nothing is known
            return
        if not _one_way(hover[None]):
            told = ", ".join(f"{speed:.0f}" for speed in hover)
            warn(
                "the commands turn all rotors one way, so that their reaction torques add up and "
                f"the vehicle yaws; the sign of a speed is its sense: it hovers at {told} rad/s"
            )


def refuse_log_every(arguments: argparse.Namespace, what: str) -> None:
    """Raise `InputError` if --log-every was given to what writes no log."""
    if arguments.log_every is not None:
        raise InputError(f"{what} writes no log; leave --log-every out")


def _one_way(speeds: np.ndarray) -> bool:
    return speeds.shape[1] > 1 and bool(np.all(speeds > 0) or np.all(speeds < 0))
