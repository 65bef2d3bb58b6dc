"""Flying all cases of a plan and measuring how each differs from the first."""

from __future__ import annotations

from typing import (
    TYPE_CHECKING,
    Any,
    List,
    Mapping,
    Optional,
    Union,
)

from ..._core import FlightError, InputError, QuadcoreError
from ...control.controller import ControllerLike
from ...control.keywords import ReferenceName
from ...control.references import ReferenceLike
from ...simulation.commands import CommandsLike
from ...simulation.engines import ENGINE, AnyEngineName
from ...simulation.log import Log
from ...support import arguments, interrupts
from ..axes import Values
from ..control_setup import ControlSetup
from ..executor import run_contained
from ..options import CompareOptions, Keywords, Names, accept_options
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
        "where to fly: a name, or a function that is called as reference(t); the row that the "
        "others are compared with is `against`",
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
    """Fly the same flight with several models or parameters, in parallel.

    Parameters
    ----------
    models
        One or several models: files or names of shipped ones.
    vary
        Values by ``"PLUGIN.TAG"``, ``"LINK.mass"`` or the like, or ``"xacro.ARG"`` (several, joined
        by commas, take the same value), ``"engine"``, ``"world"``, ``"scenario"`` or
        ``"controller.KEY"``. All combinations are flown; the last axis runs fastest.
    commands, engine, wrenches
        As for `Simulation` and `Simulation.run`.
    controller, reference
        As for `Simulation.run`: each flight is guided, and begins on the reference unless `spawn`
        is given. Without a reference it hovers at the spawn.
    against
        Row of the table that all others are compared with; None: the first that flies.
    logs
        Whether to keep them.
    **options

    Returns
    -------
    Comparison
        The same whatever the number of processes: flights of a controller or reference that is none
        of quadcore's have processes of their own, which begin as this one is when they begin.

    Raises
    ------
    InputError
        Nothing was flown: too many cases, logs that would take more than 2 GiB, an unreadable
        file, an unknown tag, models with different numbers of rotors under the same commands, or
        a law that can fly none of them. A case that fails by itself is a row of the table with
        its reason instead.
    FlightError
        The flight to compare the others with failed.
    KeyboardInterrupt
        With the attribute `comparison`, whose missing rows say so.
    """
    shared = CompareOptions(**options)
    timing = shared.controller_rate, shared.delay
    control = ControlSetup.single(controller, reference, shared.spawn, *timing)
    several = arguments.several(models)
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
    """Fly a plan.

    Parameters
    ----------
    plan
        What to fly.
    keep
        Called as keep(row, log) in the process that flew; what it returns stands in for the log.
    progress, against
        As for `compare`.
    """
    if against is not None and not 0 <= against < len(plan):
        raise InputError(f"against is {against}; give a row from 0 to {len(plan) - 1}")
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
    """Take rows until one flies, which all later ones are compared with.

    One that is wanted must.
    """
    outcomes: List[Union[Log, QuadcoreError]] = []
    while rows:
        row = rows.pop(0)
        # In a process too: what crashes there does not end the comparison.
        run_contained(plan.fly, [plan[row]], lambda _, outcome: outcomes.append(outcome), 1)
        log = outcomes.pop()
        if isinstance(log, Log):
            tally.set_baseline(row, log)
            with interrupts.hold_signals():
                tally.add_outcome(row, _keep(row, measure(plan, log, log), log, tally.keep))
            return log
        if wanted is not None:
            if isinstance(log, InputError):
                raise InputError(f"no. {row + 1}, to compare the others with, is refused: {log}")
            raise FlightError(f"no. {row + 1}, to compare the others with, failed: {log}")
        tally.add_outcome(row, log)
    return None


def _keep(row: int, found: Measured, log: Log, keep: Optional[Keep]) -> Outcome:
    return found, None if keep is None else keep(row, log)


def _check_memory(plan: Plan) -> None:
    """Refuse logs that could not be held: better now than when the machine swaps."""
    rows = plan.options.duration / plan.dt / plan.steps_per_row(plan.dt)
    size = len(plan) * rows * (14 + plan.rotor_count) * 8
    if size > _LARGEST_LOGS:
        raise InputError(
            f"the logs of {len(plan)} flights take {size / 2**30:.0f} GiB; give logs=False, or a "
            "larger log_every"
        )
