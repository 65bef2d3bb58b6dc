"""Rows of a sweep, checked before the first row starts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Sequence, Tuple, Union

from ..._core import InputError
from ...control import references
from ...control.built_in import BuiltInController
from ...simulation.commands import CommandsLike
from ...support.values import check_whole
from ..cases import Cases, check_models, make_scenario_axis
from ..control_setup import ControlSetup, add_labels, names_user_code
from ..criteria import DEFAULT
from ..design import LARGEST, Design
from ..grouped_flights import ENGINES, MOST
from ..options import SweepOptions
from ..variation import pick_controller_values
from . import motion_metrics
from .batches import ENGINE
from .calls import Calls as Calls
from .row_spec import Flight, UserController

_TOGETHER = 32  # rows per batch: four times the number of lanes


class Plan(Cases):
    """Checked combinations of controllers, references, engines, models, points and seeds.

    Commands can replace controllers and references.

    Parameters
    ----------
    design
        Points of the sweep.
    controllers, references_
        As for `evaluate`; None with `commands`.
    engines, models, options, commands
        As for `sweep`.

    Raises
    ------
    InputError
        If an input is invalid. An error of a user-defined controller only fails its flights.
    """

    def __init__(
        self,
        design: Design,
        controllers: Any,
        references_: Any,
        engines: Sequence[str],
        models: Sequence[Union[str, Path]],
        options: SweepOptions,
        commands: Optional[CommandsLike] = None,
    ) -> None:
        control = _make_control_setup(controllers, references_, commands, options)
        check_models(models, design)
        super().__init__(design, control, models, engines, options, largest=LARGEST)
        self._criteria = options.make_criteria()
        self.units, self.meanings = self._criteria.units, self._criteria.meanings
        if not control.is_closed_loop:
            if self._criteria != DEFAULT:
                raise InputError(
                    "failure-distance, constraint and metric require a controller. "
                    "Add --controller."
                )
            self.units, self.meanings = motion_metrics.UNITS, motion_metrics.MEANINGS
        self.measures = list(self.units)
        self.names = list(self.list_cells(0))
        """Names of the first columns, which contain the conditions."""
        self._commands = str(commands) if isinstance(commands, (str, Path)) else None
        self.check(commands)

    whole = ("seed",)
    """Integer columns, in addition to ``row``."""

    @property
    def at_once(self) -> int:
        """Maximum number of rows per task; more than one if rows can share a batch."""
        if not self.control.is_closed_loop:
            return _TOGETHER if self.engines == [ENGINE] else 1
        is_grouped = set(self.engines) <= set(ENGINES) and not self.control.runs_user_code
        return MOST if is_grouped else 1

    @property
    def apart(self) -> bool:
        """Whether each flight requires a separate process."""
        return self.control.runs_user_code

    def list_cells(self, row: int) -> Dict[str, Any]:
        """Return the conditions of a row, which are the first columns of the table."""
        case = self[row]
        return {**self.name_sides(case), **self.design[case.point], "seed": self.seeds[case.seed]}

    def make_spec(self, row: int) -> Flight:
        """Return the specification of a row; errors propagate."""
        case, own = self[row], None
        plan = self.make_plan_without_controller(case)
        if self.control.is_closed_loop:
            thing = self.control.things[case.controller]
            if names_user_code(thing):
                values = {**self.control.timing, **pick_controller_values(self.design[case.point])}
                own = UserController.of(thing, values, bool(self.control.privileged))
            else:
                plan = replace(plan, controller=self.make_controller(case))
        cells, limit = self.list_cells(row), self.options.time_limit
        return Flight(row, cells, plan, own, limit, self._criteria)

    def describe(self) -> Dict[str, Any]:
        """Return all settings as plain values."""
        return {
            "controllers": self.control.controllers,
            "references": self.control.references,
            "commands": self._commands,
            "engines": self.engines,
            "models": self.models,
            **self.design.describe(),
            **self.list_settings(),
        }


AnyPlan = Union[Plan, Calls]
"""Plan of a sweep."""


def make_design(
    vary: Mapping[str, Any],
    options: SweepOptions,
    points: Union[str, Path, None],
    design: str,
    samples: Optional[int],
) -> Tuple[Design, SweepOptions]:
    """Make the points of a sweep, including the scenarios; the arguments are those of `sweep`."""
    vary, options = make_scenario_axis(vary, options)
    return Design(vary, points, design, samples, check_whole(options.seed)), options


def _make_control_setup(
    controllers: Any, references_: Any, commands: Any, options: SweepOptions
) -> ControlSetup:
    if commands is None:
        for name, given in (("controller", controllers), ("reference", references_)):
            if given is None:
                raise InputError(f"no {name} is given. Add --{name} or --commands.")
        return ControlSetup(
            add_labels("controller", controllers, BuiltInController),
            add_labels("reference", references_, references.Shape),
            options.controller_rate,
            options.delay,
            on_reference=options.spawn is None,
            privileged=options.privileged,
        )
    if controllers is not None or references_ is not None:
        raise InputError("both --commands and --controller are given. Give one of them.")
    timing = options.controller_rate, options.delay
    return ControlSetup.single(None, None, None, *timing)
