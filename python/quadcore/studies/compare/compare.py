"""Flying all variants of a plan and measuring how each differs from the first."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import Any, Callable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from ..._core import FlightError, InputError, QuadcoreError
from ...control.controller import Controller
from ...control.references import ReferenceLike
from ...simulation.commands import CommandsLike
from ...simulation.log import Log
from ...support import arguments, interrupts
from ..axes import Values
from ..executor import conducted
from .plan import Plan, Variant
from .result import Comparison, Keep, Measured, Outcome, Progress, Tally, measured

_ARGUMENTS = {
    "models": arguments.SOME,
    "vary": arguments.or_none(arguments.AXES),
    "commands": arguments.ANY,
    "duration": arguments.SECONDS,
    "log_every": arguments.COUNT,
    "logs": arguments.FLAG,
    "processes": arguments.or_none(arguments.COUNT),
    "progress": arguments.or_none(arguments.PROGRESS),
    "against": arguments.or_none(arguments.WHOLE),
    "reference": (
        lambda value: value is None or isinstance(value, str) or callable(value),
        "where to fly: a name, or a function that is called as reference(t); the row that the "
        "others are compared with is `against`",
    ),
}
_GUIDED = ("controller", "reference", "controller_rate", "delay")
_KINDS = {
    **_ARGUMENTS,
    "engine": arguments.NAME,
    "world": arguments.ANY,
    "spawn": arguments.ANY,
    "scenario": arguments.ANY,
}
_LARGEST_LOGS = 2 * 2**30  # bytes


def compare(
    models: Union[str, Path, Sequence[Union[str, Path]]],
    vary: Optional[Mapping[str, Values]] = None,
    commands: Optional[CommandsLike] = None,
    duration: float = 10.0,
    log_every: int = 1,
    logs: bool = True,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
    against: Optional[int] = None,
    controller: Union[Controller, Callable[..., Any], str, None] = None,
    reference: Union[ReferenceLike, str, None] = None,
    controller_rate: Optional[float] = None,
    delay: Optional[float] = None,
    **options: Any,
) -> Comparison:
    """Fly the same flight with several models or parameters, in parallel.

    Parameters
    ----------
    models
        One or several models: files or names of shipped ones.
    vary
        Values by ``"PLUGIN.TAG"``, ``"LINK.mass"`` or the like, or ``"xacro.ARG"`` (several, joined
        by commas, take the same value), ``"engine"``, ``"world"`` or ``"scenario"``. All
        combinations are flown; the last axis runs fastest.
    commands, duration, log_every
        As for `Simulation.run`.
    logs
        Whether to keep them.
    processes
        How many; None takes one per core.
    progress
        Called as progress(flights_done, flights_total).
    against
        Row of the table that all others are compared with; None: the first that flies.
    controller, reference
        As for `Simulation.run`: each flight is guided, and begins on the reference unless `spawn`
        is given. Without a reference it hovers at the spawn.
    controller_rate, delay
        Of the controller; None leaves it its own.
    **options
        As for `Simulation`: engine, world, dt, seed, parameters, xacro_args, spawn; and scenario, a
        file or the name of a shipped one.

    Returns
    -------
    Comparison
        The same whatever the number of processes: flights of a controller or reference that is none
        of quadcore's have processes of their own, which begin as this one is when they begin.

    Raises
    ------
    InputError
        Nothing was flown: too many variants, logs that would take more than 2 GiB, an unreadable
        file, an unknown tag, models with different numbers of rotors under the same commands, or
        a law that can fly none of them. A variant that fails by itself is a row of the table with
        its reason instead.
    FlightError
        The flight to compare the others with failed.
    KeyboardInterrupt
        With the attribute `comparison`, whose missing rows say so.
    """
    models = arguments.read_once(models)
    given = locals()
    arguments.check({**{name: given[name] for name in _ARGUMENTS}, **options}, _KINDS)
    guided = {name: given[name] for name in _GUIDED}
    plan = Plan(
        arguments.several(models), vary or {}, commands, duration, log_every, options, guided
    )
    if logs:
        _check_memory(plan, duration, log_every)
    return fly(plan, (lambda _, log: log) if logs else None, processes, progress, against)


def fly(
    plan: Plan,
    keep: Optional[Keep] = None,
    processes: Optional[int] = None,
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
    processes, progress, against
        As for `compare`.
    """
    if against is not None and not 0 <= against < plan.count:
        raise InputError(f"against is {against}; give a row from 0 to {plan.count - 1}")
    tally = Tally(plan, keep, progress)
    flights = _first(plan, against)
    try:
        compared_with = _first_flown(plan, flights, tally, against)
        if compared_with is not None:

            def flown(flight: Tuple[int, Variant]) -> Any:
                row, variant = flight
                log = plan.fly(variant)
                return row, measured(plan, compared_with, log), log

            def kept(result: Any) -> Outcome:
                row, found, log = result
                return _kept(row, found, log, keep)

            start = tally.done

            def note(i: int, outcome: Any) -> None:
                row = start + i
                tally.note(row - 1 if against is not None and row <= against else row, outcome)

            conducted(flown, flights, note, processes, kept, apart=plan.guidance.apart)
    except KeyboardInterrupt as stop:
        stop.comparison = tally.result()  # type: ignore[attr-defined]
        raise
    return tally.result()


def _first(plan: Plan, against: Optional[int]) -> Iterator[Tuple[int, Variant]]:
    """Give each variant with its row, the one to compare with before all others."""
    if against is not None:
        yield against, next(islice(plan, against, None))
    for row, variant in enumerate(plan):
        if row != against:
            yield row, variant


def _first_flown(
    plan: Plan, flights: Iterator[Tuple[int, Variant]], tally: Tally, wanted: Optional[int]
) -> Optional[Log]:
    """Take flights until one succeeds, which all later ones are compared with.

    One that is wanted must.
    """
    outcomes: List[Union[Log, QuadcoreError]] = []
    for row, variant in flights:
        # In a process too: what crashes there does not end the comparison.
        conducted(plan.fly, [variant], lambda _, outcome: outcomes.append(outcome), 1)
        log = outcomes.pop()
        if isinstance(log, Log):
            tally.compare_with(row, log)
            with interrupts.held():
                tally.note(row, _kept(row, measured(plan, log, log), log, tally.keep))
            return log
        if wanted is not None:
            if isinstance(log, InputError):
                raise InputError(f"no. {row + 1}, to compare the others with, is refused: {log}")
            raise FlightError(f"no. {row + 1}, to compare the others with, failed: {log}")
        tally.note(row, log)
    return None


def _kept(row: int, found: Measured, log: Log, keep: Optional[Keep]) -> Outcome:
    return found, None if keep is None else keep(row, log)


def _check_memory(plan: Plan, duration: float, log_every: int) -> None:
    """Refuse logs that could not be held: better now than when the machine swaps."""
    size = plan.count * duration / plan.dt / log_every * (14 + plan.rotor_count) * 8
    if size > _LARGEST_LOGS:
        raise InputError(
            f"the logs of {plan.count} flights take {size / 2**30:.0f} GiB; give logs=False, or a "
            "larger log_every"
        )
