"""Rotor speeds that the inputs of a recording demand."""

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
"""Parameters of the map from commands to speeds: w = speed u^exponent (V / full)^battery."""

DELAY = "inputs.delay"
"""Delay of the inputs behind the pose. Each flight has its own, unless it is fixed."""

INPUTS = {**MAP, DELAY: "s"}
"""Parameters of the inputs, with their units."""

_LONGEST = 0.12  # s

INPUT_BOUNDS = {
    "inputs.speed": (0.0, np.inf),
    "inputs.exponent": (0.3, 2.0),
    "inputs.battery": (0.0, 2.0),
    DELAY: (-_LONGEST, _LONGEST),
}
"""Minimum and maximum: exponents lie between those of a speed controller and of a thrust over speed
squared. Measured rotor speeds may be late, and have negative delays."""

_PREFIX = "inputs."

FULL_VOLTAGE = 4.2
"""Voltage that `inputs.speed` refers to, V."""

_MEMORY = 0.4  # s before a window that count for the speeds at its start
_STEP = 5e-3  # s
_DENSE = 2.0
"""Samples of rotor speeds per tick from which they are averaged."""

TICK = 5e-3
"""Duration of a command, s: the motions of a vehicle and its motors take longer."""


def split_inputs(
    parameters: Optional[Mapping[str, Any]],
) -> Tuple[Dict[str, float], Dict[str, Any]]:
    """Split parameters into those of the inputs and the other parameters.

    Raises
    ------
    InputError
        If a parameter of the inputs is unknown, no number, or out of its bounds.
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
    """Return the demanded speed of each rotor, unsigned, rad/s.

    Parameters
    ----------
    flight
        Flight with commands, or else measured rotor speeds.
    time : ndarray
        Times of any shape, s.
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
    """Interpolate measured speeds by a cubic spline, without smoothing, which would bias a fit.

    Samples that are closer than a tick are averaged by local polynomials first.
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
    """Return the commands that give the measured speeds at the ends of the ticks.

    A motor of the first order goes from w0 to w1 = e w0 + (1 - e) c with e = exp(-tick/tau), which
    gives the command c.

    Parameters
    ----------
    flight
        Flight with measured rotor speeds.
    start : ndarray (n,)
        Times, s.
    ticks
        Number of ticks.
    constants : ndarray (rotors,)
        Time constants tau, s.

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
    """Return the speeds at some times behind first-order lags, shape (n, rotors).

    Parameters
    ----------
    flight, values
        As for `demand_speeds`.
    start : ndarray (n,)
        Times, s, already moved by the delay.
    constants : ndarray (rotors,)
        Time constants, s.
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
    """Guess the map from the balance of thrust and weight in the mean of the flights.

    Parameters
    ----------
    weight
        Weight of the vehicle, N.
    given
        Known values of `INPUTS`.
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
