"""Engine ``eigen`` as chapter 2 sees a vehicle: the rotors' speeds are given, whatever drives them.

Chapter 2 takes the speeds as known functions of time. It knows neither the torque that the frame
must take for changing them, nor the lead or lag of a rotor whose frame begins to turn. No rigid
body moves so, but a limit of one does. Between steps each rotor is put to a speed that it would
have reached, and the frame feels nothing of that; within a step a motor so stiff that it answers
within a millisecond keeps the rotor at that speed relative to the frame. Twice as stiff halves the
distance from the model.
"""

from __future__ import annotations

import numpy as np

from ...simulation.flight import Pilot, Rows, count_steps, fly, list_columns
from ...simulation.log import Log
from ...simulation.simulation import Simulation
from ..chapter2 import Vehicle
from ..chapter2.vehicle import list_command_order

# The rate of a stiff motor times the step; Runge-Kutta is stable below 2.78.
STIFFNESS = 2.0


def compute_stiff_gain(vehicle: Vehicle, dt: float) -> float:
    """Proportional gain for the simulation that `fly_prescribed_speeds` is given, N m s/rad."""
    return float(STIFFNESS * vehicle.rotor_inertia.min() / dt)


def speeds(vehicle: Vehicle, commands: np.ndarray, times: np.ndarray, lag: bool) -> np.ndarray:
    """Speeds that motors give on a frame at rest: I_R omegadot = kp (u - omega) - c omega.

    Parameters
    ----------
    commands : ndarray, shape (rows, 1 + n)
        The first row is for t = 0, and the rotors begin at its speeds.
    times : ndarray, shape (m,)
        s, not before 0.
    lag : bool
        False: omega = u.

    Returns
    -------
    ndarray, shape (m, n)
        rad/s
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
    """The pilot (see `flight.fly`) that puts the rotors to the speeds of `vehicle`'s motors.

    Parameters
    ----------
    commands, lag
        As for `speeds`.
    duration : float
        Of the flight, s.
    """

    delay = 0.0
    moves = True

    def __init__(
        self, vehicle: Vehicle, commands: np.ndarray, lag: bool, duration: float, dt: float
    ) -> None:
        self.rate = 1 / dt
        middles = dt * (np.arange(count_steps(duration, dt)) + 0.5)
        self._omega = speeds(vehicle, commands, middles, lag)
        # What a stiff motor must be asked for to hold a speed against friction.
        self._asked = self._omega * (1 + vehicle.joint_damping / compute_stiff_gain(vehicle, dt))

    def reset(self, simulation: Simulation) -> None:
        """Begin with the rotors as they turn."""
        self._order = list_command_order(simulation)
        before = np.vstack([simulation.state.rotor_velocity[self._order], self._omega[:-1]])
        self._steps = zip(self._asked, self._omega - before)

    def speeds(self, simulation: Simulation) -> np.ndarray:
        """Put the rotors to the speeds of the step's middle, and hold them there."""
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
    """Fly with the speeds that `vehicle`'s motors would give to its rotors.

    Parameters
    ----------
    simulation : Simulation
        Engine ``eigen``, at rest, its motors of `compute_stiff_gain`, sim_slow 1.
    """
    pilot = PrescribedSpeeds(vehicle, commands, lag, duration, simulation.dt)
    rows = Rows(simulation, list_columns(simulation))
    fly(simulation, duration, None, log_every, rows.receive, pilot=pilot)
    return rows.log()
