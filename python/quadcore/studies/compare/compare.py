"""Flights of a comparison and their differences from the baseline."""

from __future__ import annotations

from typing import (
    TYPE_CHECKING,
    Any,
    List,
    Mapping,
    Optional,
    Union,
)

from ... import _core
from ..._core import FlightError, InputError, QuadcoreError
from ...control.controller import ControllerLike
from ...control.keywords import ReferenceName
from ...control.references import ReferenceLike
from ...simulation.commands import CommandsLike
from ...simulation.engines import ENGINE, AnyEngineName
from ...simulation.log import Log
from ...support import arguments, interrupts
from ..accept_options import accept_options
from ..axes import Values
from ..control_setup import ControlSetup
from ..executor import run_contained
from ..options import CompareOptions, Keywords, Names
from .plan import Plan
from .result import Comparison, Keep, Measured, Outcome, Progress, Tally, measure

if TYPE_CHECKING:
    from typing_extensions import Unpack

_LARGEST_LOGS = 2 * 2**30  # bytes


@accept_options(
    CompareOptions,
    models=arguments.SOME,
    vary=arguments.or_none(arguments.AXES),
    engine=arguments.NAME,
    logs=arguments.FLAG,
    wrenches=arguments.FLAG,
    against=arguments.or_none(arguments.WHOLE),
    reference=(
        lambda value: value is None or isinstance(value, str) or callable(value),
        "a reference name, or a function that is called as reference(t); `against` is the baseline",
    ),
)
def compare(
    models: Names,
    vary: Optional[Mapping[str, Values]] = None,
    commands: Optional[CommandsLike] = None,
    *,
    controller: Optional[ControllerLike] = None,
    reference: Union[ReferenceLike, ReferenceName, None] = None,
    engine: AnyEngineName = ENGINE,
    against: Optional[int] = None,
    logs: bool = True,
    wrenches: bool = False,
    **options: Unpack[Keywords],
) -> Comparison:
    """Simulate the same flight with several models or parameters, in parallel.

    Parameters
    ----------
    models
        Files or names of built-in models; one or several.
    vary
        Values by ``"PLUGIN.TAG"``, a value of a link such as ``"LINK.mass"``, ``"xacro.ARG"``,
        ``"engine"``, ``"world"``, ``"scenario"`` or ``"controller.KEY"``. Tags joined by commas
        take the same value. All combinations are simulated; the last axis varies fastest.
    commands, engine, wrenches
        As for `Simulation` and `Simulation.run`.
    controller, reference
        As for `Simulation.run`. Flights start on the reference unless `spawn` is given. Without a
        reference, the vehicle hovers at the spawn position.
    against
        Row of the baseline. None: the first row that succeeds.
    logs
        Whether to keep the logs.
    **options

    Returns
    -------
    Comparison
        Results, which do not depend on the number of processes. Flights with user-defined
        controllers or references run in separate forked processes.

    Raises
    ------
    InputError
        If there are too many cases, the logs exceed 2 GiB, a file cannot be read, or a tag does not
        exist. Also if the models need different commands, or the controller supports none of them.
        In these cases no flight runs. If a single case is invalid, its row contains the failure
        instead.
    FlightError
        If the baseline given by `against` fails.
    KeyboardInterrupt
        On Ctrl-C. The attribute `comparison` contains the results so far and marks the missing
        rows.
    """
    shared = CompareOptions(**options)
    timing = shared.controller_rate, shared.delay
    control = ControlSetup.single(controller, reference, shared.spawn, *timing)
    several = arguments.to_list(models)
    plan = Plan(several, vary or {}, engine, control, shared, commands, wrenches)
    if logs:
        _check_memory(plan)
    return fly_plan(plan, (lambda _, log: log) if logs else None, shared.progress, against)


def fly_plan(
    plan: Plan,
    keep: Optional[Keep] = None,
    progress: Optional[Progress] = None,
    against: Optional[int] = None,
) -> Comparison:
    """Simulate all flights of a plan.

    Parameters
    ----------
    plan
        Flights to simulate.
    keep
        Function called as keep(row, log) in the process of the flight; its return value replaces
        the log.
    progress, against
        As for `compare`.
    """
    if against is not None and not 0 <= against < len(plan):
        raise InputError(f"against is {against}. Give a row from 0 to {len(plan) - 1}.")
    tally = Tally(plan, keep, progress)
    rows = list(range(len(plan)))
    if against is not None:
        rows.insert(0, rows.pop(against))
    try:
        compared_with = _fly_first(plan, rows, tally, against)
        if compared_with is not None:

            def flown(row: int) -> Any:
                log = plan.fly(plan[row])
                return row, measure(plan, compared_with, log), log

            run_contained(
                flown,
                rows,
                lambda i, outcome: tally.add_outcome(rows[i], outcome),
                plan.options.processes,
                lambda result: _keep(result[0], result[1], result[2], keep),
                apart=plan.control.runs_user_code,
            )
    except KeyboardInterrupt as stop:
        stop.comparison = tally.make_comparison()  # type: ignore[attr-defined]
        raise
    return tally.make_comparison()


def _fly_first(plan: Plan, rows: List[int], tally: Tally, wanted: Optional[int]) -> Optional[Log]:
    """Simulate rows until one succeeds, and make it the baseline; row `wanted` must succeed."""
    outcomes: List[Union[Log, QuadcoreError]] = []
    while rows:
        row = rows.pop(0)
        # In a child process, so that a crash of the flight does not end the comparison.
        run_contained(plan.fly, [plan[row]], lambda _, outcome: outcomes.append(outcome), 1)
        log = outcomes.pop()
        if isinstance(log, Log):
            tally.set_baseline(row, log)
            with interrupts.hold_signals():
                tally.add_outcome(row, _keep(row, measure(plan, log, log), log, tally.keep))
            return log
        if wanted is not None:
            if isinstance(log, InputError):
                raise InputError(f"baseline no. {row + 1} is invalid: {log}")
            raise FlightError(f"baseline no. {row + 1} failed: {log}")
        tally.add_outcome(row, log)
    return None


def _keep(row: int, found: Measured, log: Log, keep: Optional[Keep]) -> Outcome:
    return found, None if keep is None else keep(row, log)


def _check_memory(plan: Plan) -> None:
    """Raise `InputError` if the logs would need too much memory."""
    rows = plan.options.duration / plan.dt / plan.steps_per_row(plan.dt)
    size = len(plan) * rows * len(_core.log_columns(plan.rotor_count)) * 8
    if size > _LARGEST_LOGS:
        raise InputError(
            f"the logs of {len(plan)} flights need {size / 2**30:.0f} GiB. Give logs=False or a "
            "larger log_every."
        )
