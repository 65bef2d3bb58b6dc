"""Linear loops of the cascaded controllers around hover, including air drag."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict, Mapping, NamedTuple, Sequence

import numpy as np

from ...simulation.simulation import Simulation
from .loop_margins import find_margins

if TYPE_CHECKING:
    from ...thesis.chapter2 import Vehicle

_TWIST = 1e-3  # m/s, rad/s; step of the central differences that give the drag
_FREQUENCIES = np.geomspace(1e-2, 1e3, 4000)  # rad/s


class Loop(NamedTuple):
    """Feedback u = C x around a plant dx/dt = A x + B u, where u is the demand to the motors."""

    plant: np.ndarray
    """Matrix A, shape (n, n)."""
    entry: np.ndarray
    """Vector B, shape (n,)."""
    demand: np.ndarray
    """Vector C, shape (n,)."""

    def find_poles(self) -> np.ndarray:
        """Return the poles of the closed loop, 1/s."""
        poles: np.ndarray = np.linalg.eigvals(self.plant + np.outer(self.entry, self.demand))
        return poles

    def compute_response(self, frequencies: np.ndarray) -> np.ndarray:
        """Return the loop gain -C (jw - A)^-1 B at some angular frequencies (rad/s)."""
        systems = 1j * frequencies[:, None, None] * np.eye(len(self.entry)) - self.plant
        states = np.linalg.solve(systems, self.entry[None, :, None].astype(complex))
        response: np.ndarray = -(states[..., 0] @ self.demand)
        return response

    def find_delay_margin(self) -> float:
        """Return the smallest additional delay of the demand that destabilises a stable loop, s."""
        return find_margins(_FREQUENCIES, self.compute_response(_FREQUENCIES)).delay_margin


def measure_drag(simulation: Simulation) -> np.ndarray:
    """Measure the air drag of a vehicle with rotors at hover speed.

    Returns
    -------
    ndarray, shape (6, 6)
        Negative wrench per twist in body axes. The wrench is the force (N) and the torque about the
        centre of mass (N m). The twist is the velocity of the centre of mass (m/s) and the angular
        velocity (rad/s).
    """
    columns = []
    state = simulation.state.copy()
    state.position[:] = 0, 0, 1e3  # far above any ground
    state.orientation[:] = 0, 0, 0, 1
    rates = [rotor.rate_per_command for rotor in simulation.rotors]
    state.rotor_velocity[:] = np.array(simulation.hover_speed) * rates
    for twist in _TWIST * np.eye(6):
        wrenches = []
        for sign in (1, -1):
            state.angular_velocity[:] = sign * twist[3:]
            arm = np.cross(sign * twist[3:], simulation.center_of_mass)
            state.linear_velocity[:] = sign * twist[:3] - arm
            simulation.set_state(state)
            log = simulation.run(simulation.dt, wrenches=True)
            wrenches.append(sum(wrench[0] for wrench in log.wrenches.values()))
        columns.append((wrenches[1] - wrenches[0]) / (2 * _TWIST))
    return np.column_stack(columns)


def make_loops(
    gains: Mapping[str, float], vehicle: Vehicle, drag: np.ndarray, lag: float
) -> Dict[str, Loop]:
    """Make the position and attitude loops; x, y and roll, pitch give the slower of two axes.

    Parameters
    ----------
    gains
        Parameters of the controller, as returned by `read_gains`.
    vehicle
        Parameters of the vehicle.
    drag
        Drag matrix, as returned by `measure_drag`.
    lag
        Time constant of the thrusts and torques, s.
    """
    sides = [_make_tilt_loops(gains, vehicle, drag, lag, *side) for side in ((0, 4, 1), (1, 3, -1))]
    found = {
        name: max((side[name] for side in sides), key=lambda loop: loop.find_poles().real.max())
        for name in ("x, y", "roll, pitch")
    }
    return {"x, y": found["x, y"], "z": _make_height(gains, vehicle, drag, lag), **found}


def _make_tilt_loops(
    gains: Mapping[str, float],
    vehicle: Vehicle,
    drag: np.ndarray,
    lag: float,
    along: int,
    about: int,
    sign: int,
) -> Dict[str, Loop]:
    """Make the loops of one horizontal axis and of the tilt angle that accelerates along it."""
    names = ("x_sum", "x", "v", "tilt_sum", "tilt", "rate", "torque")
    one = dict(zip(names, np.eye(len(names))))
    force = -drag[along, along] * one["v"] - sign * drag[along, about] * one["rate"]
    air = -sign * drag[about, along] * one["v"] - drag[about, about] * one["rate"]
    force, air = force / vehicle.mass, air / vehicle.inertia[about - 3, about - 3]
    gravity, above = float(np.linalg.norm(vehicle.gravity)), float(vehicle.center_of_mass[2])
    place = one["x"] - above * one["tilt"]  # of the frame's origin, which odometry measures
    moved = one["v"] - above * one["rate"]
    demand = _pid(gains, "xy", one["x_sum"], place, moved)
    wanted = (demand - force * gains["drag"]) / gravity
    inner = _pid(gains, "rp", one["tilt_sum"], one["tilt"], one["rate"]) - air * gains["drag"]
    k_p = gains["scale"] * gains["kp_rp"]
    rates = {
        "x_sum": -place,
        "x": one["v"],
        "v": gravity * one["tilt"] + force,
        "tilt_sum": wanted - one["tilt"],
        "tilt": one["rate"],
        "rate": one["torque"] + air,
        "torque": -one["torque"] / lag,
    }
    entry = one["torque"] / lag
    sums = [name for name in ("xy", "rp") if gains[f"ki_{name}"] == 0]
    unused = [{"xy": "x_sum", "rp": "tilt_sum"}[name] for name in sums]
    whole = [name for name in names if name not in unused]
    alone = [name for name in whole if name not in ("x_sum", "x", "v")]
    rates_alone = {**rates, "tilt_sum": -one["tilt"]}
    return {
        "x, y": _pick(whole, names, rates, entry, inner + k_p * wanted),
        "roll, pitch": _pick(alone, names, rates_alone, entry, inner),
    }


def _make_height(
    gains: Mapping[str, float], vehicle: Vehicle, drag: np.ndarray, lag: float
) -> Loop:
    air = drag[2, 2] / vehicle.mass
    return _make_plain(gains, "z", lag, air, air * gains["drag"])


def make_yaw(
    gains: Mapping[str, float], vehicle: Vehicle, drag: np.ndarray, lag: float, zero: float
) -> Loop:
    """Make the yaw loop; parameters as for `make_loops`.

    A finite `zero` (1/s) models the reaction to the acceleration of the rotors. When the vehicle
    starts to yaw, the rotors lag behind, which changes their relative speed and the air torque.
    """
    inertia = vehicle.inertia[2, 2]
    air = drag[5, 5] / inertia
    behind = 0.0 if math.isinf(zero) else float(vehicle.rotor_inertia.sum()) / inertia
    return _make_plain(gains, "yaw", lag, air, air * gains["drag"], zero, behind)


def _make_plain(
    gains: Mapping[str, float],
    axis: str,
    lag: float,
    air: float,
    compensated: float,
    zero: float = math.inf,
    behind: float = 0.0,
) -> Loop:
    """Make the loop of a coordinate that the rotors accelerate directly, with air drag."""
    names = ("sum", "value", "rate", "push")
    one = dict(zip(names, np.eye(len(names))))
    demand = _pid(gains, axis, one["sum"], one["value"], one["rate"]) + compensated * one["rate"]
    # With the acceleration a: a = push - (d push/dt) / z - air rate, and
    # d push/dt = (demand - push) / lag - behind z a.
    part = 1 / (zero * lag)
    acceleration = ((1 + part) * one["push"] - air * one["rate"]) / (1 - behind)
    of_demand = -part / (1 - behind)
    left = behind * zero if behind else 0.0
    rates = {
        "sum": -one["value"],
        "value": one["rate"],
        "rate": acceleration,
        "push": -one["push"] / lag - left * acceleration,
    }
    entry = of_demand * one["rate"] + (1 / lag - left * of_demand) * one["push"]
    kept = [name for name in names if name != "sum" or gains[f"ki_{axis}"] != 0]
    return _pick(kept, names, rates, entry, demand)


def _pid(gains: Mapping[str, float], axis: str, total: Any, value: Any, rate: Any) -> np.ndarray:
    """Return the demand that drives a value to 0; `total` is the integral of its error."""
    p, i, d = (gains["scale"] * gains[f"k{part}_{axis}"] for part in "pid")
    demand: np.ndarray = -p * value + i * total - d * rate
    return demand


def _pick(
    kept: Sequence[str],
    names: Sequence[str],
    rates: Mapping[str, np.ndarray],
    entry: np.ndarray,
    demand: np.ndarray,
) -> Loop:
    """Make a loop from a subset of the states."""
    at = [names.index(name) for name in kept]
    return Loop(np.array([rates[name][at] for name in kept]), entry[at], demand[at])
