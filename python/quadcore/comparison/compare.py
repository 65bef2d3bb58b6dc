"""Flying all variants of a plan and measuring how each differs from the first."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import (
    Any,
    Callable,
    Dict,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    Union,
)

import numpy as np

from .. import arguments, interrupts
from .._core import FlightError, InputError, QuadcoreError
from ..commands import CommandsLike
from ..log import Log
from ..study.axes import Values
from ..study.executor import conducted
from ..study.metrics import metrics, states
from ..study.table import NOT_FLOWN, flown_and_failed
from .difference import Difference
from .plan import Plan, Variant

Progress = Callable[[int, int], None]
Keep = Callable[[int, Log], Any]
Outcome = Tuple[np.ndarray, Any]

_ARGUMENTS = {
    "models": arguments.SOME,
    "vary": arguments.or_none(arguments.AXES),
    "commands": arguments.ANY,
    "duration": arguments.SECONDS,
    "log_every": arguments.COUNT,
    "logs": arguments.FLAG,
    "processes": arguments.or_none(arguments.COUNT),
    "progress": arguments.or_none(arguments.PROGRESS),
    "reference": arguments.or_none(arguments.WHOLE),
}
_KINDS = {
    **_ARGUMENTS,
    "engine": arguments.NAME,
    "world": arguments.ANY,
    "spawn": arguments.ANY,
    "scenario": arguments.ANY,
}
_LARGEST_LOGS = 2 * 2**30  # bytes


class Comparison(NamedTuple):
    """What became of the flights.

    Attributes
    ----------
    table : ndarray
        Structured, a row per variant: ``model``, each axis, ``failure`` ("" if it flew), and
        ``final_STATE`` and ``largest_STATE`` for each of `states`, NaN where it did not fly.
    logs : list
        `Log` of each variant, None where it did not fly; empty if logs were not asked for.
    states : dict of str to str
        Unit of each state that is compared, by name. ``position``, ``velocity`` and ``rates`` are
        lengths of difference vectors, ``attitude`` is the angle between both.
    reference : int or None
        Row that all others are compared with: the one asked for, or the first that flew.
    differences : dict of str to list of Difference
        What each further model's file differs in from the first's.
    """

    table: np.ndarray
    logs: List[Any]
    states: Dict[str, str]
    reference: Optional[int]
    differences: Dict[str, List[Difference]]

    def __repr__(self) -> str:
        return f"<Comparison, {flown_and_failed(self.table['failure'].tolist())}>"

    def _repr_html_(self) -> str:
        from ..notebook import comparison_html

        return comparison_html(self)


def compare(
    models: Union[str, Path, Sequence[Union[str, Path]]],
    vary: Optional[Mapping[str, Values]] = None,
    commands: Optional[CommandsLike] = None,
    duration: float = 10.0,
    log_every: int = 1,
    logs: bool = True,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
    reference: Optional[int] = None,
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
    reference
        Row of the table that all others are compared with; None: the first that flies.
    **options
        As for `Simulation`: engine, world, dt, seed, parameters, xacro_args, spawn; and scenario, a
        file or the name of a shipped one.

    Returns
    -------
    Comparison
        The same whatever the number of processes.

    Raises
    ------
    InputError
        Nothing was flown: too many variants, logs that would take more than 2 GiB, an unreadable
        file, an unknown tag, or models with different numbers of rotors under the same commands. A
        variant that fails by itself is a row of the table with its reason instead.
    FlightError
        The reference failed.
    KeyboardInterrupt
        With the attribute `comparison`, whose missing rows say so.
    """
    models = arguments.read_once(models)
    given = locals()
    arguments.check({**{name: given[name] for name in _ARGUMENTS}, **options}, _KINDS)
    plan = Plan(arguments.several(models), vary or {}, commands, duration, log_every, options)
    if logs:
        _check_memory(plan, duration, log_every)
    return fly(plan, (lambda _, log: log) if logs else None, processes, progress, reference)


def fly(
    plan: Plan,
    keep: Optional[Keep] = None,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
    reference: Optional[int] = None,
) -> Comparison:
    """Fly a plan.

    Parameters
    ----------
    plan
        What to fly.
    keep
        Called as keep(row, log) in the process that flew; what it returns stands in for the log.
    processes, progress, reference
        As for `compare`.
    """
    if reference is not None and not 0 <= reference < plan.count:
        raise InputError(f"reference is {reference}; give a row from 0 to {plan.count - 1}")
    tally = _Tally(plan, keep, progress)
    flights = _reference_first(plan, reference)
    try:
        compared_with = _first_flown(plan, flights, tally, reference)
        if compared_with is not None:

            def flown(flight: Tuple[int, Variant]) -> Any:
                row, variant = flight
                log = plan.fly(variant)
                return row, metrics(compared_with, log), log

            def kept(result: Any) -> Outcome:
                row, measured, log = result
                return _kept(row, measured, log, keep)

            start = tally.done

            def note(i: int, outcome: Any) -> None:
                row = start + i
                tally.note(row - 1 if reference is not None and row <= reference else row, outcome)

            conducted(flown, flights, note, processes, kept)
    except KeyboardInterrupt as stop:
        stop.comparison = tally.result()  # type: ignore[attr-defined]
        raise
    return tally.result()


def _reference_first(plan: Plan, reference: Optional[int]) -> Iterator[Tuple[int, Variant]]:
    """Give each variant with its row, the reference before all others."""
    if reference is not None:
        yield reference, next(islice(plan, reference, None))
    for row, variant in enumerate(plan):
        if row != reference:
            yield row, variant


def _first_flown(
    plan: Plan, flights: Iterator[Tuple[int, Variant]], tally: _Tally, wanted: Optional[int]
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
            tally.reference = row
            with interrupts.held():
                tally.note(row, _kept(row, metrics(log, log), log, tally.keep))
            return log
        if wanted is not None:
            raise FlightError(f"no. {row + 1}, to compare the others with, failed: {log}")
        tally.note(row, log)
    return None


def _kept(row: int, measured: np.ndarray, log: Log, keep: Optional[Keep]) -> Outcome:
    return measured, None if keep is None else keep(row, log)


class _Tally:
    """What is known of the flights so far."""

    def __init__(self, plan: Plan, keep: Optional[Keep], progress: Optional[Progress]) -> None:
        self.keep = keep
        self.done = 0
        self.reference: Optional[int] = None
        self._plan, self._progress = plan, progress
        self._states = states(plan.rotor_count)
        self._metrics = np.full((plan.count, 2, len(self._states)), np.nan)
        self._failures = [NOT_FLOWN] * plan.count
        self._kept: List[Any] = [] if keep is None else [None] * plan.count

    def note(self, row: int, outcome: Union[Outcome, QuadcoreError]) -> None:
        if isinstance(outcome, QuadcoreError):
            self._failures[row] = str(outcome)
        else:
            self._metrics[row] = outcome[0]
            if self._kept:
                self._kept[row] = outcome[1]
            self._failures[row] = ""
        self.done += 1
        if self._progress is not None:
            self._progress(self.done, self._plan.count)

    def result(self) -> Comparison:
        plan = self._plan
        axes = list(zip(*(values for _, values in plan)))
        columns: Dict[str, Any] = {
            "model": [plan.names[model] for model, _ in plan],
            **{axis.name: _numbers(values) for axis, values in zip(plan.axes, axes)},
            "failure": self._failures,
        }
        for i, kind in enumerate(("final", "largest")):
            for j, state in enumerate(self._states):
                columns[f"{kind}_{state}"] = self._metrics[:, i, j]
        return Comparison(
            _structured(columns), self._kept, self._states, self.reference, plan.differences()
        )


def _numbers(values: Sequence[str]) -> np.ndarray:
    """Numbers if all are, else texts."""
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return np.array(values)


def _structured(columns: Mapping[str, Sequence[Any]]) -> np.ndarray:
    arrays = {name: np.asarray(values) for name, values in columns.items()}
    table = np.empty(
        len(arrays["model"]), dtype=[(name, array.dtype) for name, array in arrays.items()]
    )
    for name, array in arrays.items():
        table[name] = array
    return table


def _check_memory(plan: Plan, duration: float, log_every: int) -> None:
    """Refuse logs that could not be held: better now than when the machine swaps."""
    size = plan.count * duration / plan.dt / log_every * (14 + plan.rotor_count) * 8
    if size > _LARGEST_LOGS:
        raise InputError(
            f"the logs of {plan.count} flights take {size / 2**30:.0f} GiB; give logs=False, or a "
            "larger log_every"
        )
