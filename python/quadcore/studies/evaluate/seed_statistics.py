"""Statistics over the seeds: failure rates, means, intervals, risks, and differences."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Sequence, Tuple

import numpy as np

from ..measured_flight import Outcome
from ..tracking_metrics import UNITS
from .intervals import compute_cvar, compute_interval

JUDGED = tuple(UNITS)
"""Metrics with statistics over the seeds."""


def summarise_seeds(
    groups: Sequence[Tuple[int, ...]],
    names: Sequence[Mapping[str, Any]],
    outcomes: Sequence[Outcome],
) -> List[Dict[str, Any]]:
    """Summarise the flights of each combination.

    Parameters
    ----------
    groups
        Combination of each flight; the index of the controller is first.
    names
        Names of each flight.
    outcomes
        Outcome of each flight.

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
    return [
        {
            **{name: value for name, value in named[group].items() if name != "seed"},
            **_summarise(some, flights[(0, *group[1:])]),
        }
        for group, some in flights.items()
    ]


def _summarise(flights: Sequence[Outcome], first: Sequence[Outcome]) -> Dict[str, Any]:
    """Summarise the flights of a combination, and compare them with the first controller."""
    took_place = [flight for flight in flights if flight.was_flown]
    flew = [flight for flight in took_place if flight.flew]
    pairs = [(f, other) for f, other in zip(flights, first) if f.flew and other.flew]
    row: Dict[str, Any] = {
        "flights": len(took_place),
        "not_flown": len(flights) - len(took_place),
        "failure_rate": 1 - len(flew) / len(took_place) if took_place else math.nan,
    }
    for name in JUDGED:
        values = _pick_finite([flight.measures[name] for flight in flew])
        row[f"mean_{name}"] = float(values.mean()) if len(values) else math.nan
        row[f"low_{name}"], row[f"high_{name}"] = compute_interval(values)
        # A failure is worse than any success.
        lost = np.full(len(took_place) - len(flew), math.inf)
        row[f"cvar_{name}"] = compute_cvar(np.concatenate([values, lost]))
        apart = _pick_finite([f.measures[name] - other.measures[name] for f, other in pairs])
        if flights is first:
            apart = apart[:0]
        row[f"difference_{name}"] = float(apart.mean()) if len(apart) else math.nan
        row[f"difference_low_{name}"], row[f"difference_high_{name}"] = compute_interval(apart)
    return row


def _pick_finite(values: Sequence[float]) -> np.ndarray:
    """Leave out missing values, such as the overshoot without a step."""
    array: np.ndarray = np.array([value for value in values if math.isfinite(value)], dtype=float)
    return array
