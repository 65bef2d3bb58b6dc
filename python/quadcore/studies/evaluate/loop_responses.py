"""Frequency responses of the loops in hover, measured with injection at the plant input.

A multisine is added to one component of the wrench that the controller commands: the thrust, or the
torque about an axis. With the commanded component c and the injected component d, the plant
receives u = c + d. The loop gain is L = -C/U and the sensitivity is S = U/D = 1/(1 + L), from the
Fourier coefficients at the injected frequencies. The other components remain under control, so the
loops of roll and pitch include those of y and x.

Reference: J. Schoukens, R. Pintelon, System Identification: A Frequency Domain Approach, 2nd ed.,
2012, chapters 2 and 7. M. R. Schroeder, Synthesis of low-peak-factor signals, IEEE Transactions on
Information Theory 16 (1970), 85-89.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

import numpy as np

from ..._core import FlightError, InputError, QuadcoreError
from ...control import references
from ...control.controller import check_callable
from ...control.inner_loop import SET_POINTS, InnerLoop
from ...control.plugin_controller import PluginController
from ...control.rate_and_delay import RATE
from ...control.vectorized import command_one, is_vectorized
from ...control.vehicle import Vehicle
from ...support.values import SPAWN, check_pose
from ...support.warning import suppress_warnings
from ..cases import Case
from ..executor import run_contained
from ..time_limit import time_limit
from ..tracking_metrics import describe_failure
from .loop_margins import find_margins
from .plan import Plan

AXES = ("z", "roll", "pitch", "yaw")
"""Loops, in the order of the rows of `Vehicle.allocation`."""

_LINEAR = {"z": "z", "roll": "x, y", "pitch": "x, y", "yaw": "yaw"}
"""Axis of `compute_poles` that corresponds to each loop."""

_PERIOD = 20.0  # s; period of the multisine
_SETTLE = 20.0  # s; settling time before the first evaluated row
_LINES = 60  # number of frequencies
_FASTEST = 40.0  # Hz; the maximum frequency, at most a quarter of the controller's rate
_SIZE = 0.01  # RMS of the injection, relative to the sum of the rotors' shares in hover
_REJECTED = math.sqrt(0.5)  # |S| at the upper end of the disturbance rejection band

NAMES = (
    "crossover", "phase_margin", "gain_low", "gain_high", "delay_margin", "linear_delay_margin",
    "rejection_band", "rejection_peak",
)  # fmt: skip
"""Results for each loop: rad/s, rad, factors, s, s, rad/s, and the maximum of \\|S\\|."""


class Response(NamedTuple):
    """Measured response of a loop."""

    frequencies: np.ndarray
    """Frequencies, rad/s; shape (n,)."""
    loop: np.ndarray
    """Complex loop gain L, shape (n,)."""
    sensitivity: np.ndarray
    """Complex sensitivity S, shape (n,)."""


def measure_loops(plan: Plan, poles: Sequence[Mapping[str, Any]]) -> List[Dict[str, Any]]:
    """Measure the loops of each controller in hover, at the first point of the plan.

    Parameters
    ----------
    plan
        Plan of the evaluation.
    poles
        Rows of `compute_poles`, with the names of controller, model and engine.

    Returns
    -------
    list of dict
        Row per controller, engine, model and axis: ``failure``, the values of `NAMES`, and the
        lists ``frequencies`` (rad/s), ``gain`` and ``phase`` (rad) of the loop.
    """
    cases = [
        (Case(i, engine=engine, model=model), axis)
        for i in range(len(plan.control.controllers))
        for engine in range(len(plan.engines))
        for model in range(len(plan.models))
        for axis in range(len(AXES))
    ]
    rows: List[Dict[str, Any]] = [{} for _ in cases]

    def fly(each: Tuple[Case, int]) -> Response:
        with time_limit(plan.options.time_limit), suppress_warnings():
            return _measure(plan, *each)

    def take(index: int, found: Union[Response, QuadcoreError]) -> None:
        case, axis = cases[index]
        sides = plan.name_sides(case)
        names = {name: sides[name] for name in ("controller", "engine", "model")}
        names["axis"] = AXES[axis]
        rows[index] = {**names, **_summarise(found, _find_linear(names, poles))}

    run_contained(fly, cases, take, plan.options.processes, apart=plan.control.runs_user_code)
    return rows


def _summarise(found: Union[Response, QuadcoreError], linear: float) -> Dict[str, Any]:
    if isinstance(found, QuadcoreError):
        numbers = dict.fromkeys(NAMES, math.nan)
        return {"failure": str(found), **numbers, "frequencies": [], "gain": [], "phase": []}
    margins = find_margins(found.frequencies, found.loop)
    sizes = np.abs(found.sensitivity)
    return {
        "failure": "",
        **margins._asdict(),
        "linear_delay_margin": linear,
        "rejection_band": _find_band(found.frequencies, sizes),
        "rejection_peak": float(sizes.max()),
        "frequencies": found.frequencies.tolist(),
        "gain": np.abs(found.loop).tolist(),
        "phase": np.unwrap(np.angle(found.loop)).tolist(),
    }


def _find_linear(names: Mapping[str, str], poles: Sequence[Mapping[str, Any]]) -> float:
    """Return the delay margin of the linear loop, s; NaN if it is unknown."""
    for row in poles:
        is_loop = row["axis"] == _LINEAR[names["axis"]]
        is_same = all(row[name] == names[name] for name in ("controller", "model"))
        if is_loop and is_same and names["engine"] in row["engine"].split(", "):
            return float(row["delay_margin"])
    return math.nan


def _find_band(frequencies: np.ndarray, sizes: np.ndarray) -> float:
    """Return the bandwidth of disturbance rejection, rad/s; NaN if it is outside the range."""
    beyond = np.flatnonzero(sizes > _REJECTED)
    if not len(beyond) or beyond[0] == 0:
        return math.nan
    i = int(beyond[0])
    ends = np.log(frequencies[i - 1 : i + 1])
    return float(np.exp(np.interp(_REJECTED, sizes[i - 1 : i + 1], ends)))


def _measure(plan: Plan, case: Case, axis: int) -> Response:
    """Measure the response of one loop; raise `QuadcoreError` if the flight fails."""
    hover = references.make_hover(check_pose(SPAWN))
    flight = replace(plan.make_plan(case), reference=hover, duration=_SETTLE + _PERIOD)
    if isinstance(flight.controller, PluginController):
        raise InputError(
            f"controller '{flight.controller.file}' is a plugin, to whose commands nothing can be "
            "added. Measure the loops of other controllers."
        )
    simulation = flight.simulation()
    controller = _Injection(flight.controller, axis)
    log = simulation.run(
        flight.duration, log_every=flight.log_every, controller=controller, reference=hover
    )
    failure = describe_failure(log, plan.criteria.failure_distance)
    if failure:
        raise FlightError(failure)
    return controller.compute_response()


class _Injection:
    """Wrap a controller to add a multisine to one component of its wrench."""

    def __init__(self, controller: Any, axis: int) -> None:
        check_callable(controller)
        self._controller, self._axis = controller, axis
        self._inner_loop: Any = getattr(controller, "inner_loop", None) or InnerLoop()
        self._rows: List[Tuple[float, float, float]] = []
        rate = float(getattr(controller, "rate", RATE))
        highest = min(_FASTEST, rate / 4) * _PERIOD
        lines = np.unique(np.round(np.geomspace(1, highest, _LINES)))
        self._frequencies = 2 * np.pi * lines / _PERIOD
        # The phases of Schroeder (1970) for equal amplitudes keep the crest factor low.
        order = np.arange(1, len(lines) + 1)
        self._phases = -np.pi * order * (order - 1) / len(lines)

    vectorized = False

    def __getattr__(self, name: str) -> Any:
        return getattr(self._controller, name)

    def reset(self, simulation: Any) -> None:
        """Reset the controller, and read the properties of the vehicle."""
        reset = getattr(self._controller, "reset", None)
        if reset is not None:
            reset(simulation)
        vehicle = Vehicle(simulation)
        if not hasattr(vehicle, "allocation"):
            raise InputError("the vehicle has no rotors that are commanded by their speed.")
        self._simulation = simulation
        self._allocation, self._spins = vehicle.allocation, vehicle.spins
        self._share = np.linalg.pinv(vehicle.allocation)[:, self._axis]
        in_hover = np.abs(vehicle.allocation[self._axis]) @ np.square(vehicle.hover_speed)
        self._size = _SIZE * in_hover * math.sqrt(2 / len(self._frequencies))

    def __call__(self, t: float, state: Any, reference: Any) -> np.ndarray:
        """Return the controller's command plus the injected component."""
        speeds = self._call(t, state, reference)
        squares = self._spins * speeds * np.abs(speeds)
        injected = self._size * float(np.cos(self._frequencies * t + self._phases).sum())
        self._rows.append((t, float(self._allocation[self._axis] @ squares), injected))
        squares = np.maximum(squares + self._share * injected, 0)
        command: np.ndarray = self._spins * np.sqrt(squares)
        return command

    def _call(self, t: float, state: Any, reference: Any) -> np.ndarray:
        if is_vectorized(self._controller):
            width = len(self._spins)
            return np.asarray(command_one(self._controller, t, state, reference, width))
        speeds = self._controller(t, state, reference)
        if isinstance(speeds, SET_POINTS):
            rate = float(getattr(self._controller, "rate", RATE))
            period = max(1 / rate, self._simulation.dt)
            speeds = self._inner_loop.speeds(self._simulation, period, state, speeds)
        else:
            self._inner_loop.leave()
        return np.asarray(speeds, dtype=float)

    def compute_response(self) -> Response:
        """Compute the response from the last period by least squares."""
        rows = np.array([row for row in self._rows if row[0] >= _SETTLE - 1e-9])
        times = rows[:, 0]
        angles = np.outer(times, self._frequencies)
        drift = np.column_stack([np.ones(len(times)), times - times.mean()])
        basis = np.hstack([np.cos(angles), np.sin(angles), drift])
        values = np.column_stack([rows[:, 1], rows[:, 2]])
        found, *_ = np.linalg.lstsq(basis, values, rcond=None)
        n = len(self._frequencies)
        commanded, injected = (found[:n] - 1j * found[n : 2 * n]).T
        whole = commanded + injected
        return Response(self._frequencies, -commanded / whole, whole / injected)
