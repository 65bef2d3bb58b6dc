"""Study: all flights of the experiment in parallel, and their comparison."""

from __future__ import annotations

from typing import Callable, Dict, List, NamedTuple, Optional, Sequence, Union

from ..._core import InputError, QuadcoreError
from ...studies.executor import run_contained
from ...studies.flight_differences import DifferenceSizes
from ...studies.table import NOT_FLOWN
from .damping import Damping, measure_damping
from .error_budget import ORDER, Chain, list_stages, make_chain
from .experiment import LAG, MODEL, NO_LAG, TERMS, Case, Experiment, Flight
from .states import compare_states, steepest
from .thesis_figures import SIM_SLOW


class Row(NamedTuple):
    """Comparison of a flight with a reference flight."""

    case: Case
    difference: Optional[DifferenceSizes]
    steepest: float
    """Maximum roll or pitch angle, rad."""
    failure: str
    """Reason why the difference is missing; "" for success."""


class Study(NamedTuple):
    """Results of `run_study`."""

    experiment: Experiment
    engines: List[str]
    sim_slow: List[float]
    drags: List[str]
    flights: Dict[Case, Flight]
    rows: List[Row]
    """Comparison of each engine, sim_slow and drag with the mathematical model."""
    chains: List[Chain]
    left_out: List[Row]
    """Comparison of the model with additional terms to the model, for the last drag."""
    slowed: List[Row]
    """Comparison of the engine eigen to itself at full speed."""
    damping: List[Damping]


def run_study(
    experiment: Experiment,
    engines: Sequence[str] = ORDER,
    sim_slow: Optional[Sequence[float]] = None,
    drags: Optional[Sequence[str]] = None,
    processes: Optional[int] = None,
    progress: Optional[Callable[[int, int], None]] = None,
) -> Study:
    """Simulate every engine, sim_slow and drag, and compare the flights with the model.

    Parameters
    ----------
    sim_slow
        Values of sim_slow. Default: `SIM_SLOW`.
    drags
        Drags. Default: "none", each single drag of the vehicle, and "all".
    processes
        Number of processes. Default: one per core.
    progress
        Function called as progress(flights_done, flights_total).

    Raises
    ------
    InputError
        If a drag does not act on the vehicle.
    KeyboardInterrupt
        On Ctrl-C. The attribute `study` contains the results so far and marks the missing flights.
    """
    acting = experiment.drags()
    for drag in drags or ():
        if drag not in acting:
            raise InputError(f"drag '{drag}' does not act on this vehicle ({', '.join(acting)})")
    drags = list(dict.fromkeys(drags or acting))
    engines = [engine for engine in ORDER if engine in engines]
    sim_slow = list(dict.fromkeys(float(n) for n in sim_slow or SIM_SLOW))
    asked = [Case(e, n, drag) for e in engines for n in sim_slow for drag in drags]
    own = LAG if experiment.motor_lag else NO_LAG
    terms = [Case(MODEL, 1.0, drags[-1], name) for name in TERMS if name != own]
    chains = [list_stages(drag, n, engines[0]) for drag in drags for n in sim_slow]
    cases = dict.fromkeys([*(case for chain in chains for case in chain), *asked, *terms])
    flights = {case: Flight(case, None, NOT_FLOWN) for case in cases}
    damping: List[Damping] = []

    def study() -> Study:
        return Study(
            experiment,
            engines,
            sim_slow,
            drags,
            flights,
            [_compare_row(flights[case], flights[Case(MODEL, 1.0, case.drag)]) for case in asked],
            [make_chain(drag, n, engines[0], flights) for drag in drags for n in sim_slow],
            [_compare_row(flights[case], flights[Case(MODEL, 1.0, drags[-1])]) for case in terms],
            [
                _compare_row(flights[Case("eigen", n, drag)], flights[Case("eigen", 1.0, drag)])
                for n in sim_slow
                for drag in drags
                if n != 1
            ],
            damping,
        )

    try:
        _fly(experiment, flights, processes, progress)
        damping.extend(measure_damping(experiment, engines, n) for n in sim_slow)
    except KeyboardInterrupt as stop:
        stop.study = study()  # type: ignore[attr-defined]
        raise
    return study()


def _fly(
    experiment: Experiment,
    flights: Dict[Case, Flight],
    processes: Optional[int],
    progress: Optional[Callable[[int, int], None]],
) -> None:
    # The model is slow, so its flights start first and no core idles at the end.
    cases = sorted(flights, key=lambda case: case.plant != MODEL)

    def take(index: int, flight: Union[Flight, QuadcoreError]) -> None:
        case = cases[index]
        if isinstance(flight, QuadcoreError):  # the process of the flight died
            flight = Flight(case, None, str(flight))
        flights[case] = flight

    run_contained(experiment.fly, cases, take, processes, progress=progress)


def _compare_row(flight: Flight, reference: Flight) -> Row:
    if flight.log is None or reference.log is None:
        failure = flight.failure or f"{reference.case.plant}: {reference.failure}"
        return Row(flight.case, None, 0.0, failure)
    return Row(flight.case, compare_states(flight.log, reference.log), steepest(flight.log), "")
