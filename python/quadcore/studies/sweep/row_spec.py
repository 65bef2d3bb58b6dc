"""Description of a row of a sweep, which can be pickled and run anywhere."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Mapping, NamedTuple, Optional, Protocol, Tuple

from ..._core import FlightError, InputError, QuadcoreError
from ...control import controllers
from ...report.decimation import decimate
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support.user_code import describe_error, split_name
from ...support.warning import suppress_warnings
from ..measured_flight import fly_and_measure
from ..time_limit import time_limit
from . import motion_metrics

Measures = Mapping[str, float]

REFUSED = "refused: "
"""Prefix of the failure of a row with invalid input, which did not run."""


@dataclass(frozen=True)
class UserController:
    """User-defined controller, made in the process of the flight."""

    text: str
    """``MODULE:CLASS``."""
    values: Tuple[Tuple[str, float], ...]
    """Values to set: rate, delay, parameters."""
    source: str
    """Digest of the text of its module, without imported modules."""

    @classmethod
    def of(cls, text: str, values: Mapping[str, Any]) -> UserController:
        """Find the module without importing it."""
        given = tuple((name, value) for name, value in values.items() if value is not None)
        return cls(text, given, compute_digest(read_source(split_name(text).place)))

    def make(self, vehicle: str) -> Any:
        """Import and make the controller; raises `InputError`."""
        return controllers.parse(self.text, vehicle, dict(self.values))


@dataclass(frozen=True)
class Flight:
    """A row that is a flight."""

    row: int
    names: Mapping[str, Any]
    """First columns of the table."""
    plan: FlightPlan
    """Plan; without a controller if `own` is given."""
    own: Optional[UserController]
    limit: float
    """Wall-clock limit, s."""

    def fingerprint(self) -> str:
        """Return a digest of all inputs; "" if they cannot be digested."""
        try:
            known = self.plan.fingerprint()
        except InputError:  # a user-defined controller or reference object
            return ""
        return known if self.own is None else compute_digest(f"{known} {self.own}".encode())

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
        outcome = fly_and_measure(self._plan_with_controller, self.limit, timed=False)
        if outcome.failure:
            raise FlightError(outcome.failure)
        return outcome.measures

    def watch(self) -> Log:
        """Simulate the flight again and return a decimated log, also of a failed flight.

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
    """A row of a sweep."""

    @property
    def row(self) -> int:
        """Row number."""

    def fingerprint(self) -> str:
        """Return a digest of all inputs; "" if they cannot be digested."""

    def measure(self) -> Measures:
        """Return the metrics; raises `QuadcoreError`."""


class Row(NamedTuple):
    """Outcome of a row."""

    row: int
    failure: str
    """Reason for missing metrics, with the prefix `REFUSED` for invalid input; "" for success."""
    measures: Optional[Measures]
    fingerprint: str


def fly_row(spec: RowSpec) -> Row:
    """Run a row and return its outcome."""
    fingerprint = spec.fingerprint()
    try:
        return Row(spec.row, "", spec.measure(), fingerprint)
    except QuadcoreError as error:
        failure = describe_failure(error)
    except MemoryError:
        failure = "no memory left"
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # SystemExit too: user code must not end the sweep
        failure = describe_error(error)
    return Row(spec.row, " ".join(failure.split()), None, fingerprint)


def describe_failure(error: QuadcoreError) -> str:
    """Describe why a row has no metrics."""
    return f"{REFUSED if isinstance(error, InputError) else ''}{error}"


def compute_digest(data: bytes) -> str:
    """Return the hexadecimal SHA-256."""
    return hashlib.sha256(data).hexdigest()


def read_source(module: str) -> bytes:
    """Return the text of a module or file without importing it; empty if it cannot be found."""
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
