"""Solution of the equation of motion (2.38)."""

from __future__ import annotations

from typing import Any, List, NamedTuple, Tuple

import numpy as np

from ..._core import FlightError
from ...simulation.commands import check_commands
from ...simulation.flight import count_steps
from ...simulation.log import Log
from ...simulation.state import State
from ...support.rotation import to_roll_pitch_yaw
from . import matrices
from .kinematics import euler_rates_to_body, gradient_of_W, quaternion, rotation, skew
from .vehicle import Vehicle


class Terms(NamedTuple):
    """Terms that the equations of chapter 2 omit; each can be enabled."""

    motor_lag: bool = True
    """I_R omegadot = kp (u - omega). In chapter 2 the speeds are prescribed: omega = u."""
    spin_up: bool = False
    """Torque - sum I_R omegadot, which (2.11) contains but the line after (2.13) drops."""
    dragged_rotors: bool = False
    """Relative motion of the rotors when the frame rotates: omegadot = ... - a . nudot."""


THESIS = Terms()
"""Chapter 2 with the motor lag of the plant."""
GYROSTAT = Terms(spin_up=True, dragged_rotors=True)
"""All terms: a rigid body with n rotors, as in the engine ``eigen``."""


class MathematicalModel:
    """Mathematical model of a vehicle (chapter 2).

    Parameters
    ----------
    vehicle : Vehicle
        Parameters of the vehicle.
    terms : Terms
        Terms to add to those of the thesis.
    """

    def __init__(self, vehicle: Vehicle, terms: Terms = THESIS) -> None:
        if (terms.spin_up or terms.dragged_rotors) and not terms.motor_lag:
            raise ValueError("speeds that jump have no acceleration: these terms need motor_lag")
        self.vehicle = vehicle
        self.terms = terms

    def motors(self, omega: np.ndarray, command: np.ndarray) -> np.ndarray:
        """Return the accelerations of the rotors on a frame at rest, rad/s^2; shape (n,)."""
        v = self.vehicle
        torques = v.motor_gain * (command - omega) - v.joint_damping * omega
        accelerations: np.ndarray = torques / v.rotor_inertia
        return accelerations

    def acceleration(
        self, q: np.ndarray, qdot: np.ndarray, omega: np.ndarray, omegadot: np.ndarray
    ) -> np.ndarray:
        """Solve (2.38) for qddot.

        Parameters
        ----------
        q, qdot : ndarray, shape (6,)
            Position of the centre of mass and Euler angles, and their rates.
        omega, omegadot : ndarray, shape (n,)
            Rotor speeds (rad/s), and their accelerations on a frame at rest (rad/s^2).
        """
        v = self.vehicle
        through_air = qdot - np.concatenate([v.wind, np.zeros(3)])
        F = matrices.F_flap(v, q, omega) + matrices.F_I(v, q) + matrices.F_T(v, q)
        F += matrices.F_P(v, q) + matrices.F_par(v, through_air)
        zeta = matrices.K_zeta(v, q, np.sign(omega)) @ omega**2
        inertia = matrices.B(v, q)
        rest = zeta - matrices.C(v, q, qdot) @ qdot - matrices.g(v)
        rest -= matrices.G_a(v, q, omega) @ qdot + F @ through_air
        if self.terms.spin_up:
            W = euler_rates_to_body(q[3:])
            rest[3:] -= W.T @ ((v.rotor_inertia * omegadot / v.slow) @ v.axes)
            if self.terms.dragged_rotors:
                polar = (v.rotor_inertia * v.axes.T) @ v.axes  # of the rotors, which stay behind
                inertia[3:, 3:] -= W.T @ polar @ W
                rest[3:] += W.T @ polar @ _bias(q, qdot)
        return np.linalg.solve(inertia, rest)

    def fly(self, duration: float, commands: Any, state: State, dt: float = 1e-3) -> Log:
        """Simulate a flight with the method DOP853 and an error of at most 1e-9.

        Parameters
        ----------
        duration : float
            Duration, s.
        commands : ndarray (rows, 1 + n), or path
            As for `Simulation.run`. The first row holds from the start.
        state : State
            Initial state, with rotor velocities in the order of the commands. Without motor lag,
            the commands replace these velocities.
        dt : float
            Time between rows of the log, s.

        Returns
        -------
        Log
            Log like that of an engine, but without wrenches.

        Raises
        ------
        FlightError
            If the pitch approaches 90 degrees, the singularity of the Euler angles.
        """
        v = self.vehicle
        n = len(v.arms)
        table = check_commands(commands, n)
        time = state.time + dt * np.arange(count_steps(duration, dt) + 1)
        y = self._start(state)
        if _measure_uprightness(0, y) <= 0:
            raise _make_tilt_failure(state.time)
        rows = np.empty((len(time), len(y)))
        begins = np.concatenate([time[:1], table[1:, 0]])
        ends = np.append(begins[1:], np.inf)
        for begin, end, row in zip(begins, ends, np.clip(table[:, 1:], -v.fastest, v.fastest)):
            if begin > time[-1] + 1e-9:
                break
            if not self.terms.motor_lag:
                y[12:] = row
            inside = (time >= begin - 1e-9) & (time < end - 1e-9)
            stop = min(end, time[-1])
            rows[inside], y = self._integrate(begin, stop, y, row, time[inside])
        return self._log(time, rows)

    def step(self, dt: float, command: np.ndarray, state: State) -> State:
        """Simulate one step with the classical fourth-order Runge-Kutta method.

        Parameters
        ----------
        dt : float
            Step, s.
        command : ndarray, shape (n,)
            Commanded speeds during the step, rad/s.
        state : State
            State at the start of the step, as for `fly`; rotor angles have no effect.

        Returns
        -------
        State
            State at the end of the step, without rotor angles.

        Raises
        ------
        FlightError
            As for `fly`.
        """
        y = self._start(state)
        if not self.terms.motor_lag:
            y[12:] = command
        slopes: List[np.ndarray] = []
        for part in (0.0, 0.5, 0.5, 1.0):
            at = y + part * dt * slopes[-1] if slopes else y
            if _measure_uprightness(0, at) <= 0:
                raise _make_tilt_failure(state.time)
            slopes.append(self._derivative(at, command))
        a, b, c, d = slopes
        after = y + dt / 6 * (a + 2 * b + 2 * c + d)
        return self._state(state.time + dt, after)

    def _integrate(
        self, begin: float, end: float, y: np.ndarray, command: np.ndarray, wanted: np.ndarray
    ) -> Any:
        """Return the states at some times and at the end of an interval with constant command."""
        if end <= begin:
            return np.tile(y, (len(wanted), 1)), y
        from scipy.integrate import solve_ivp  # scipy is slow to import

        solution = solve_ivp(
            lambda _, y: self._derivative(y, command),
            (begin, end),
            y,
            method="DOP853",
            rtol=1e-11,
            atol=1e-11,
            max_step=0.1,  # s; over longer steps, the interpolation for the log is less accurate
            dense_output=True,
            events=_measure_uprightness,
        )
        if solution.status != 0:
            raise _make_tilt_failure(float(solution.t[-1]))
        return solution.sol(wanted).T, solution.y[:, -1]

    def _derivative(self, y: np.ndarray, command: np.ndarray) -> np.ndarray:
        q, qdot, omega = y[:6], y[6:12], y[12:]
        lag = self.terms.motor_lag
        omegadot = self.motors(omega, command) if lag else np.zeros_like(omega)
        qddot = self.acceleration(q, qdot, omega, omegadot)
        if self.terms.dragged_rotors:
            nudot = euler_rates_to_body(q[3:]) @ qddot[3:] + _bias(q, qdot)
            omegadot = omegadot - self.vehicle.slow * (self.vehicle.axes @ nudot)
        return np.concatenate([qdot, qddot, omegadot])

    def _start(self, state: State) -> np.ndarray:
        """Return the generalised coordinates of a state of the frame link."""
        eta = to_roll_pitch_yaw(state.orientation)
        offset, sweep = self._lever(eta, state.angular_velocity)
        etadot = np.linalg.solve(euler_rates_to_body(eta), state.angular_velocity)
        xi, xidot = state.position + offset, state.linear_velocity + sweep
        speeds = state.rotor_velocity * self.vehicle.slow
        return np.concatenate([xi, eta, xidot, etadot, speeds])

    def _lever(self, eta: np.ndarray, nu: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
        """Return the vector from frame origin to centre of mass, and its rate, in world axes."""
        R, center = rotation(eta), self.vehicle.center_of_mass
        return R @ center, R @ (skew(nu) @ center)

    def _state(self, time: float, y: np.ndarray) -> State:
        """Return the state of the frame link for generalised coordinates."""
        state, eta = State(), y[3:6]
        nu = euler_rates_to_body(eta) @ y[9:12]
        offset, sweep = self._lever(eta, nu)
        state.time, state.position, state.linear_velocity = time, y[:3] - offset, y[6:9] - sweep
        state.orientation, state.angular_velocity = quaternion(eta), nu
        state.rotor_velocity = y[12:] / self.vehicle.slow
        return state

    def _log(self, time: np.ndarray, rows: np.ndarray) -> Log:
        """Make a log with the position of the frame origin; xi is the centre of mass."""
        xi, eta, xidot, etadot, omega = np.split(rows, [3, 6, 9, 12], axis=1)
        from scipy.spatial.transform import Rotation

        attitude = Rotation.from_euler("ZYX", eta[:, ::-1])
        nu = np.array([euler_rates_to_body(a) @ rate for a, rate in zip(eta, etadot)])
        offset = attitude.apply(self.vehicle.center_of_mass)
        velocity = xidot - np.cross(attitude.apply(nu), offset)
        columns = [time[:, None], xi - offset, attitude.as_quat(), velocity, nu]
        return Log(np.hstack([*columns, omega / self.vehicle.slow]), {})


def _bias(q: np.ndarray, qdot: np.ndarray) -> np.ndarray:
    """Return Wdot etadot, the part of nudot = W etaddot + Wdot etadot without etaddot."""
    etadot = qdot[3:]
    bias: np.ndarray = np.einsum("kij,k,j->i", gradient_of_W(q[3:]), etadot, etadot)
    return bias


def _measure_uprightness(_: float, y: np.ndarray) -> float:
    return float(np.cos(y[4])) - 1e-2


_measure_uprightness.terminal = True  # type: ignore[attr-defined]


def _make_tilt_failure(time: float) -> FlightError:
    error = FlightError(f"t = {time:.6g} s: the pitch reaches 90 degrees, where (2.9) ends")
    error.time = time
    return error
