"""Closed-loop replay of the set-points of a recording."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from ..._core import InputError, Reference
from ...control import controllers
from ...simulation.log import Log
from ...simulation.simulation import Simulation
from .fitted_model import FittedModel
from .prepared import PreparedFlight, sample_state

_LOG_STEP = 0.01  # s; time between logged rows
_DELAYS = np.arange(0.0, 1.0, 0.01)
"""Delays of the set-points that are tried, s."""


class Replay(NamedTuple):
    """Simulated flight along the set-points of a recording, and the real flight.

    Attributes
    ----------
    where : str
        Path of the recording.
    controller : str
        Name of the controller.
    measured, flown : Log
        Real and simulated flight at the same times, which start at 0 s.
    setpoints : ndarray (rows, 3)
        Position set-points at these times, m.
    delay : float
        Delay that brings the set-points closest to the real flight, s.
    distances : dict of str to tuple of float
        RMS and maximum distance from the real flight, m, for the replay, the set-points and the
        delayed set-points.
    mean_command : float, optional
        Mean motor command of the real flight, from 0 to 1.
    """

    where: str
    controller: str
    measured: Log
    flown: Log
    setpoints: np.ndarray
    delay: float
    distances: Dict[str, Tuple[float, float]]
    mean_command: Optional[float]

    def list_rows(self) -> List[Tuple[str, Tuple[float, float]]]:
        """List a title with the RMS and maximum distance (m), for tables."""
        titles = {
            "replay": f"replay with {self.controller}",
            "delayed set-points": f"set-points delayed by {self.delay:.2f} s",
        }
        return [(titles.get(name, name), pair) for name, pair in self.distances.items()]


def replay_flight(fitted: FittedModel, flight: PreparedFlight, controller: str) -> Replay:
    """Simulate a flight with a controller that follows the recorded set-points.

    The simulation starts from the measured state, with the rotors at hover speed. Each set-point
    holds until the next one.

    Parameters
    ----------
    fitted
        Model.
    flight
        Prepared flight.
    controller
        Name of the controller, as for `controllers.parse`.

    Raises
    ------
    InputError
        If the recording has no pose or no set-points.
    FlightError
        If the flight fails.
    """
    if not flight.has_pose:
        raise InputError(f"{flight.where}: a replay needs a pose. Remove --controller.")
    if flight.setpoint is None:
        raise InputError(
            f"{flight.where}: the recording has no set-points. Map setpoint, or remove "
            "--controller."
        )
    begin = max(flight.span[0], float(flight.setpoint.time[0]))
    simulation = Simulation(
        fitted.model, engine="eigen", world=fitted.make["world"], parameters=fitted.fixed
    )
    start = sample_state(flight, np.array([begin]))
    state = simulation.state.copy()
    state.position, state.orientation = start["position"][0], start["orientation"][0]
    state.linear_velocity, state.angular_velocity = start["velocity"][0], start["rates"][0]
    state.rotor_velocity = simulation.hover_speed
    simulation.set_state(state)

    def follow(t: float) -> Reference:
        position, yaw = _find_setpoint(flight, np.array([begin + t]))
        return Reference(position=position[0], yaw=float(yaw[0]))

    flown = simulation.run(
        flight.span[1] - begin,
        controller=controllers.parse(controller, fitted.model.name),
        reference=follow,
        log_every=max(1, round(_LOG_STEP / simulation.dt)),
    )
    time = begin + flown.time
    states = sample_state(flight, time)
    columns = [flown.time[:, None], states["position"], states["orientation"]]
    measured = Log(np.hstack([*columns, states["velocity"], states["rates"]]), title="measured")
    setpoints, _ = _find_setpoint(flight, time)
    delayed = [_find_setpoint(flight, time - delay)[0] for delay in _DELAYS]
    rms = [_measure(each, measured)[0] for each in delayed]
    best = int(np.argmin(rms))
    distances = {
        "replay": _measure(flown.position, measured),
        "set-points": _measure(setpoints, measured),
        "delayed set-points": _measure(delayed[best], measured),
    }
    mean = None
    if flight.commands is not None:
        commands = flight.commands
        inside = (commands.time >= begin) & (commands.time <= flight.span[1])
        mean = float(commands.values[inside].mean())
    return Replay(
        flight.where, controller, measured, flown, setpoints, float(_DELAYS[best]), distances, mean
    )


def _find_setpoint(flight: PreparedFlight, time: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Return the position (n, 3) and yaw (n,) set-points that are valid at some times (s)."""

    def hold(series: Any) -> np.ndarray:
        row = np.searchsorted(series.time, time + 1e-9, "right") - 1
        return np.asarray(series.values[np.maximum(row, 0)])

    assert flight.setpoint is not None
    yaw = np.zeros(len(time)) if flight.setpoint_yaw is None else hold(flight.setpoint_yaw)[:, 0]
    return hold(flight.setpoint), yaw


def _measure(position: np.ndarray, measured: Log) -> Tuple[float, float]:
    distance = np.linalg.norm(position - measured.position, axis=1)
    return float(np.sqrt(np.mean(distance**2))), float(distance.max())
