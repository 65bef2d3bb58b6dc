"""Errors of attitude and angular velocity along a reference."""

from __future__ import annotations

from typing import Any, Dict, Optional

import numpy as np

from .. import _core
from .._core import QuadcoreError
from ..control.built_in import BuiltInController
from ..control.references import Shape
from ..simulation.flight_plan import FlightPlan
from ..simulation.log import Log
from .tracking_metrics import compute_rms_and_max

METRICS = {
    "attitude": {
        "rms_attitude_error": ("rad", "RMS angle between the attitude and that of the reference"),
        "max_attitude_error": (
            "rad",
            "maximum angle between the attitude and that of the reference",
        ),
    },
    "rates": {
        "rms_rate_error": (
            "rad/s",
            "RMS difference of the angular velocity from that of the reference",
        ),
        "max_rate_error": (
            "rad/s",
            "maximum difference of the angular velocity from that of the reference",
        ),
    },
}
"""For each metric, the unit and meaning of its values."""


def sample_flat_states(
    simulation: Any, plan: FlightPlan, times: np.ndarray
) -> Optional[np.ndarray]:
    """Return the attitude and angular velocity of a vehicle that follows the reference exactly.

    They follow from the differential flatness of a vehicle with rotor drag (Faessler, Franchi,
    Scaramuzza 2018).

    Parameters
    ----------
    simulation : Simulation
        Simulation of the vehicle in its initial state.
    plan : FlightPlan
        Plan with the reference and the controller.
    times : ndarray (rows,)
        Times, s.

    Returns
    -------
    ndarray (rows, 7) or None
        Unit quaternion x, y, z, w of the frame in the world, and angular velocity in body axes,
        rad/s. None if the reference has no derivatives, or the vehicle has no flat state.
    """
    reference: Any = plan.reference
    if isinstance(reference, Shape):
        reference = reference.on(simulation)
    spins = plan.controller.spins if isinstance(plan.controller, BuiltInController) else []
    rows = []
    try:
        for t in times.tolist():
            state = _core.start_on(simulation, reference(t), list(spins))
            rows.append([*state["orientation"], *state["angular_velocity"]])
    except (QuadcoreError, AttributeError, TypeError):
        return None
    return np.array(rows)


def measure(metric: str, log: Log, flat: Optional[np.ndarray]) -> Dict[str, float]:
    """Compute the values of a metric in `METRICS`; NaN without flat states."""
    names = METRICS[metric]
    if flat is None:
        return dict.fromkeys(names, float("nan"))
    if metric == "attitude":
        # Angle of the rotation between two unit quaternions: 2 acos |q . p|, well-conditioned.
        same = np.abs((log.orientation * flat[:, :4]).sum(axis=1))
        sign = np.sign((log.orientation * flat[:, :4]).sum(axis=1))[:, None]
        apart = np.linalg.norm(log.orientation - sign * flat[:, :4], axis=1)
        away = 4 * np.arctan2(apart / 2, np.sqrt((1 + same) / 2))
    else:
        away = np.linalg.norm(log.angular_velocity - flat[:, 4:], axis=1)
    return dict(zip(names, compute_rms_and_max(away)))
