"""Poles and linear margins of the cascaded controllers on a vehicle in hover.

Around hover the axes are decoupled. The rotors follow commands as 1/(tau s + 1), where tau is
I_R/k_p or the lead time of the controller. Each angle follows the command of the outer loop through
a PID, with the derivative acting on the measured rate. Without air drag,

    phi/phi_d = (k_p s + k_i) / (s^3 (tau s + 1) + k_d s^2 + k_p s + k_i),

and the tilted thrust moves the vehicle in the loop of the position PID. In yaw, two torques act
together: the aerodynamic torque b w^2 of the rotors, and the reaction I_R dw/dt to their
acceleration. Chapter 2 omits the reaction, which adds the factor (1 - s/z), z = 2 b w_0 sim_slow /
I_R. For b > 0 the zero lies in the right half-plane: the vehicle first yaws in the wrong direction.

Air drag adds a wrench about the centre of mass that is linear in the twist of the vehicle.
Controllers with drag compensation subtract the same wrench, computed from the measured twist.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict, List

import numpy as np

from ... import _core
from ..._core import QuadcoreError
from ...control.built_in import BuiltInController
from ...simulation.engines import exerts_wrenches
from ...simulation.simulation import Simulation
from .linear_loops import Loop, make_loops, make_yaw, measure_drag

if TYPE_CHECKING:
    from ...thesis.chapter2 import Vehicle


def read_gains(controller: BuiltInController) -> Dict[str, float]:
    """Return all parameters of a controller, including default values."""
    table = next(entry[2] for entry in _core.controllers() if entry[0] == controller.name)
    flags = {"true": 1.0, "false": 0.0}
    defaults = {
        spec.name: flags.get(spec.default, _core.parse_number(spec.default)) for spec in table
    }
    return {**{n: v for n, v in defaults.items() if v is not None}, **controller.parameters}


def has_poles(controller: Any) -> bool:
    """Whether a controller is a cascade of PID controllers."""
    return isinstance(controller, BuiltInController) and {"kp_xy", "ki_rp", "kd_yaw"} <= set(
        read_gains(controller)
    )


def compute_poles(controller: BuiltInController, simulation: Simulation) -> List[Dict[str, Any]]:
    """Compute the poles and delay margin of each axis.

    Parameters
    ----------
    controller
        Controller for which `has_poles` is true.
    simulation
        Vehicle and engine. The function changes the state.

    Returns
    -------
    list of dict
        Row per axis: ``axis``, ``poles`` (complex, 1/s), ``zero`` (1/s, infinite without a zero),
        ``stable``, and ``because``, the cause of instability. ``delay_margin`` (s) is the delay at
        the motor input, beyond the controller's own delay and half its period, that the linear loop
        tolerates. It is NaN for an unstable loop.

    Raises
    ------
    InputError
        If the equations of chapter 2 do not cover the vehicle.
    """
    from ...thesis.chapter2 import Vehicle  # scipy is slow to import

    gains, vehicle = read_gains(controller), Vehicle.of(simulation)
    inertia = float(np.mean(vehicle.rotor_inertia))
    lag = inertia / vehicle.motor_gain
    drag = measure_drag(simulation) if exerts_wrenches(simulation.engine) else vehicle.linear_drag
    zero = _compute_zero(vehicle) if exerts_wrenches(simulation.engine) else math.inf
    if gains["lead"]:
        lag = min(lag, gains["lead_time"])
    loops = make_loops(gains, vehicle, drag, lag)
    loops["yaw"] = make_yaw(gains, vehicle, drag, lag, zero)
    without = make_yaw(gains, vehicle, drag, lag, math.inf).find_poles()
    causes = {"x, y": _explain_xy(gains), "yaw": _explain_yaw(zero, without)}
    known = controller.delay + 0.5 / controller.rate
    return [
        _make_row(axis, loop, zero if axis == "yaw" else math.inf, causes.get(axis, ""), known)
        for axis, loop in loops.items()
    ]


def find_yaw_zero(simulation: Simulation) -> float:
    """Return the zero of the yaw dynamics in hover, 1/s; infinite without a zero.

    The simulation defines vehicle and engine. Vehicles that chapter 2 does not cover have no zero.
    """
    from ...thesis.chapter2 import Vehicle  # scipy is slow to import

    try:
        vehicle = Vehicle.of(simulation)
    except QuadcoreError:
        return math.inf
    return _compute_zero(vehicle) if exerts_wrenches(simulation.engine) else math.inf


def describe_yaw_zero(zero: float) -> str:
    """Describe a zero in the right half-plane and its effect on gains; "" for any other zero."""
    if not 0 < zero < math.inf:
        return ""
    return (
        f"the yaw dynamics have a zero at +{zero:.3g} 1/s: rotors that spin up first turn the "
        "vehicle the wrong way. A faster yaw loop is unstable, so attitude gains that are equal on "
        "all axes can crash it. Use lower gains for yaw."
    )


def _compute_zero(vehicle: Vehicle) -> float:
    """Return z = 2 b w_0 sim_slow / I_R, 1/s."""
    weight = vehicle.mass * float(np.linalg.norm(vehicle.gravity))
    hover = math.sqrt(weight / (len(vehicle.arms) * vehicle.k))
    zero: float = 2 * vehicle.b * hover * vehicle.slow / float(np.mean(vehicle.rotor_inertia))
    return zero if zero else math.inf


def _explain_xy(gains: Dict[str, float]) -> str:
    d, p, i = (gains["scale"] * gains[f"k{part}_xy"] for part in "dpi")
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


def _make_row(axis: str, loop: Loop, zero: float, cause: str, delay: float) -> Dict[str, Any]:
    poles = loop.find_poles()
    stable = bool(np.all(poles.real < 0))
    return {
        "axis": axis,
        "poles": [complex(pole) for pole in poles[np.lexsort((poles.imag, -poles.real))]],
        "zero": zero,
        "stable": stable,
        "because": "" if stable else cause,
        "delay_margin": loop.find_delay_margin() - delay if stable else math.nan,
    }


def format_poles(row: Dict[str, Any], count: int = 3) -> str:
    """Format the rightmost poles; each conjugate pair appears once."""
    shown = [pole for pole in row["poles"] if pole.imag >= 0][:count]
    return ", ".join(f"{p.real:.3g}" + (f" +- {p.imag:.3g}i" if p.imag else "") for p in shown)
