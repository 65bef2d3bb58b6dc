"""Engine ``eigen`` with prescribed rotor speeds, as in chapter 2.

In chapter 2 the speeds are known functions of time. The chapter omits the reaction of the frame to
speed changes, and the inertia of the rotors against rotations of the frame. A rigid body approaches
this motion as a limit. Between steps, each rotor is set to its prescribed speed without a reaction
on the frame. Within a step, a stiff motor holds this speed relative to the frame. If the stiffness
doubles, the difference from the model halves.
"""

from __future__ import annotations

import numpy as np

from ...simulation.flight import Pilot, count_steps, fly, list_columns
from ...simulation.log import Log
from ...simulation.rows import Rows
from ...simulation.simulation import Simulation
from ..chapter2 import Vehicle
from ..chapter2.vehicle import list_command_order

# Rate of a stiff motor times the step; Runge-Kutta is stable below 2.78.
STIFFNESS = 2.0


def compute_stiff_gain(vehicle: Vehicle, dt: float) -> float:
    """Return the motor gain for the simulation in `fly_prescribed_speeds`, N m s/rad."""
    return float(STIFFNESS * vehicle.rotor_inertia.min() / dt)


def speeds(vehicle: Vehicle, commands: np.ndarray, times: np.ndarray, lag: bool) -> np.ndarray:
    """Return the rotor speeds on a frame at rest: I_R omegadot = kp (u - omega) - c omega.

    Parameters
    ----------
    commands : ndarray, shape (rows, 1 + n)
        Commands. The rotors start at the speeds of the first row, which is at t = 0.
    times : ndarray, shape (m,)
        Times since the start, s.
    lag : bool
        Whether the motors lag; otherwise omega = u.

    Returns
    -------
    ndarray, shape (m, n)
        Rotor speeds, rad/s.
    """
    due = np.searchsorted(commands[:, 0], times + 1e-9, side="right") - 1
    u = np.clip(commands[:, 1:], -vehicle.fastest, vehicle.fastest)
    if not lag:
        at_once: np.ndarray = u[due]
        return at_once
    whole = vehicle.motor_gain + vehicle.joint_damping
    rate, settled = whole / vehicle.rotor_inertia, u * vehicle.motor_gain / whole
    begin = [u[0]]
    for row, span in zip(settled, np.diff(commands[:, 0])):
        begin.append(row + (begin[-1] - row) * np.exp(-rate * span))
    since = (times - commands[due, 0])[:, None]
    omega: np.ndarray = settled[due] + (np.array(begin) - settled)[due] * np.exp(-rate * since)
    return omega


class PrescribedSpeeds(Pilot):
    """Pilot (see `flight.fly`) that prescribes the rotor speeds.

    Parameters
    ----------
    commands, lag
        As for `speeds`.
    duration : float
        Duration of the flight, s.
    """

    delay = 0.0
    moves = True

    def __init__(
        self, vehicle: Vehicle, commands: np.ndarray, lag: bool, duration: float, dt: float
    ) -> None:
        self.rate = 1 / dt
        middles = dt * (np.arange(count_steps(duration, dt)) + 0.5)
        self._omega = speeds(vehicle, commands, middles, lag)
        # Command of a stiff motor that holds the speed against friction.
        self._asked = self._omega * (1 + vehicle.joint_damping / compute_stiff_gain(vehicle, dt))

    def reset(self, simulation: Simulation) -> None:
        """Start with the current rotor speeds."""
        self._order = list_command_order(simulation)
        before = np.vstack([simulation.state.rotor_velocity[self._order], self._omega[:-1]])
        self._steps = zip(self._asked, self._omega - before)

    def speeds(self, simulation: Simulation) -> np.ndarray:
        """Set the rotors to their speeds at the middle of the step."""
        asked, jump = next(self._steps)
        if jump.any():
            state = simulation.state.copy()
            state.rotor_velocity[self._order] += jump
            simulation.set_state(state)
        now: np.ndarray = asked
        return now


def fly_prescribed_speeds(
    simulation: Simulation,
    vehicle: Vehicle,
    commands: np.ndarray,
    duration: float,
    log_every: int,
    lag: bool,
) -> Log:
    """Simulate a flight with the rotor speeds that the motors of `vehicle` would reach.

    Parameters
    ----------
    simulation : Simulation
        Simulation in the engine ``eigen``, at rest, with the gain of `compute_stiff_gain` and a
        sim_slow of 1.
    """
    pilot = PrescribedSpeeds(vehicle, commands, lag, duration, simulation.dt)
    rows = Rows(simulation, list_columns(simulation))
    fly(simulation, duration, None, log_every, rows.receive, pilot=pilot)
    return rows.log()
