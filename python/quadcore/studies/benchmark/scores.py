"""Scores of controllers: one for each category of a benchmark, without an overall score."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

NAMES = ("controller", "category", "model", "scenario", "reference")
"""Columns that identify a row of results."""

METRICS = ("rms_position", "max_position", "final_position")
"""Metrics of a row of results, each with the limits of its confidence interval."""

DIGITS = 4
"""Significant digits of the results, few enough to be the same on all machines."""


class Score(NamedTuple):
    """Score of a controller in a category."""

    controller: str
    category: str
    error: float
    """Median over the combinations of the mean RMS tracking error, m. A combination with a failed
    flight counts as infinite. NaN if no flight ran."""
    flights: int
    """Number of flights that ran."""
    failed: int
    """Number of flights that failed."""


def make_cells(groups: Sequence[Mapping[str, Any]]) -> List[Dict[str, Any]]:
    """Make a row of results for each row of `Benchmark.groups`: names, counts and mean errors."""
    cells = []
    for group in groups:
        cell = {name: group[name] for name in NAMES}
        cell["flights"] = group["flights"]
        cell["failed"] = round(group["failure_rate"] * group["flights"]) if group["flights"] else 0
        for metric in METRICS:
            for end, part in (("", "mean"), ("_low", "low"), ("_high", "high")):
                cell[metric + end] = float(f"{group[f'{part}_{metric}']:.{DIGITS}g}")
        cells.append(cell)
    return cells


def compute_scores(cells: Sequence[Mapping[str, Any]]) -> List[Score]:
    """Compute the scores from rows of results."""
    found: Dict[Tuple[str, str], List[Mapping[str, Any]]] = {}
    for cell in cells:
        found.setdefault((cell["controller"], cell["category"]), []).append(cell)
    return [
        Score(
            *names,
            _compute_median(rows),
            sum(row["flights"] for row in rows),
            sum(row["failed"] for row in rows),
        )
        for names, rows in found.items()
    ]


def _compute_median(cells: Sequence[Mapping[str, Any]]) -> float:
    errors = [
        math.inf if cell["failed"] else cell["rms_position"] for cell in cells if cell["flights"]
    ]
    return float(np.median(errors)) if errors else math.nan


def make_score_table(scores: Sequence[Score]) -> Tuple[List[str], List[Tuple[str, List[str]]]]:
    """Arrange scores in a table: the categories, and the formatted scores of each controller."""
    categories = list(dict.fromkeys(score.category for score in scores))
    rows: Dict[str, List[str]] = {}
    for score in scores:
        rows.setdefault(score.controller, []).append(format_score(score))
    return categories, list(rows.items())


def format_score(score: Score) -> str:
    """Format a score: the median error, and the number of failed flights unless it is 0."""
    failures = f"{score.failed} of {score.flights} failed"
    if math.isinf(score.error):
        return failures
    text = "" if math.isnan(score.error) else f"{score.error:.3g}"
    return f"{text}, {failures}" if score.failed else text
