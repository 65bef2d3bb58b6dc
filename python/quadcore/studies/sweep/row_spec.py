"""Specification of a row of a sweep, which can be pickled and run in any process."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Callable, Mapping, NamedTuple, Optional, Protocol, Tuple, Union

from ..._core import FlightError, InputError, QuadcoreError
from ...control import controllers
from ...control.fair_controller import restrict
from ...control.plugin_controller import find_library
from ...report.decimation import decimate
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support.user_code import describe_error, split_name
from ...support.warning import suppress_warnings
from ..criteria import DEFAULT, Criteria
from ..grouped_flights import FlightRecord
from ..measured_flight import fly_alone, fly_and_measure, measure_record
from ..time_limit import time_limit
from . import motion_metrics

Measures = Mapping[str, float]

REFUSED = "refused: "
"""Prefix of the failure of a row that did not run because its input is invalid."""


@dataclass(frozen=True)
class UserController:
    """User-defined controller, which is made in the process of the flight."""

    text: str
    """``MODULE:CLASS``."""
    values: Tuple[Tuple[str, float], ...]
    """Values of rate, delay and parameters."""
    source: str
    """Digest of the source of its module, without imported modules."""
    privileged: bool
    """Whether the controller receives the simulation instead of a view of the vehicle."""

    @classmethod
    def of(cls, text: str, values: Mapping[str, Any], privileged: bool) -> UserController:
        """Read the controller's module without importing it."""
        given = tuple((name, value) for name, value in values.items() if value is not None)
        return cls(text, given, compute_digest(read_source(split_name(text).place)), privileged)

    def make(self, vehicle: str) -> Any:
        """Import the module and make the controller; raise `InputError` if this fails."""
        made = controllers.parse(self.text, vehicle, dict(self.values))
        return made if self.privileged else restrict(made)


@dataclass(frozen=True)
class Flight:
    """Row of a sweep that simulates a flight."""

    row: int
    names: Mapping[str, Any]
    """Values of the first columns of the table."""
    plan: FlightPlan
    """Plan of the flight; it has no controller if `own` is given."""
    own: Optional[UserController]
    limit: float
    """Wall-clock limit, s."""
    criteria: Criteria = DEFAULT

    def fingerprint(self) -> str:
        """Return a digest of all inputs; "" if an input has no digest."""
        try:
            known = self.plan.fingerprint()
        except InputError:  # user-defined objects have no digest
            return ""
        if self.own is not None:
            known = compute_digest(f"{known} {self.own}".encode())
        return known and self._add_criteria(known)

    def _add_criteria(self, known: str) -> str:
        """Add the criteria to a digest; "" if a metric is a function object."""
        if self.criteria == DEFAULT:
            return known
        names = [metric for metric in self.criteria.metrics if isinstance(metric, str)]
        if len(names) < len(self.criteria.metrics):
            return ""
        sources = [compute_digest(read_source(split_name(name).place)) for name in names]
        return compute_digest(f"{known} {self.criteria} {sources}".encode())

    def measure(self) -> Measures:
        """Simulate the flight and return its metrics.

        Raises
        ------
        QuadcoreError
            If the flight fails.
        """
        if self.own is None and self.plan.controller is None:
            with time_limit(self.limit), suppress_warnings():
                return motion_metrics.measure(self.plan.fly())
        return get_measures(self.fly(), self.criteria, self.limit)

    def fly(self) -> FlightRecord:
        """Simulate a flight with a controller; raise `QuadcoreError` if it cannot start."""
        return fly_alone(
            self._plan_with_controller, self.limit, timed=False, criteria=self.criteria
        )

    def watch(self) -> Log:
        """Simulate the flight again, and return its decimated log, even if it fails.

        Raises
        ------
        QuadcoreError
            If the flight cannot start, or exceeds the time limit.
        """
        if self.own is None and self.plan.controller is None:
            with time_limit(self.limit), suppress_warnings():
                return decimate(self.plan.fly())
        outcome = fly_and_measure(self._plan_with_controller, self.limit, keep=True, timed=False)
        assert outcome.log is not None
        return outcome.log

    def _plan_with_controller(self) -> FlightPlan:
        if self.own is None:
            return self.plan
        return replace(self.plan, controller=self.own.make(self.plan.model.name))


class RowSpec(Protocol):
    """Specification of a row of a sweep."""

    @property
    def row(self) -> int:
        """Row number."""

    def fingerprint(self) -> str:
        """Return a digest of all inputs; "" if an input has no digest."""

    def measure(self) -> Measures:
        """Return the metrics; raise `QuadcoreError` if the row fails."""


class Row(NamedTuple):
    """Outcome of a row."""

    row: int
    failure: str
    """Reason why there are no metrics; "" for success. `REFUSED` precedes errors of the input."""
    measures: Optional[Measures]
    fingerprint: str


class FlownRow(NamedTuple):
    """Row with a user-defined controller; a process without user code computes its metrics."""

    spec: Flight
    flight: FlightRecord
    fingerprint: str


def fly_row(spec: RowSpec) -> Row:
    """Run a row and return its outcome."""
    return _contain(spec.row, spec.fingerprint(), lambda: spec.measure())


def fly_user_code(spec: RowSpec) -> Union[FlownRow, Row]:
    """Run a row in the process of a user-defined controller, but do not measure it there."""
    if not isinstance(spec, Flight):
        return fly_row(spec)
    flown = []
    failed = _contain(spec.row, spec.fingerprint(), lambda: flown.append(spec.fly()))
    return FlownRow(spec, flown[0], failed.fingerprint) if flown else failed


def measure_row(found: Union[FlownRow, Row]) -> Row:
    """Compute the metrics of a row, unless they are already known."""
    if isinstance(found, Row):
        return found
    spec, flight, fingerprint = found
    measure = partial(get_measures, flight, spec.criteria, spec.limit)
    return _contain(spec.row, fingerprint, measure)


def get_measures(flight: FlightRecord, criteria: Criteria, limit: float) -> Measures:
    """Return the metrics of a flight within a time limit; raise `FlightError` if it failed."""
    with time_limit(limit):
        outcome = measure_record(flight, criteria)
    if outcome.failure:
        raise FlightError(outcome.failure)
    return outcome.measures


def _contain(row: int, fingerprint: str, measure: Callable[[], Optional[Measures]]) -> Row:
    """Call a function that returns metrics; any error only fails this row."""
    try:
        return Row(row, "", measure(), fingerprint)
    except QuadcoreError as error:
        failure = describe_failure(error)
    except MemoryError:
        failure = "no memory left"
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # includes SystemExit: user code must not end the sweep
        failure = describe_error(error)
    return Row(row, " ".join(failure.split()), None, fingerprint)


def describe_failure(error: QuadcoreError) -> str:
    """Describe why a row has no metrics."""
    return f"{REFUSED if isinstance(error, InputError) else ''}{error}"


def compute_digest(data: bytes) -> str:
    """Return the SHA-256 digest in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def read_source(module: str) -> bytes:
    """Return the source of a module or file without importing it; empty if it is not found."""
    if controllers.names_plugin(module):
        return find_library(module).read_bytes()
    loaded = sys.modules.get(module)
    origin = module if module.endswith(".py") else getattr(loaded, "__file__", None)
    if origin is None:
        sys.path.insert(0, "")
        try:
            found = importlib.util.find_spec(module) if module else None
        except (ImportError, ValueError):
            found = None
        finally:
            sys.path.remove("")
        origin = getattr(found, "origin", None)
    try:
        return Path(origin).read_bytes() if origin else b""
    except OSError:
        return b""
