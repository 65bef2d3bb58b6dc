"""Best controllers of each cell: those that no other controller significantly outperforms."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Sequence

import numpy as np

from ..tracking_metrics import EQUAL
from .intervals import CONFIDENCE, adjust_p_values, compute_p_value

RANKED = "final_position"
"""Metric by which controllers are ranked."""

CELL = ("reference", "engine", "model", "scenario")
"""Names that identify a cell of the study, within which controllers are compared."""


def mark_best(groups: Sequence[Dict[str, Any]], flights: Sequence[Sequence[float]]) -> None:
    """Add ``is_best`` and ``p_best`` to the rows of `Evaluation.groups`.

    The best controller of a cell has the lowest mean of `RANKED` among those without a failed
    flight. A t test over the seeds compares it with each other controller, with Holm's correction
    for all comparisons of the study. Controllers without a significant difference are marked as
    well.

    Parameters
    ----------
    groups
        Rows to change; ``p_best`` becomes the corrected p-value, NaN without a comparison.
    flights
        For each row, the metric `RANKED` of each flight in the order of the seeds; NaN for a failed
        flight.
    """
    cells: Dict[Any, List[int]] = {}
    for row, group in enumerate(groups):
        group.update(is_best=False, p_best=math.nan)
        if group["failure_rate"] == 0 and not math.isnan(group[f"mean_{RANKED}"]):
            cells.setdefault(tuple(group.get(name) for name in CELL), []).append(row)
    compared: List[int] = []
    p_values: List[float] = []
    for rows in cells.values():
        best = min(rows, key=lambda row: float(groups[row][f"mean_{RANKED}"]))
        groups[best]["is_best"] = True
        for row in rows:
            if row != best:
                # The number of recorded flights may differ between controllers.
                differences = np.array([a - b for a, b in zip(flights[row], flights[best])])
                differences = differences[np.isfinite(differences)]
                compared.append(row)
                p_values.append(compute_p_value(differences))
                groups[row]["is_best"] = bool(np.all(np.abs(differences) < EQUAL))
    for row, p_value in zip(compared, adjust_p_values(p_values)):
        groups[row]["p_best"] = p_value
        groups[row]["is_best"] |= p_value > 1 - CONFIDENCE


def describe_seeds(groups: Sequence[Mapping[str, Any]]) -> List[str]:
    """Describe the limitations that result from the number of seeds, one line each."""
    flown = [group for group in groups if group["flights"]]
    certain = [group for group in flown if group["is_random"] is False]
    found = []
    if certain and len(certain) == len(flown):
        found.append(
            "Nothing is random in these flights. Seeds have no effect, and there are no intervals."
        )
    elif certain:
        names = dict.fromkeys(
            " on ".join(str(group[name]) for name in ("controller", "reference"))
            + (f" ({group['scenario']})" if group["scenario"] else "")
            for group in certain
        )
        found.append(
            f"Seeds change nothing in {len(certain)} of {len(flown)} combinations, which have no "
            f"intervals: {', '.join(names)}."
        )
    if any(group["is_random"] is None for group in flown):
        found.append(
            "Combinations with fewer than two completed flights have no interval. Use more seeds."
        )
    return found
