"""Statistics over the seeds: failure rates, means, intervals, risks, and differences."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from ..measured_flight import Outcome
from ..tracking_metrics import EQUAL, UNITS
from .best_controllers import RANKED, mark_best
from .intervals import compute_cvar, compute_effect_size, compute_interval


def summarise_seeds(
    groups: Sequence[Tuple[int, ...]],
    names: Sequence[Mapping[str, Any]],
    outcomes: Sequence[Outcome],
    units: Mapping[str, str] = UNITS,
) -> List[Dict[str, Any]]:
    """Summarise the flights of each combination.

    Parameters
    ----------
    groups
        Combination of each flight as indices, of which the first is that of the controller. Each
        controller is compared with the first one of the same combination.
    names
        Names of each flight.
    outcomes
        Outcome of each flight.
    units
        Unit of each metric.

    Returns
    -------
    list of dict
        Row per combination; see `Evaluation.groups`.
    """
    flights: Dict[Tuple[int, ...], List[Outcome]] = {}
    named: Dict[Tuple[int, ...], Mapping[str, Any]] = {}
    for group, name, outcome in zip(groups, names, outcomes):
        flights.setdefault(group, []).append(outcome)
        named.setdefault(group, name)
    firsts: Dict[Tuple[int, ...], List[Outcome]] = {}
    for group, some in flights.items():
        firsts.setdefault(group[1:], some)
    rows = [
        {
            **{name: value for name, value in named[group].items() if name != "seed"},
            **_summarise(some, firsts[group[1:]], units),
        }
        for group, some in flights.items()
    ]
    mark_best(rows, [[f.measures[RANKED] for f in some] for some in flights.values()])
    return rows


def _summarise(
    flights: Sequence[Outcome], first: Sequence[Outcome], units: Mapping[str, str]
) -> Dict[str, Any]:
    """Summarise the flights of a combination, and compare them with the first controller's."""
    took_place = [flight for flight in flights if flight.was_flown]
    flew = [flight for flight in took_place if flight.flew]
    pairs = [(f, other) for f, other in zip(flights, first) if f.flew and other.flew]
    row: Dict[str, Any] = {
        "flights": len(took_place),
        "not_flown": len(flights) - len(took_place),
        "failure_rate": 1 - len(flew) / len(took_place) if took_place else math.nan,
        "is_random": _is_random(flew),
        "pairs": 0 if flights is first else len(pairs),
    }
    certain = row["is_random"] is False and _is_random([f for f in first if f.flew]) is False
    for name in units:
        values = _pick_finite([flight.measures[name] for flight in flew])
        row[f"mean_{name}"] = float(values.mean()) if len(values) else math.nan
        drawn = values[:0] if row["is_random"] is False else values
        row[f"low_{name}"], row[f"high_{name}"] = compute_interval(drawn)
        # A failure is worse than any success.
        lost = np.full(len(took_place) - len(flew), math.inf)
        sign = -1 if name == "clearance" else 1  # the smallest clearances are the worst
        worst = compute_cvar(np.concatenate([sign * values, lost]))
        row[f"cvar_{name}"] = sign * worst if math.isfinite(worst) else worst
        apart = _pick_finite([f.measures[name] - other.measures[name] for f, other in pairs])
        if flights is first:
            apart = apart[:0]
        row[f"difference_{name}"] = float(apart.mean()) if len(apart) else math.nan
        ends = compute_interval(apart[:0] if certain else apart)
        row[f"difference_low_{name}"], row[f"difference_high_{name}"] = ends
        if name == RANKED:
            row["effect_size"] = compute_effect_size(apart[:0] if certain else apart)
    return row


def _is_random(flights: Sequence[Outcome]) -> Optional[bool]:
    """Whether position errors differ between seeds; None for fewer than two flights."""
    if len(flights) < 2:
        return None
    return any(
        np.ptp([flight.measures[name] for flight in flights]) >= EQUAL
        for name in UNITS
        if UNITS[name] == "m"
    )


def _pick_finite(values: Sequence[float]) -> np.ndarray:
    """Remove missing values, such as the overshoot without a step."""
    array: np.ndarray = np.array([value for value in values if math.isfinite(value)], dtype=float)
    return array
