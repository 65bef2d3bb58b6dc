"""Tuning problem: gains, training cases and held-out cases."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from functools import partial
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from ... import _core
from ..._core import FlightError, InputError
from ...control import references
from ...control.built_in import BuiltInController
from ...control.gains import Gains
from ...report.decimation import decimate
from ...simulation.flight_plan import FlightPlan
from ...simulation.log import Log
from ...support.arguments import shorten
from ..axes import Values
from ..cases import Case, Cases, check_models, label_point, make_scenario_axis
from ..control_setup import ControlSetup, add_labels, names_user_code
from ..design import Design
from ..executor import count_cores
from ..grouped_flights import fly_group, share_out
from ..options import ControlOptions
from ..variation import pick_controller_values
from .own_parameters import read_own
from .trials import RETURN_TIME, Flown, Trial, TrialResult, judge

_GAIN = re.compile(r"(k[pidrw]|[qr])_\w+")

_UNLISTED = ("duration", "dt", "seed", "scenario", "processes", "progress")
"""Options that the history omits or lists elsewhere."""


class Problem:
    """Controller, start gains, training cases and held-out cases.

    Parameters
    ----------
    controller, models, references_, held_out, held_out_models, only, engine, vary, options
        As for `tune`.

    Raises
    ------
    InputError
        If an argument is invalid. In this case no flight runs.
    """

    def __init__(
        self,
        controller: Union[str, BuiltInController],
        models: Sequence[Union[str, Path]],
        references_: Sequence[Any],
        held_out: Sequence[Any],
        held_out_models: Sequence[Union[str, Path]],
        only: Optional[Sequence[str]],
        engine: str,
        vary: Mapping[str, Values],
        options: ControlOptions,
    ) -> None:
        if not models or not references_ or not held_out:
            raise InputError(
                "tuning requires a model, a reference and a held-out reference. Give each of them."
            )
        if not isinstance(controller, (str, BuiltInController)):
            raise InputError(
                f"the controller is {shorten(controller)}. Give its name, or one of "
                "quadcore.controllers."
            )
        self.runs_user_code = names_user_code(controller)
        trained, judged = (
            add_labels("reference", some, references.Shape) for some in (references_, held_out)
        )
        for label, _ in judged:
            if label in dict(trained):
                raise InputError(
                    f"reference '{label}' is both a training and a held-out reference. Remove one."
                )
        if options.log_every is not None:
            raise InputError("tuning writes no log. Remove log_every.")
        self.options = options
        vary, options = make_scenario_axis(vary, options)
        design = Design(vary)
        everything = [*models, *held_out_models]
        check_models(everything, design)
        timing = options.controller_rate, options.delay
        control = ControlSetup(
            [("", controller)],
            [*trained, *judged],
            *timing,
            options.spawn is None,
            options.privileged,
        )
        self._cases = Cases(design, control, everything, [engine], options)
        self._cases.check()
        self.models = self._cases.models[: len(models)]
        self.vehicle = self._cases.vehicles[0]
        self._own: Optional[Gains] = None
        if self.runs_user_code:
            first = self._cases.make_plan_without_controller(Case())
            self._own = read_own(str(controller), first, options.time_limit)
        self.training: List[Trial] = []
        self.held_out: List[Trial] = []
        for case in sorted(self._cases, key=lambda case: (case.model, case[1:])):
            is_trained = case.model < len(models) and case.reference < len(trained)
            (self.training if is_trained else self.held_out).append(self._make_trial(case))
        self.training += [
            trial._replace(label=f"{trial.label}, from an offset", has_offset=True)
            for trial in self.training
            if trial.plan.on_reference
        ]
        self.return_trials = [trial for trial in self.held_out if trial.plan.on_reference]
        self.start = self._start_gains(only)

    def describe_controller(self, gains: Mapping[str, float]) -> Gains:
        """Describe the controller with these gains in the form of a gains file."""
        if self._own is not None:
            given: Dict[str, Any] = {
                name: x for name, x in self._cases.control.timing.items() if x is not None
            }
            kept = {**self._own.parameters, **gains}
            return replace(self._own, vehicle=self.vehicle, parameters=kept, **given)
        controller = self._make_controller(gains)
        return Gains(
            controller.name, self.vehicle, controller.rate, controller.delay, controller.parameters
        )

    def _make_controller(self, gains: Mapping[str, float]) -> Any:
        return self._cases.control.make(0, self.vehicle, gains)

    def fly(self, trial: Trial, gains: Mapping[str, float]) -> TrialResult:
        """Simulate and judge a trial; the errors are those of `simulate`."""
        return judge(trial, self.simulate(trial, gains), self.options.failure_distance)

    def simulate(self, trial: Trial, gains: Mapping[str, float]) -> Flown:
        """Simulate a trial; raise `InputError` if the controller rejects gains or vehicle."""
        try:
            return Flown(self.make_plan(trial, gains).fly(), "")
        except FlightError as error:
            if not hasattr(error, "log"):
                raise
            return Flown(error.log, str(error))

    def simulate_return(self, trial: Trial, gains: Mapping[str, float]) -> List[Flown]:
        """Simulate a trial from the reference, then from an offset, until the first failure."""
        longer = trial._replace(plan=replace(trial.plan, duration=RETURN_TIME))
        flown: List[Flown] = []
        for has_offset in (False, True):
            flown.append(self.simulate(longer._replace(has_offset=has_offset), gains))
            if flown[-1].failure:
                break
        return flown

    def fly_together(
        self, flights: Sequence[Tuple[Trial, Mapping[str, float]]], limit: float
    ) -> Optional[List[TrialResult]]:
        """Simulate and judge trials on one batch, bit-identical to separate flights.

        Parameters
        ----------
        flights
            Trials with their gains. Either all or none of them have an offset.
        limit
            Wall-clock limit of each flight, s.

        Returns
        -------
        list of TrialResult, or None
            Results; None if the flights cannot share a batch.
        """
        records = fly_group([partial(self.make_plan, *flight) for flight in flights], limit)
        if records is None:
            return None
        return [
            judge(trial, Flown(record.log, record.failure), self.options.failure_distance)
            for record, (trial, _) in zip(records, flights)
        ]

    def group(self, flights: Sequence[Tuple[Trial, Mapping[str, float]]]) -> List[Sequence[int]]:
        """Group the indices of flights that can share a batch."""
        if self.runs_user_code:
            return [[i] for i in range(len(flights))]
        # An offset changes the initial state once more, so these flights need another batch.
        kinds = [
            [i for i, (trial, _) in enumerate(flights) if trial.has_offset == has_offset]
            for has_offset in (False, True)
        ]
        processes = self.options.processes or count_cores()
        return [group for rows in kinds for group in share_out(rows, processes)]

    def make_plan(self, trial: Trial, gains: Mapping[str, float]) -> FlightPlan:
        """Make the plan of a trial; raise `InputError` if the controller rejects the gains."""
        return trial.make_plan(self._make_controller({**gains, **trial.values}))

    def watch(self, trial: Trial, gains: Mapping[str, float]) -> Log:
        """Simulate a trial, and return its decimated log; raise `QuadcoreError` if it fails."""
        return decimate(self.make_plan(trial, gains).fly())

    def list_settings(self) -> Dict[str, Any]:
        """Return the settings of the flights as plain values."""
        plan = self.training[0].plan
        values = {each.name: getattr(self.options, each.name) for each in fields(ControlOptions)}
        axes = {axis.name: list(axis.values) for axis in self._cases.design.listed}
        defaults = vars(ControlOptions())
        return {
            "engine": plan.engine,
            "duration": plan.duration,
            "dt": plan.step,
            **{
                name: _make_plain(value)
                for name, value in values.items()
                if value and value != defaults[name] and name not in _UNLISTED
            },
            **({"privileged": True} if self._cases.control.is_privileged(0) else {}),
            **({"vary": axes} if axes else {}),
        }

    def _make_trial(self, case: Case) -> Trial:
        cases, parts = self._cases, [self._cases.control.references[case.reference]]
        if len(cases.models) > 1:
            parts.append(cases.models[case.model])
        if len(cases.design) > 1:
            parts.append(label_point(cases.design[case.point]))
        if len(cases.seeds) > 1:
            parts.append(f"seed {cases.seeds[case.seed]}")
        values = pick_controller_values(cases.design[case.point])
        return Trial(", ".join(parts), cases.make_plan_without_controller(case), values)

    def _start_gains(self, only: Optional[Sequence[str]]) -> Dict[str, float]:
        start = self.describe_controller({})
        controller, numbers = start.law, dict(start.parameters)
        if self._own is None:
            table = next(specs for name, _, specs in _core.controllers() if name == controller)
            numbers = {
                spec.name: float(start.parameters.get(spec.name, spec.default))
                for spec in table
                if not spec.is_flag
            }
        elif only is None:
            raise InputError(
                f"controller '{controller}' is your own. Name its parameters with --free."
            )
        names = [name for name in numbers if _GAIN.fullmatch(name)] if only is None else only
        for name in names:
            if name not in numbers:
                raise InputError(
                    f"controller '{controller}' has no parameter '{name}'. Use some of "
                    f"{', '.join(numbers)}."
                )
            if only is not None and not numbers[name] > 0:
                raise InputError(f"{name} is {numbers[name]:g}. Start with more than 0.")
        positive = {name: numbers[name] for name in names if numbers[name] > 0}
        if not positive:
            raise InputError(
                f"controller '{controller}' has no gain above 0. Set some at the start."
            )
        return positive


def _make_plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _make_plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_make_plain(one) for one in value]
    return value if isinstance(value, (bool, int, float)) else str(value)
