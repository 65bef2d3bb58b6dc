"""What is tuned: a law's gains, the flights that they are tuned on, and those that judge them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ... import _core
from ..._core import FlightError, InputError
from ...control import laws, references
from ...simulation.flight import check_logged
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support import rotation
from ...support.files import shown
from ..evaluate.measures import LOST, distance, loss, lost

_GAIN = re.compile(r"(k[pidrw]|[qr])_\w+")
_LOG_RATE = 100.0  # 1/s

BESIDE, ASKEW = (0.3, -0.2, 0.25), (0.1, -0.1, 0.2)
"""Where flights begin that tell whether gains hold a vehicle at all, from the reference's start:
how far off in the world (m), and turned how far about an axis of the frame (rad)."""
_BACK = 10.0  # s, in which it is to be back
_TOLD = ("engine", "duration", "dt", "seed")  # by themselves
_LATE = 2.0  # s, the last of them
_LEFT = 0.5  # of the distance at the start, at most, by then: z of `pd` has a pole at -0.22 1/s


class Case(NamedTuple):
    """One flight that gains are tried in."""

    label: str
    """Reference and, if there are several, model."""
    plan: FlightPlan
    """Without a controller."""
    beside: bool = False
    """Whether it begins `BESIDE` the reference."""


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
            shown(model): FlightPlan.of(model, **options, **where)
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
        self.models = [shown(model) for model in models]
        own, others = ([shown(model) for model in some] for some in (models, held_out_models))
        on_the_way = self._cases(own, trained)
        self.training = on_the_way + [
            Case(f"{label}, from beside it", plan, True)
            for label, plan, _ in on_the_way
            if plan.on_reference
        ]
        self.held_out = self._cases(own, judged) + self._cases(others, {**trained, **judged})
        told = {name: value for name, value in options.items() if name not in _TOLD}
        self._options = {**told, "spawn": spawn}
        self.to_come_back_to = [case for case in self.held_out if case.plan.on_reference]
        self.start = self._start(only)

    def with_gains(self, gains: Mapping[str, float]) -> laws.Law:
        """Make the law with some gains."""
        law = self.law.copy()
        law.parameters.update(gains)
        return law

    def fly(self, case: Case, gains: Mapping[str, float]) -> Flown:
        """Fly a case and measure it; raises `InputError` if the law refuses gains or vehicle."""
        failure = ""
        try:
            log = self._log(case, gains)
        except FlightError as error:
            log, failure = error.log, str(error)  # type: ignore[attr-defined]
        away = np.minimum(np.nan_to_num(distance(log), nan=LOST), LOST)
        late = lost(log)
        if late is not None:
            failure = loss(log)
            away[log.time >= late] = LOST
        # What a flight that failed has not flown, it was lost in.
        rest = max(0.0, 1 - (log.time[-1] - log.time[0]) / case.plan.duration) if failure else 0.0
        square = (1 - rest) * np.mean(away**2) + rest * LOST**2
        return Flown(float(np.sqrt(square)), failure)

    def comes_back(self, case: Case, gains: Mapping[str, float]) -> str:
        """Fly a case from its start and from beside it; "" if both are one flight in the end.

        On the reference a law that knows all hardly needs its gains, and whatever error is left
        there is no fault of theirs: what they are for is that a vehicle beside it comes back.
        """
        longer = case._replace(plan=replace(case.plan, duration=_BACK))
        try:
            logs = [self._log(longer._replace(beside=beside), gains) for beside in (False, True)]
        except FlightError as error:
            return str(error)
        apart = np.linalg.norm(logs[0].position - logs[1].position, axis=1)
        left = float(apart[logs[0].time > logs[0].time[-1] - _LATE].max())
        if left <= _LEFT * apart[0]:
            return ""
        return f"after {_BACK:g} s it is {left:.3g} m from where it should be, of {apart[0]:.3g} m"

    def _log(self, case: Case, gains: Mapping[str, float]) -> Log:
        plan = replace(case.plan, controller=self.with_gains(gains))
        simulation = plan.simulation()
        if case.beside:
            state = simulation.state.copy()
            state.position = state.position + BESIDE
            state.orientation = rotation.turned(state.orientation, np.array(ASKEW))
            simulation.set_state(state)
        return simulation.run(
            plan.duration,
            log_every=plan.log_every,
            controller=plan.controller,
            reference=plan.reference,
        )

    def setting(self) -> Dict[str, Any]:
        """Say how everything flies, in plain values."""
        plan = self.training[0].plan
        given = {name: value for name, value in self._options.items() if value}
        return {
            "engine": plan.engine,
            "duration": plan.duration,
            "dt": plan.step,
            **{name: _plain(value) for name, value in given.items()},
        }

    def _cases(self, models: Sequence[str], shapes: Mapping[str, Any]) -> List[Case]:
        several = len(self._plans) > 1
        cases = []
        for model in models:
            plan = self._plans[model]
            every = max(1, round(1 / (_LOG_RATE * plan.step)))
            check_logged(plan.duration, plan.step, every)
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


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(one) for one in value]
    return value if isinstance(value, (bool, int, float)) else str(value)


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
