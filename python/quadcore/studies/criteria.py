"""Criteria of a study: failure limit, constraints and additional metrics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .._core import InputError, QuadcoreError, find_clearance
from ..simulation.log import Log
from ..support.arguments import shorten
from ..support.rotation import compute_tilts
from ..support.user_code import describe_error, find_object
from . import estimation_errors, tracking_errors
from .grouped_flights import FlightRecord
from .tracking_metrics import FAILURE_DISTANCE, MEANINGS, UNITS


class _Constraint(NamedTuple):
    """Kind of constraint."""

    unit: str
    meaning: str
    """Description with a placeholder for the limit."""
    find: Callable[[FlightRecord, Sequence[float]], np.ndarray]
    """Returns a boolean array (rows), true where the limit is violated."""
    size: int = 1
    """Number of values of the limit."""


def _exceeds(compute: Callable[[Log], np.ndarray]) -> Callable[..., np.ndarray]:
    return lambda flight, limit: np.asarray(compute(flight.log) > limit[0])


def _compute_accelerations(log: Log) -> np.ndarray:
    """Return the norm of the mean acceleration until the next row, m/s^2; 0 for the last row."""
    change = np.diff(log.linear_velocity, axis=0) / np.diff(log.time)[:, None]
    return np.append(np.linalg.norm(change, axis=1), 0.0)


def _is_close(flight: FlightRecord, limit: Sequence[float]) -> np.ndarray:
    distances, _ = find_clearance(flight.model, flight.world, flight.log.table[:, 1:8])
    return np.asarray(distances < limit[0])


def _is_outside(flight: FlightRecord, limit: Sequence[float]) -> np.ndarray:
    low, high = np.array(limit[:3]), np.array(limit[3:])
    position = flight.log.position
    return np.asarray(((position < low) | (position > high)).any(axis=1))


CONSTRAINTS = {
    "tilt": _Constraint(
        "rad", "tilt above {} rad", _exceeds(lambda log: compute_tilts(log.orientation))
    ),
    "speed": _Constraint(
        "m/s",
        "speed above {} m/s",
        _exceeds(lambda log: np.linalg.norm(log.linear_velocity, axis=1)),
    ),
    "rate": _Constraint(
        "rad/s",
        "angular velocity above {} rad/s",
        _exceeds(lambda log: np.linalg.norm(log.angular_velocity, axis=1)),
    ),
    "acceleration": _Constraint(
        "m/s^2", "acceleration above {} m/s^2", _exceeds(_compute_accelerations)
    ),
    "clearance": _Constraint("m", "less than {} m from an obstacle", _is_close),
    "geofence": _Constraint("m", "outside the box {} m", _is_outside, 6),
}
"""Supported constraints by name."""

Metric = Union[str, Callable[[Log], float]]

METRICS = {**tracking_errors.METRICS, **estimation_errors.METRICS}
"""For each built-in metric, the unit and meaning of each of its values."""


@dataclass(frozen=True)
class Criteria:
    """Failure limit, constraints and additional metrics of a study.

    Raises
    ------
    InputError
        From `make`, if a constraint or metric does not exist or a limit is invalid.
    """

    failure_distance: float = FAILURE_DISTANCE
    """Tracking error above which a flight has failed, m."""
    constraints: Tuple[Tuple[str, Tuple[float, ...]], ...] = ()
    """Name and limit of each constraint."""
    metrics: Tuple[Metric, ...] = ()
    """Names in `METRICS`, ``FILE.py:NAME``, ``MODULE:NAME``, or functions."""

    @classmethod
    def make(
        cls,
        failure_distance: float,
        constraints: Optional[Mapping[str, Any]],
        metrics: Sequence[Metric],
    ) -> Criteria:
        """Check the criteria options of a study, and import its metrics."""
        limits = {name: _read_limit(name, value) for name, value in (constraints or {}).items()}
        made = cls(float(failure_distance), tuple(limits.items()), tuple(metrics))
        names: List[str] = list(UNITS)
        for metric in made.metrics:
            for name in _list_columns(metric):
                if name in names:
                    raise InputError(f"metric '{name}' is named twice. Remove or rename one.")
                names.append(name)
            if metric not in METRICS:
                _find_function(metric)
        return made

    @property
    def units(self) -> Dict[str, str]:
        """Unit of each metric of the study, by name."""
        found = {f"{name}_violation": "s" for name, _ in self.constraints}
        for metric in self.metrics:
            known = METRICS.get(metric, {}) if isinstance(metric, str) else {}
            found.update({name: known.get(name, ("",))[0] for name in _list_columns(metric)})
        return {**UNITS, **found}

    @property
    def meanings(self) -> Dict[str, str]:
        """Meaning of each metric of the study, by name."""
        found = {}
        for name, limit in self.constraints:
            numbers = ", ".join(f"{x:g}" for x in limit)
            found[f"{name}_violation"] = f"time with {CONSTRAINTS[name].meaning.format(numbers)}"
        for metric in self.metrics:
            if isinstance(metric, str) and metric in METRICS:
                known = METRICS[metric]
                found.update({name: meaning for name, (_, meaning) in known.items()})
            else:
                found[_list_columns(metric)[0]] = f"your metric {_name(metric)}"
        return {**MEANINGS, **found}

    @property
    def needs_flat_states(self) -> bool:
        """Whether a metric compares the flight with the attitude of the reference."""
        return any(metric in tracking_errors.METRICS for metric in self.metrics)

    @property
    def needs_estimates(self) -> bool:
        """Whether a metric compares the estimates of the controllers with the true states."""
        return any(metric in estimation_errors.METRICS for metric in self.metrics)

    def measure(self, flight: FlightRecord) -> Dict[str, float]:
        """Compute the constraint violations and metrics of a completed flight.

        Raises
        ------
        QuadcoreError
            If a user-defined metric fails.
        """
        found: Dict[str, float] = {}
        spacing = np.diff(flight.log.time)
        for name, limit in self.constraints:
            is_known = name != "clearance" or len(flight.world.obstacles) > 0
            violated = CONSTRAINTS[name].find(flight, limit)[:-1] if is_known else np.array([])
            found[f"{name}_violation"] = float(spacing[violated].sum()) if is_known else np.nan
        for metric in self.metrics:
            if isinstance(metric, str) and metric in tracking_errors.METRICS:
                found.update(tracking_errors.measure(metric, flight.log, flight.flat_states))
            elif isinstance(metric, str) and metric in estimation_errors.METRICS:
                found.update(estimation_errors.measure(flight.estimate_errors))
            else:
                found[_list_columns(metric)[0]] = _call(metric, flight.log)
        return found


DEFAULT = Criteria()
"""Criteria of a study without criteria options."""


def _read_limit(name: str, value: Any) -> Tuple[float, ...]:
    if name not in CONSTRAINTS:
        raise InputError(
            f"constraint '{name}' does not exist. Use one of {', '.join(CONSTRAINTS)}."
        )
    parts = value.split(",") if isinstance(value, str) else np.ravel(value)
    try:
        limit = tuple(float(part) for part in parts)
    except (TypeError, ValueError):
        limit = ()
    size = CONSTRAINTS[name].size
    if len(limit) != size or not np.isfinite(limit).all():
        form = "a number" if size == 1 else "XMIN,YMIN,ZMIN,XMAX,YMAX,ZMAX"
        raise InputError(f"constraint '{name}' is {shorten(value)}. Give {form}.")
    return limit


def _name(metric: Metric) -> str:
    return metric if isinstance(metric, str) else getattr(metric, "__name__", "metric")


def _list_columns(metric: Metric) -> List[str]:
    """List the columns of a metric."""
    if isinstance(metric, str) and metric in METRICS:
        return list(METRICS[metric])
    return [_name(metric).rpartition(":")[2]]


def _find_function(metric: Metric) -> Callable[[Log], float]:
    if not isinstance(metric, str):
        return metric
    if ":" not in metric:
        raise InputError(
            f"metric '{metric}' does not exist. Use {', '.join(METRICS)}, "
            "FILE.py:NAME or MODULE:NAME."
        )
    found: Callable[[Log], float] = find_object(f"metric '{metric}'", metric, lambda one: one)
    if not callable(found):
        raise InputError(f"metric '{metric}' cannot be called as function(log). Define it so.")
    return found


def _call(metric: Metric, log: Log) -> float:
    function = _find_function(metric)
    try:
        value = function(log)
        return float(value)
    except (KeyboardInterrupt, MemoryError):
        raise
    except BaseException as error:  # includes SystemExit
        raise QuadcoreError(f"metric '{_name(metric)}': {describe_error(error)}") from error
