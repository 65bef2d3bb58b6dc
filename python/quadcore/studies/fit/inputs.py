"""Rotor speeds that correspond to the inputs of a recording."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ..._core import InputError, Rotor, parse_number
from ...formats.recordings.series import Series
from ...support.parameters import suggest
from ...support.values import format_value
from .prepared import PreparedFlight
from .smoothing import fit_locally

MAP = {"inputs.speed": "rad/s", "inputs.exponent": "", "inputs.battery": ""}
"""Parameters of the map from commands to rotor speeds: w = speed u^exponent (V / full)^battery."""

DELAY = "inputs.delay"
"""Delay of the inputs relative to the pose. Each flight has its own delay unless it is fixed."""

INPUTS = {**MAP, DELAY: "s"}
"""Parameters of the inputs with their units."""

_LONGEST = 0.12  # s; maximum magnitude of the delay

INPUT_BOUNDS = {
    "inputs.speed": (0.0, np.inf),
    "inputs.exponent": (0.3, 2.0),
    "inputs.battery": (0.0, 2.0),
    DELAY: (-_LONGEST, _LONGEST),
}
"""Minimum and maximum of each parameter. The exponents cover a speed controller and a thrust
proportional to the squared speed. Measured rotor speeds may be late, which gives a negative
delay."""

_PREFIX = "inputs."

FULL_VOLTAGE = 4.2
"""Battery voltage at which `inputs.speed` is defined, V."""

_MEMORY = 0.4  # s; inputs before a window that affect the speeds at its start
_STEP = 5e-3  # s; step of the integration over these inputs
_DENSE = 2.0
"""Number of rotor speed samples per tick above which they are averaged."""

TICK = 5e-3
"""Duration of a constant command, s; shorter than the time constants of vehicles and motors."""


def split_inputs(
    parameters: Optional[Mapping[str, Any]],
) -> Tuple[Dict[str, float], Dict[str, Any]]:
    """Split parameters into those of the inputs and others.

    Raises
    ------
    InputError
        If an input parameter is unknown, not a number, or out of bounds.
    """
    given, others = {}, {}
    for name, value in (parameters or {}).items():
        if not name.startswith(_PREFIX):
            others[name] = value
            continue
        if name not in INPUTS:
            raise InputError(
                f"set {name}: the inputs have no such parameter.{suggest(name, list(INPUTS))} "
                f"Use one of {', '.join(INPUTS)}."
            )
        number = parse_number(format_value(value))
        low, high = INPUT_BOUNDS[name]
        if number is None or not low <= number <= high:
            raise InputError(
                f"set {name}: '{value}' is no number from {low:g} to {high:g}. Give one."
            )
        given[name] = number
    return given, others


def demand_speeds(
    flight: PreparedFlight, time: np.ndarray, values: Mapping[str, float], rotors: int
) -> np.ndarray:
    """Return the speed of each rotor that the inputs demand, unsigned, rad/s.

    Parameters
    ----------
    flight
        Flight with measured rotor speeds or commands; measured speeds take precedence.
    time : ndarray
        Times, s; any shape.
    values
        Values of `MAP`.
    rotors
        Number of rotors of the model.

    Returns
    -------
    ndarray (*time.shape, rotors)
    """
    given = flight.rotors if flight.rotors is not None else flight.commands
    assert given is not None
    if given.values.shape[1] != rotors:
        raise InputError(
            f"{flight.where}: the recording has {given.values.shape[1]} rotors, the model {rotors}."
        )
    if flight.rotors is not None:
        return _trace_rotors(flight.rotors, time)
    level = np.stack([np.interp(time, given.time, column) for column in given.values.T], axis=-1)
    speeds: np.ndarray = values["inputs.speed"] * np.clip(level, 0, 1) ** values["inputs.exponent"]
    if flight.battery is not None:
        volts = np.interp(time, flight.battery.time, flight.battery.values[:, 0])
        speeds = speeds * (volts[..., None] / FULL_VOLTAGE) ** values["inputs.battery"]
    return speeds


def _trace_rotors(rotors: Series, time: np.ndarray) -> np.ndarray:
    """Interpolate measured speeds by a cubic spline; smoothing would bias a fit.

    Densely sampled speeds are first averaged by local polynomials.
    """
    from scipy.interpolate import CubicSpline

    values = np.abs(rotors.values)
    if _DENSE * float(np.median(np.diff(rotors.time))) < TICK:
        values = fit_locally(rotors.time, values, rotors.time, TICK)[0]
    inside = np.clip(time, rotors.time[0], rotors.time[-1])
    return np.asarray(np.maximum(CubicSpline(rotors.time, values)(inside), 0))


def lead_speeds(
    flight: PreparedFlight, start: np.ndarray, ticks: int, constants: np.ndarray
) -> np.ndarray:
    """Return the commands that produce the measured speeds at the ends of the ticks.

    During a tick, a first-order motor changes its speed from w0 to w1 = e w0 + (1 - e) c with e =
    exp(-tick/tau). This equation gives the command c.

    Parameters
    ----------
    flight
        Flight with measured rotor speeds.
    start : ndarray (n,)
        Times at which the first ticks start, s.
    ticks
        Number of ticks.
    constants : ndarray (rotors,)
        Motor time constants tau, s.

    Returns
    -------
    ndarray (n, ticks, rotors)
    """
    ends = start[:, None] + TICK * np.arange(ticks + 1)
    speeds = demand_speeds(flight, ends, {}, len(constants))
    kept = np.exp(-TICK / np.maximum(np.nan_to_num(constants), 1e-4))
    lead: np.ndarray = np.maximum((speeds[:, 1:] - kept * speeds[:, :-1]) / (1 - kept), 0)
    return lead


def lag_speeds(
    flight: PreparedFlight,
    start: np.ndarray,
    values: Mapping[str, float],
    constants: np.ndarray,
) -> np.ndarray:
    """Return the demanded speeds after first-order lags, at some times; shape (n, rotors).

    Parameters
    ----------
    flight, values
        As for `demand_speeds`.
    start : ndarray (n,)
        Times after correction by the delay, s.
    constants : ndarray (rotors,)
        Motor time constants, s.
    """
    ages = np.arange(0.5 * _STEP, _MEMORY, _STEP)
    demanded = demand_speeds(flight, start[:, None] - ages, values, len(constants))
    weight = np.exp(-ages[:, None] / np.maximum(constants, 1e-4))
    speeds: np.ndarray = np.sum(demanded * weight, axis=1) / np.sum(weight, axis=0)
    return speeds


def guess_inputs(
    flights: Sequence[PreparedFlight],
    rotors: Sequence[Rotor],
    weight: float,
    given: Mapping[str, float],
) -> Dict[str, float]:
    """Guess the map from the balance of mean thrust and weight.

    Parameters
    ----------
    weight
        Weight of the vehicle, N.
    given
        Known values of `INPUTS`, which replace the guesses.
    """
    values = {"inputs.speed": 1.0, "inputs.exponent": 1.0, "inputs.battery": 0.5, **given}
    if "inputs.speed" in given:
        return values
    squares: List[float] = []
    for flight in flights:
        if flight.commands is None:
            continue
        time = np.arange(*flight.span, 0.02)
        level = demand_speeds(flight, time, values, len(rotors))
        squares.append(float(np.mean(level**2 @ [rotor.thrust_coefficient for rotor in rotors])))
    if squares:
        values["inputs.speed"] = float(np.sqrt(weight / np.mean(squares)))
    return values
