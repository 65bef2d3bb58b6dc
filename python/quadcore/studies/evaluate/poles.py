"""Poles of the cascaded controllers on a vehicle in hover.

Around hover the axes are decoupled. The rotors follow commands as 1/(tau s + 1), tau = I_R/k_p. An
angle follows the command of the outer loop through a PID; its derivative acts on the measured rate,

    phi/phi_d = (k_p s + k_i) / (s^3 (tau s + 1) + k_d s^2 + k_p s + k_i),

and tilts the thrust, which moves the vehicle in the loop of the position PID. In yaw, two torques
act together: the aerodynamic torque b w^2 on the rotors, and the reaction I_R dw/dt to their
acceleration. Chapter 2 omits the latter, which adds (1 - s/z), z = 2 b w_0 sim_slow / I_R. For
b > 0 the zero lies in the right half-plane: the vehicle first yaws in the wrong direction. Rotor
drag is neglected.
"""

from __future__ import annotations

import math
from typing import Any, Dict, List

import numpy as np

from ... import _core
from ...control.built_in import BuiltInController
from ...simulation.engines import exerts_wrenches
from ...simulation.simulation import Simulation

Polynomial = np.ndarray


def read_gains(law: BuiltInController) -> Dict[str, float]:
    """Return all parameters of a controller, defaults included."""
    table = next(entry[2] for entry in _core.controllers() if entry[0] == law.name)
    flags = {"true": 1.0, "false": 0.0}
    defaults = {
        spec.name: flags.get(spec.default, _core.parse_number(spec.default)) for spec in table
    }
    return {**{n: v for n, v in defaults.items() if v is not None}, **law.parameters}


def has_poles(law: Any) -> bool:
    """Whether a controller is a cascade of PIDs."""
    return isinstance(law, BuiltInController) and {"kp_xy", "ki_rp", "kd_yaw"} <= set(
        read_gains(law)
    )


def compute_poles(law: BuiltInController, simulation: Simulation) -> List[Dict[str, Any]]:
    """Compute the poles of each axis.

    Parameters
    ----------
    law
        Controller for which `has_poles` is true.
    simulation
        Vehicle and engine.

    Returns
    -------
    list of dict
        Row per axis: ``axis``, ``poles`` (complex, 1/s), ``zero`` (1/s, infinite without one),
        ``stable``, and ``because``, the cause of instability.

    Raises
    ------
    InputError
        If chapter 2 cannot describe the vehicle.
    """
    from ...thesis.chapter2 import Vehicle  # scipy is slow to import

    gains, vehicle = read_gains(law), Vehicle.of(simulation)
    inertia = float(np.mean(vehicle.rotor_inertia))
    lag = np.array([inertia / vehicle.motor_gain, 1.0])
    zero = math.inf
    if exerts_wrenches(simulation.engine):
        weight = vehicle.mass * float(np.linalg.norm(vehicle.gravity))
        hover = math.sqrt(weight / (len(vehicle.arms) * vehicle.k))
        zero = 2 * vehicle.b * hover * vehicle.slow / inertia
    roll = _pid_polynomial(gains, "rp")
    tilt = np.polyadd(np.polymul([1, 0, 0, 0], lag), roll)  # of phi/phi_d above, and its numerator
    answer = roll[1:]
    side = np.polyadd(
        np.polymul([1, 0, 0, 0], tilt), np.polymul(_pid_polynomial(gains, "xy"), answer)
    )
    height = np.polyadd(np.polymul([1, 0, 0, 0], lag), _pid_polynomial(gains, "z"))
    turned = np.polymul([-1 / zero, 1.0], _pid_polynomial(gains, "yaw"))
    yaw = np.polyadd(np.polymul([1, 0, 0, 0], lag), turned)
    without = np.polyadd(np.polymul([1, 0, 0, 0], lag), _pid_polynomial(gains, "yaw"))
    return [
        _make_row("x, y", side, math.inf, _explain_xy(gains)),
        _make_row("z", height, math.inf, ""),
        _make_row("roll, pitch", tilt, math.inf, ""),
        _make_row("yaw", yaw, zero, _explain_yaw(zero, _find_roots(without))),
    ]


def _explain_xy(gains: Dict[str, float]) -> str:
    d, p, i = _pid_polynomial(gains, "xy")
    if d * p > i:
        return "the inner loop is too slow for the outer one"
    return (
        f"Kd Kp = {d * p:.3g} is not above Ki = {i:.3g}: by Routh and Hurwitz unstable however "
        "fast the inner loop is"
    )


def _explain_yaw(zero: float, without: np.ndarray) -> str:
    if math.isinf(zero) or zero < 0 or np.any(without.real >= 0):
        return ""
    return (
        f"the zero at 2 b w0 sim_slow / I_R = +{zero:.3g} 1/s: spinning up, the rotors first turn "
        "the vehicle the wrong way, and the loop is faster than that; without the zero it is stable"
    )


def _pid_polynomial(gains: Dict[str, float], axis: str) -> Polynomial:
    """Return the coefficients of k_d s^2 + k_p s + k_i."""
    return gains["scale"] * np.array([gains[f"k{part}_{axis}"] for part in "dpi"])


def _make_row(axis: str, polynomial: Polynomial, zero: float, cause: str) -> Dict[str, Any]:
    roots = _find_roots(polynomial)
    stable = bool(np.all(roots.real < 0))
    return {
        "axis": axis,
        "poles": [complex(root) for root in roots[np.lexsort((roots.imag, -roots.real))]],
        "zero": zero,
        "stable": stable,
        "because": "" if stable else cause,
    }


def _find_roots(polynomial: Polynomial) -> np.ndarray:
    # A gain of 0 leaves an unexcited pole at 0.
    roots: np.ndarray = np.roots(np.trim_zeros(polynomial))
    return roots


def format_poles(row: Dict[str, Any], count: int = 3) -> str:
    """Format the rightmost poles, one of each conjugate pair."""
    shown = [pole for pole in row["poles"] if pole.imag >= 0][:count]
    return ", ".join(f"{p.real:.3g}" + (f" +- {p.imag:.3g}i" if p.imag else "") for p in shown)
