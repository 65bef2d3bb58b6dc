"""Properties of vehicles that explain failed flights."""

from __future__ import annotations

from typing import List

from ..._core import QuadcoreError
from ..table import NOT_FLOWN
from .evaluate import Evaluation
from .plan import Plan
from .poles import describe_yaw_zero, find_yaw_zero


def explain_failures(evaluation: Evaluation, plan: Plan) -> List[str]:
    """Describe the right-half-plane yaw zero of each model with failed flights, one line each."""
    found = {}
    for row, flight in enumerate(evaluation.table):
        if flight["failure"] not in ("", NOT_FLOWN) and flight["model"] not in found:
            try:
                vehicle = plan.make_plan_of_row(row).simulation()
            except QuadcoreError:  # the flight failed for the same reason
                continue
            found[flight["model"]] = describe_yaw_zero(find_yaw_zero(vehicle))
    return [f"{model}: {text}" for model, text in found.items() if text]
