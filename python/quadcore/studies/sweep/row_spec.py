"""One row of a sweep: a description that can be pickled, flown anywhere, and told from others."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Mapping, NamedTuple, Optional, Protocol, Tuple

from ..._core import FlightError, InputError, QuadcoreError
from ...control import controllers
from ...simulation.flight_plan import FlightPlan
from ...support.user_code import describe_error
from ...support.warning import suppress_warnings
from ..control_setup import set_parameters
from ..measured_flight import fly_and_measure
from ..time_limit import time_limit
from . import motion_metrics

Measures = Mapping[str, float]

REFUSED = "refused: "
"""Begins the failure of a row that is bad input: it never flew."""


@dataclass(frozen=True)
class UserController:
    """A controller of the user's own, made where it flies."""

    text: str
    """``MODULE:CLASS``."""
    values: Tuple[Tuple[str, float], ...]
    """What it is given: rate, delay."""
    source: str
    """Digest of its module's text; that of what it imports is not looked at."""

    @classmethod
    def of(cls, text: str, values: Mapping[str, Any]) -> UserController:
        """Look the module up, without running it."""
        given = tuple((name, value) for name, value in values.items() if value is not None)
        return cls(text, given, compute_digest(read_source(text.partition(":")[0])))

    def make(self, vehicle: str) -> Any:
        """Bring it in; raises `InputError`."""
        return set_parameters(controllers.parse(self.text, vehicle), dict(self.values))


@dataclass(frozen=True)
class Flight:
    """A row that is flown."""

    row: int
    names: Mapping[str, Any]
    """Its first columns."""
    plan: FlightPlan
    """Without its controller if that is `own`."""
    own: Optional[UserController]
    limit: float
    """Of the wall clock, s."""

    def fingerprint(self) -> str:
        """Digest of all that it depends on; "" if nobody can tell."""
        try:
            known = self.plan.fingerprint()
        except InputError:  # a controller or a reference that is an object of one's own
            return ""
        return known if self.own is None else compute_digest(f"{known} {self.own}".encode())

    def measure(self) -> Measures:
        """Fly and measure it.

        Raises
        ------
        QuadcoreError
            It failed.
        """
        if self.own is None and self.plan.controller is None:
            with time_limit(self.limit), suppress_warnings():
                return motion_metrics.measure(self.plan.fly())
        outcome = fly_and_measure(self._plan_with_controller, self.limit, timed=False)
        if outcome.failure:
            raise FlightError(outcome.failure)
        return outcome.measures

    def _plan_with_controller(self) -> FlightPlan:
        if self.own is None:
            return self.plan
        return replace(self.plan, controller=self.own.make(self.plan.model.name))


class RowSpec(Protocol):
    """One row, wherever it is flown."""

    @property
    def row(self) -> int:
        """Its number."""

    def fingerprint(self) -> str:
        """Digest of all that it depends on; "" if nobody can tell."""

    def measure(self) -> Measures:
        """Give what is measured; raises `QuadcoreError`."""


class Row(NamedTuple):
    """What became of a row."""

    row: int
    failure: str
    """Why there are no measures, after `REFUSED` if it never flew; "" if there are."""
    measures: Optional[Measures]
    fingerprint: str


def fly_row(spec: RowSpec) -> Row:
    """Fly a row, whatever becomes of it."""
    fingerprint = spec.fingerprint()
    try:
        return Row(spec.row, "", spec.measure(), fingerprint)
    except QuadcoreError as error:
        failure = describe_failure(error)
    except MemoryError:
        failure = "no memory left"
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # SystemExit, too: it is not for code that flies to end all
        failure = describe_error(error)
    return Row(spec.row, " ".join(failure.split()), None, fingerprint)


def describe_failure(error: QuadcoreError) -> str:
    """Tell why a row has no measures."""
    return f"{REFUSED if isinstance(error, InputError) else ''}{error}"


def compute_digest(data: bytes) -> str:
    """Hexadecimal SHA-256."""
    return hashlib.sha256(data).hexdigest()


def read_source(module: str) -> bytes:
    """Text of a module, which is not imported; empty if nobody can tell."""
    loaded = sys.modules.get(module)
    origin = getattr(loaded, "__file__", None)
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
