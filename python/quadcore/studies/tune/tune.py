"""Tune a law."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional, Sequence, Union

from ..._core import FlightError
from ...control import laws
from ...simulation.engines import STUDIED
from ...support import arguments
from ...support.arguments import several
from ...support.extras import needed
from .problem import Problem
from .search import Progress, Search, Tuning

_KINDS = {
    "model": arguments.NAMES,
    "references": arguments.GUIDES,
    "held_out": arguments.GUIDES,
    "held_out_models": arguments.NAMES,
    "only": arguments.or_none(arguments.NAMES),
    "engine": arguments.NAME,
    "duration": arguments.SECONDS,
    "budget": arguments.WHOLE,
    "processes": arguments.or_none(arguments.COUNT),
    "progress": arguments.or_none(arguments.PROGRESS),
}
_INTERRUPTED = "interrupted"


def tune(
    law: Union[str, laws.Law],
    model: Union[str, Path, Sequence[Union[str, Path]]] = "quadrotor",
    references: Sequence[Any] = ("spiral", "step"),
    held_out: Sequence[Any] = ("circle", "eight"),
    held_out_models: Sequence[Union[str, Path]] = (),
    only: Optional[Sequence[str]] = None,
    engine: str = STUDIED,
    duration: float = 10.0,
    budget: int = 300,
    seed: int = 0,
    spawn: Optional[Sequence[float]] = None,
    processes: Optional[int] = None,
    progress: Optional[Progress] = None,
    **options: Any,
) -> Tuning:
    """Search for gains of a law.

    By CMA-ES (Hansen 2016, arXiv:1604.00772) on the logarithms of the gains. Gains that are better
    than all before are flown in the held-out cases, too, and refused if one is lost there, or if a
    vehicle that begins beside a reference does not come back to it. The same seed gives the same
    result, whatever the number of processes.

    Parameters
    ----------
    law
        Name, ``NAME:KEY=VALUE,...`` or gains file, or one of `quadcore.laws`: its parameters are
        where the search begins.
    model
        What flies, or several; the gains are for the first.
    references
        What is flown to tune: names as on the command line, or functions.
    held_out
        What is flown, by every model, to judge; others than `references`.
    held_out_models
        Fly everything, to judge only.
    only
        Parameters to tune; without, all gains that are not zero at the start: those named k._...,
        ``q_...`` and ``r_...``.
    engine, duration
        Of each flight; s.
    budget
        Gains to try, at least.
    seed
        Of the search and of all noise.
    spawn
        Where flights begin; without, in the full flat state of the reference.
    processes
        How many; None takes one per core.
    progress
        Called as progress(evaluations, budget).
    **options
        As for `Simulation`: world, dt, parameters, xacro_args, ignore.

    Returns
    -------
    Tuning

    Raises
    ------
    InputError
        Something is at fault, or the package cma is missing; nothing was flown.
    FlightError
        No gains kept every held-out case. Its `evaluations` are those of `Tuning`.
    KeyboardInterrupt
        Its attribute `tuning` has the best so far, or None if all were refused.
    """
    given = dict(locals())
    arguments.check({**{name: given[name] for name in _KINDS}, **options}, _KINDS)
    options.update(engine=engine, duration=duration, seed=seed)
    problem = Problem(
        law,
        several(model),
        several(held_out_models),
        several(references),
        several(held_out),
        None if only is None else several(only),
        spawn,
        options,
    )
    cma = _cma()
    search = Search(problem, budget, seed, processes, progress)
    try:
        search.run(cma)
    except KeyboardInterrupt as stop:
        stop.tuning = search.result(cma, _INTERRUPTED)  # type: ignore[attr-defined]
        raise
    found = search.result(cma, "")
    if found is None:
        failure = FlightError(
            f"no gains found: {search.refusal}; begin elsewhere, or search longer"
        )
        failure.evaluations = search.evaluations  # type: ignore[attr-defined]
        raise failure
    return found


def _cma() -> Any:
    with needed("tuning", "cma", "tune"):
        import cma
    return cma
