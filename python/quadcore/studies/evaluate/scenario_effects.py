"""Effect of each scenario on the tracking error."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Sequence

_MEASURE = "rms_position"
_WHO = ("controller", "reference", "engine", "model")


def compute_scenario_effects(groups: Sequence[Mapping[str, Any]]) -> List[Dict[str, Any]]:
    """Compare each combination with the same combination in the first scenario.

    Parameters
    ----------
    groups
        Rows of `Evaluation.groups`.

    Returns
    -------
    list of dict
        Row per combination and scenario: names, mean ``rms_position`` (m), ``loss``, the increase
        over the first scenario (m), and ``factor``, the ratio to the first scenario. Errors are
        infinite after a failure. Empty for a single scenario.
    """
    first: Dict[Any, float] = {}
    rows = []
    for group in groups:
        who = tuple(group[name] for name in _WHO)
        error = math.inf if group["failure_rate"] > 0 else group[f"mean_{_MEASURE}"]
        before = first.setdefault(who, error)
        rows.append(
            {
                **dict(zip(_WHO, who)),
                "scenario": group["scenario"],
                _MEASURE: error,
                "loss": error - before if math.isfinite(before) else math.nan,
                "factor": error / before if 0 < before < math.inf else math.nan,
            }
        )
    return rows if len({row["scenario"] for row in rows}) > 1 else []
