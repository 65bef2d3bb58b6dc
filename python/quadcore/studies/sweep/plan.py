"""The rows of a sweep: what each of them flies, checked before the first takes off."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Sequence, Tuple, Union

from ..._core import InputError
from ...control import references
from ...control.built_in import BuiltInController
from ...simulation.commands import CommandsLike
from ...support.values import whole
from .. import tracking_metrics as of_guided
from ..cases import Cases, check_models, make_scenario_axis
from ..control_setup import ControlSetup, add_labels, names_user_code
from ..design import LARGEST, Design
from ..options import SweepOptions
from ..variation import pick_controller_values
from . import motion_metrics
from .batches import ENGINE
from .calls import Calls as Calls
from .row_spec import Flight, UserController

_TOGETHER = 32  # rows: four times as many as share an instruction, and few to lose


class Plan(Cases):
    """Controllers x references x engines x models x points x seeds, checked.

    Or commands, in the place of controllers and references.

    Parameters
    ----------
    design
        The points.
    controllers, references_
        As `evaluate` takes them; None with `commands`.
    engines, models, options, commands
        As for `sweep`.

    Raises
    ------
    InputError
        Anything that is known to be wrong before it flies, but for a controller of the user's own,
        whose flights fail.
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
        measured = of_guided if control.is_closed_loop else motion_metrics
        self.units, self.meanings = measured.UNITS, measured.MEANINGS
        self.measures = list(measured.UNITS)
        self.names = list(self.list_cells(0))
        """Of the first columns, which say what flies."""
        self._commands = str(commands) if isinstance(commands, (str, Path)) else None
        self.check(commands)

    whole = ("seed",)
    """Columns that hold whole numbers, besides ``row``."""

    @property
    def at_once(self) -> int:
        """Rows of a task at most: several where they can fly on one batch."""
        return 1 if self.control.is_closed_loop or self.engines != [ENGINE] else _TOGETHER

    @property
    def apart(self) -> bool:
        """Whether each flight needs a process of its own."""
        return self.control.runs_user_code

    def list_cells(self, row: int) -> Dict[str, Any]:
        """Give what a row flies, as the first columns of the table."""
        case = self[row]
        return {**self.name_sides(case), **self.design[case.point], "seed": self.seeds[case.seed]}

    def make_spec(self, row: int) -> Flight:
        """Describe a row; raises what making it raises."""
        case, own = self[row], None
        plan = self.make_plan_without_controller(case)
        if self.control.is_closed_loop:
            thing = self.control.things[case.controller]
            if names_user_code(thing):
                values = {**self.control.timing, **pick_controller_values(self.design[case.point])}
                own = UserController.of(thing, values)
            else:
                plan = replace(plan, controller=self.make_controller(case))
        return Flight(row, self.list_cells(row), plan, own, self.options.time_limit)

    def describe(self) -> Dict[str, Any]:
        """Give what flies and how, in plain values."""
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
"""Says what the rows of a sweep are."""


def make_design(
    vary: Mapping[str, Any],
    options: SweepOptions,
    points: Union[str, Path, None],
    design: str,
    samples: Optional[int],
) -> Tuple[Design, SweepOptions]:
    """Make the points of a sweep, of the scenarios in its options too; arguments as for `sweep`."""
    vary, options = make_scenario_axis(vary, options)
    return Design(vary, points, design, samples, whole(options.seed)), options


def _make_control_setup(
    controllers: Any, references_: Any, commands: Any, options: SweepOptions
) -> ControlSetup:
    if commands is None:
        for name, given in (("controller", controllers), ("reference", references_)):
            if given is None:
                raise InputError(f"nothing to fly: name --{name}, or --commands")
        return ControlSetup(
            add_labels("controller", controllers, BuiltInController),
            add_labels("reference", references_, references.Shape),
            options.controller_rate,
            options.delay,
            on_reference=options.spawn is None,
        )
    if controllers is not None or references_ is not None:
        raise InputError("a flight takes --commands or a --controller; give one of them")
    timing = options.controller_rate, options.delay
    return ControlSetup.single(None, None, None, *timing)
