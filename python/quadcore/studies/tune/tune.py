"""Tune a law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Union

from ..._core import FlightError
from ...control.built_in import BuiltInController
from ...control.keywords import ControllerName
from ...simulation.engines import STUDIED, AnyEngineName
from ...support import arguments
from ...support.arguments import several
from ...support.optional_packages import require_package
from ..axes import Values
from ..control_setup import References
from ..options import Keywords, Names, Options, Progress, accept_options
from .problem import Problem
from .search import Search, Tuning

if TYPE_CHECKING:
    from typing_extensions import Unpack

_INTERRUPTED = "interrupted"


@accept_options(
    Options,
    model=arguments.NAMES,
    references=arguments.GUIDES,
    held_out=arguments.GUIDES,
    held_out_models=arguments.NAMES,
    only=arguments.or_none(arguments.NAMES),
    engine=arguments.NAME,
    vary=arguments.or_none(arguments.AXES),
    budget=arguments.WHOLE,
)
def tune(
    law: Union[ControllerName, BuiltInController],
    model: Names = "quadrotor",
    references: References = ("spiral", "step"),
    held_out: References = ("circle", "eight"),
    held_out_models: Names = (),
    only: Optional[Sequence[str]] = None,
    *,
    engine: AnyEngineName = STUDIED,
    vary: Optional[Mapping[str, Values]] = None,
    budget: int = 300,
    **options: Unpack[Keywords],
) -> Tuning:
    """Search for gains of a law.

    By CMA-ES (Hansen 2016, arXiv:1604.00772) on the logarithms of the gains. Gains that are better
    than all before are flown in the held-out cases, too, and refused if one is lost there, or if a
    vehicle that begins beside a reference does not come back to it. The same seed gives the same
    result, whatever the number of processes.

    Parameters
    ----------
    law
        Name, ``NAME:KEY=VALUE,...``, gains file, or one of `quadcore.controllers`. The search
        starts at its parameters.
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
    engine
        Of each flight.
    vary
        Conditions by axis, as for `evaluate`: gains are tuned, and judged, in all combinations.
    budget
        Gains to try, at least.
    **options

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
    shared = Options(**options)
    flown = several(model), several(references)
    judged = several(held_out), several(held_out_models)
    chosen = None if only is None else several(only)
    problem = Problem(law, *flown, *judged, chosen, engine, vary or {}, shared)
    return search_gains(problem, budget, shared.progress)


def search_gains(problem: Problem, budget: int, progress: Optional[Progress] = None) -> Tuning:
    """Search for the gains of a problem; raises as `tune`."""
    cma = _import_cma()
    search = Search(problem, budget, progress)
    try:
        search.run(cma)
    except KeyboardInterrupt as stop:
        stop.tuning = search.make_tuning(cma, _INTERRUPTED)  # type: ignore[attr-defined]
        raise
    found = search.make_tuning(cma, "")
    if found is None:
        failure = FlightError(
            f"no gains found: {search.refusal}; begin elsewhere, or search longer"
        )
        failure.evaluations = search.evaluations  # type: ignore[attr-defined]
        raise failure
    return found


def _import_cma() -> Any:
    with require_package("tuning", "cma", "tune"):
        import cma
    return cma
