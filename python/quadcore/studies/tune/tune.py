"""Gain tuning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Union

from ..._core import FlightError
from ...control.built_in import BuiltInController
from ...control.keywords import ControllerName
from ...simulation.engines import STUDY_ENGINE, AnyEngineName
from ...support import arguments
from ...support.arguments import to_list
from ...support.optional_packages import require_package
from ..accept_options import accept_options
from ..axes import Values
from ..control_setup import References
from ..options import ControlKeywords, ControlOptions, Names, Progress
from .problem import Problem
from .search import Search, Tuning

if TYPE_CHECKING:
    from typing_extensions import Unpack

_INTERRUPTED = "interrupted"


@accept_options(
    ControlOptions,
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
    controller: Union[ControllerName, str, BuiltInController],
    model: Names = "quadrotor",
    references: References = ("spiral", "step"),
    held_out: References = ("circle", "eight"),
    held_out_models: Names = (),
    only: Optional[Sequence[str]] = None,
    *,
    engine: AnyEngineName = STUDY_ENGINE,
    vary: Optional[Mapping[str, Values]] = None,
    budget: int = 300,
    **options: Unpack[ControlKeywords],
) -> Tuning:
    """Search for the gains of a controller.

    The search uses CMA-ES (Hansen 2016, arXiv:1604.00772) on the logarithms of the gains. Each new
    best candidate is checked on the held-out cases. It is rejected if a held-out flight fails, or
    if a vehicle that starts with an offset does not return to the reference. The result depends on
    the seed but not on the number of processes.

    Parameters
    ----------
    controller
        Controller name, ``NAME:KEY=VALUE,...``, gains file, one of `quadcore.controllers`, or your
        own controller as ``MODULE:NAME`` or ``FILE.py[:NAME]``. The search starts from its
        parameters.
    model
        One or several models; the gains file names the first one.
    references
        Training references: names as on the command line, or functions.
    held_out
        Held-out references for all models, different from `references`.
    held_out_models
        Held-out models for all references.
    only
        Parameters to tune (default: all gains, named ``k?_...``, ``q_...`` and ``r_...``, that are
        not zero at the start). Required for your own controller.
    engine
        Engine of all flights.
    vary
        Conditions by axis, as for `evaluate`. Gains are tuned and checked in all combinations.
    budget
        Minimum number of candidates.
    **options

    Returns
    -------
    Tuning
        Best gains and the history of the search.

    Raises
    ------
    InputError
        If an argument is invalid or the package cma is missing. In this case no flight runs.
    FlightError
        If every candidate is rejected. The error has the attribute `evaluations`, as in `Tuning`.
    KeyboardInterrupt
        On Ctrl-C. The attribute `tuning` is the best result so far, or None.
    """
    shared = ControlOptions(**options)
    flown = to_list(model), to_list(references)
    judged = to_list(held_out), to_list(held_out_models)
    chosen = None if only is None else to_list(only)
    problem = Problem(controller, *flown, *judged, chosen, engine, vary or {}, shared)
    return search_gains(problem, budget, shared.progress)


def search_gains(problem: Problem, budget: int, progress: Optional[Progress] = None) -> Tuning:
    """Search for the gains of a problem; the errors are those of `tune`."""
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
            f"no acceptable gains found: {search.refusal}. Try another start or a larger budget."
        )
        failure.evaluations = search.evaluations  # type: ignore[attr-defined]
        raise failure
    return found


def _import_cma() -> Any:
    with require_package("tuning", "cma", "tune"):
        import cma
    return cma
