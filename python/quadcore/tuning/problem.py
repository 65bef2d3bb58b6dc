"""What is tuned: a law's gains, the flights that they are tuned on, and those that judge them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .. import _core, laws, references
from .._core import FlightError, InputError
from ..evaluation.measures import LOST, distance, lost
from ..files import shown
from ..flight_plan import FlightPlan

_GAIN = re.compile(r"(k[pidrw]|[qr])_\w+")
_LOG_RATE = 100.0  # 1/s


class Case(NamedTuple):
    """One flight that gains are tried in."""

    label: str
    """Reference and, if there are several, model."""
    plan: FlightPlan
    """Without a controller."""


class Flown(NamedTuple):
    """How gains did in a case."""

    error: float
    """Root of the mean square of the distance to the reference, m; what is lost counts as LOST away
    from then on, so that later is better."""
    failure: str
    """When it was lost or diverged; "" if it flew."""


class Problem:
    """A law, where its gains begin, and the cases.

    Parameters
    ----------
    law
        As `laws.parse` takes it, or a `laws.Law`.
    models, held_out_models
        Of the second, and of `held_out`, only the judgement is told.
    references_, held_out
        As `references.parse` takes them, or functions.
    only
        Parameters to tune; None: the gains that are not zero.
    spawn
        Where flights begin; None is on the reference.
    options
        As for `FlightPlan.of`.

    Raises
    ------
    InputError
        Something is at fault; nothing was flown.
    """

    def __init__(
        self,
        law: Union[str, laws.Law],
        models: Sequence[Union[str, Path]],
        held_out_models: Sequence[Union[str, Path]],
        references_: Sequence[Any],
        held_out: Sequence[Any],
        only: Optional[Sequence[str]],
        spawn: Optional[Sequence[float]],
        options: Mapping[str, Any],
    ) -> None:
        if not models or not references_ or not held_out:
            raise InputError("tuning needs a model, a reference, and a reference that is held out")
        where = {"on_reference": True} if spawn is None else {"spawn": spawn}
        self._plans = {
            shown(model): FlightPlan.of(model, **options, **where, wrenches=False)
            for model in [*models, *held_out_models]
        }
        self.vehicle = next(iter(self._plans.values())).model.name
        self.law = laws.parse(law, self.vehicle) if isinstance(law, str) else law
        if not isinstance(self.law, laws.Law):
            raise InputError(f"{law}: no law of quadcore: only their gains can be tuned")
        trained = _named(references_)
        judged = _named(held_out)
        for label in judged:
            if label in trained:
                raise InputError(f"reference '{label}' is tuned on and held out; choose one")
        own, others = ([shown(model) for model in some] for some in (models, held_out_models))
        self.training = self._cases(own, trained)
        self.held_out = self._cases(own, judged) + self._cases(others, {**trained, **judged})
        self.start = self._start(only)

    def with_gains(self, gains: Mapping[str, float]) -> laws.Law:
        """Make the law with some gains."""
        law = self.law
        parameters = {**law.parameters, **gains}
        return laws.Law(law.name, law.rate, law.delay, law.spins, law.belief, **parameters)

    def fly(self, case: Case, gains: Mapping[str, float]) -> Flown:
        """Fly a case and measure it; raises `InputError` if the law refuses gains or vehicle."""
        plan = replace(case.plan, controller=self.with_gains(gains))
        failure = ""
        try:
            log = plan.fly()
        except FlightError as error:
            log, failure = error.log, str(error)  # type: ignore[attr-defined]
        away = np.minimum(np.nan_to_num(distance(log), nan=LOST), LOST)
        late = lost(log)
        if late is not None:
            failure = f"lost at t = {late:.6g} s"
            away[log.time >= late] = LOST
        # What a flight that failed has not flown, it was lost in.
        rest = max(0.0, 1 - (log.time[-1] - log.time[0]) / plan.duration) if failure else 0.0
        square = (1 - rest) * np.mean(away**2) + rest * LOST**2
        return Flown(float(np.sqrt(square)), failure)

    def _cases(self, models: Sequence[str], shapes: Mapping[str, Any]) -> List[Case]:
        several = len(self._plans) > 1
        cases = []
        for model in models:
            plan = self._plans[model]
            dt = plan.world.max_step_size if plan.dt is None else plan.dt
            every = max(1, round(1 / (_LOG_RATE * dt)))
            for label, shape in shapes.items():
                name = f"{label}, {model}" if several else label
                cases.append(Case(name, replace(plan, reference=shape, log_every=every)))
        return cases

    def _start(self, only: Optional[Sequence[str]]) -> Dict[str, float]:
        table = next(specs for name, _, specs in _core.laws() if name == self.law.name)
        numbers = {
            spec.name: float(self.law.parameters.get(spec.name, spec.default))
            for spec in table
            if not spec.is_flag
        }
        names = [name for name in numbers if _GAIN.fullmatch(name)] if only is None else only
        for name in names:
            if name not in numbers:
                raise InputError(
                    f"law '{self.law.name}' has no number '{name}'; tune some of "
                    f"{', '.join(numbers)}"
                )
            if only is not None and not numbers[name] > 0:
                raise InputError(f"{name} is {numbers[name]:g}; begin with more than 0")
        start = {name: numbers[name] for name in names if numbers[name] > 0}
        if not start:
            raise InputError(f"law '{self.law.name}' has no gain above 0 to begin with")
        return start


def _named(shapes: Sequence[Any]) -> Dict[str, Any]:
    """Make references of what names them, by label."""
    named: Dict[str, Any] = {}
    for shape in shapes:
        label, made = _one(shape)
        if label in named:
            raise InputError(f"reference '{label}' is named twice; keep one")
        named[label] = made
    return named


def _one(shape: Any) -> Tuple[str, Any]:
    if isinstance(shape, str):
        return shape, references.parse(shape)
    return getattr(shape, "__name__", repr(shape)), shape
