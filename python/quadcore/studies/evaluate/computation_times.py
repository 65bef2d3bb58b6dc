"""Computation times of user-defined controllers, for the page."""

from __future__ import annotations

import math
from statistics import median
from typing import Any, Dict, List, Tuple

from ..measured_flight import Outcome
from ..table import format_number
from .evaluate import Evaluation
from .plan import Plan


def summarise_computation_times(evaluation: Evaluation, plan: Plan) -> List[Dict[str, str]]:
    """Summarise the durations of the calls of each user-defined controller on each model.

    Returns
    -------
    list of dict
        Row per controller, model and engine. It contains the number of timed flights, and the
        medians over these flights of two values: the median and the 99 % quantile of a call. The
        last column is the ratio of that quantile to the update period.
    """
    found: Dict[Tuple[str, ...], List[Outcome]] = {}
    for case, row, outcome in zip(plan, evaluation.table, evaluation.outcomes):
        if plan.control.is_user_code(case.controller) and not math.isnan(outcome.call):
            names = row["controller"], row["model"], row["engine"]
            found.setdefault(names, []).append(outcome)
    return [
        {**dict(zip(("controller", "model", "engine"), names)), **_summarise(outcomes)}
        for names, outcomes in found.items()
    ]


def _summarise(outcomes: List[Outcome]) -> Dict[str, Any]:
    middle = median(outcome.call for outcome in outcomes)
    slow = median(outcome.slow_call for outcome in outcomes)
    return {
        "flights": str(len(outcomes)),
        "median (ms)": format_number(1e3 * middle),
        "99 % (ms)": format_number(1e3 * slow),
        "99 % / period": format_number(slow * outcomes[0].rate),
    }
