"""A frame with spinning rotors, integrated from its momentum balance: the tests' own reference.

The rotors are symmetric about their axes, on which their centres of mass lie. About the centre of
mass C of all, in the frame's axes, with J the moment of inertia of all, w the frame's rate, W_i the
rate of rotor i about its axis a_i and I_i its moment about it:

    h = J w + sum I_i W_i a_i           dh/dt + w x h = torque about C
    h_i = I_i (a_i . w + W_i)           dh_i/dt       = torque of joint i

which is linear in dw/dt and dW_i/dt.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import ode
from scipy.spatial.transform import Rotation


def no_load(gyrostat, v, w, spin, attitude):
    """Force and torque on the vehicle at C, torques of the joints."""
    return np.zeros(3), np.zeros(3), np.zeros(len(spin))


class Gyrostat:
    """Attributes in SI units, frame axes: mass, center, inertia; per rotor axes, arms, moments."""

    def __init__(self, rotors, mass, inertia, com=(0, 0, 0)):
        turns = [Rotation.from_euler("xyz", rotor.rpy) for rotor in rotors]
        masses = np.array([mass] + [rotor.mass for rotor in rotors], dtype=float)
        places = np.array([com] + [rotor.xyz for rotor in rotors], dtype=float)
        xx, yy, zz, xy, xz, yz = inertia
        own = [np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])]
        own += [turn_inertia(np.diag(r.inertia), turn) for r, turn in zip(rotors, turns)]
        self.mass = masses.sum()
        self.center = masses @ places / self.mass
        self.arms = places[1:] - self.center
        self.axes = np.array([turn.apply([0, 0, 1]) for turn in turns]).reshape(-1, 3)
        self.moments = np.array([rotor.inertia[2] for rotor in rotors])
        self.inertia = sum(
            i + m * ((d @ d) * np.eye(3) - np.outer(d, d))
            for i, m, d in zip(own, masses, places - self.center)
        )
        coupling = self.moments[:, None] * self.axes
        self._balance = np.block([[self.inertia, coupling.T], [coupling, np.diag(self.moments)]])

    def momentum(self, w, spin):
        """Angular momentum about C, frame axes."""
        return self.inertia @ w + (self.moments * spin) @ self.axes

    def energy(self, w, spin):
        """Kinetic energy of all turning about C."""
        rates = np.concatenate([w, spin])
        return 0.5 * rates @ self._balance @ rates

    def _seen_from(self, state, way):
        """The state with the motion of C in place of the origin's (way 1), or back (way -1)."""
        p, q, v, w, spin = np.split(np.array(state, dtype=float), [3, 7, 10, 13])
        turn = Rotation.from_quat(q)
        p += way * turn.apply(self.center)
        v += way * turn.apply(np.cross(w, self.center))
        return np.concatenate([p, turn.as_quat(), v, w, spin])

    def fly(self, times, state, load=no_load, gravity=(0, 0, 0)):
        """States at `times` from that at the first; states as the columns of a log after t."""

        def derivative(_, y):
            _, q, v, w, spin = np.split(y, [3, 7, 10, 13])
            attitude = Rotation.from_quat(q)
            force, torque, joints = load(self, v, w, spin, attitude)
            gyroscopic = np.cross(w, self.momentum(w, spin))
            rates = np.linalg.solve(self._balance, np.concatenate([torque - gyroscopic, joints]))
            q_dot = 0.5 * np.append(q[3] * w + np.cross(q[:3], w), -q[:3] @ w)
            v_dot = attitude.apply(force) / self.mass + gravity
            return np.concatenate([v, q_dot, v_dot, rates])

        solver = ode(derivative).set_integrator("dop853", rtol=1e-12, atol=1e-13, nsteps=10**6)
        solver.set_initial_value(self._seen_from(state, 1), times[0])
        rows = [np.asarray(state, dtype=float)]
        for time in times[1:]:
            rows.append(self._seen_from(solver.integrate(time), -1))
            assert solver.successful()
        return np.array(rows)


def turn_inertia(inertia, turn):
    """A moment of inertia that is given in turned axes."""
    axes = turn.apply(np.eye(3))
    return axes.T @ inertia @ axes


def angle_between(a, b):
    """Angle between orientations (rad), row by row."""
    between = Rotation.from_quat(np.array(a)).inv() * Rotation.from_quat(np.array(b))
    return np.linalg.norm(between.as_rotvec(), axis=1)
