"""Numerical error of the plant in an evaluation."""

from __future__ import annotations

from typing import Iterator, Optional, Tuple

from ...simulation.flight_plan import FlightPlan
from ..step_error import StepError, compute_step_error
from .plan import Plan


def measure_step_error(plan: Plan) -> Optional[StepError]:
    """Repeat the start of a flight with half the step, preferably with a built-in controller.

    Parameters
    ----------
    plan
        Plan of the evaluation.

    Returns
    -------
    StepError or None
        Numerical error; None if no flight uses an engine with plugins.
    """
    for name, flight in _list_flights(plan):
        found = compute_step_error(name, flight, plan.options.time_limit)
        if found is not None:
            return found
    return None


def _list_flights(plan: Plan) -> Iterator[Tuple[str, FlightPlan]]:
    for names, flight in plan.list_built_in_flights():
        yield _name(names["controller"], names["model"], flight, plan), flight
    for row in range(0, len(plan), len(plan.seeds)):
        sides = plan.name_sides(plan[row])
        flight = plan.make_plan_of_row(row)
        yield _name(sides["controller"], sides["model"], flight, plan), flight


def _name(controller: str, model: str, flight: FlightPlan, plan: Plan) -> str:
    return f"{controller} ({model}, {flight.engine}) on {plan.control.references[0]}"
