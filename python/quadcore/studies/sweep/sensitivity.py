"""Sensitivity of the metrics of a sweep to its parameters.

PAWN indices exist for every design and rank the parameters; see `pawn`. Spearman's rank correlation
adds the direction of an effect, but misses effects that are not monotonic. The design "saltelli"
also gives Sobol indices. They are the share of the variance that a parameter causes alone (first
order), and including interactions with others (total). See Saltelli et al., Computer Physics
Communications 181, 2010.
"""

from __future__ import annotations

import math
from typing import Any, Dict, Iterator, List, Mapping, Tuple

import numpy as np

from ...support.optional_packages import require_package
from ..distributions import make_unit_problem
from ..ranking import rank_values
from .pawn import compute_pawn
from .plan import AnyPlan

Columns = Mapping[str, np.ndarray]

FAILED = "failed"
"""Name of the metric that is 1 for a failed row and 0 otherwise."""

COMBINATION = ("controller", "reference", "engine", "model")

_PAWN = ("pawn", "pawn_interval", "pawn_noise")
_INDICES = ("first", "first_interval", "total", "total_interval")


def compute_sensitivities(plan: AnyPlan, columns: Columns) -> List[Dict[str, Any]]:
    """Compute the sensitivity of each metric to each parameter.

    Parameters
    ----------
    plan
        Plan of the sweep.
    columns
        Results in the order of the rows.

    Returns
    -------
    list of dict
        Row per combination, metric and numeric axis, sorted by decreasing effect. ``pawn`` is the
        PAWN index, followed by the half-width of its 95 % interval and by its noise. ``rank`` is
        the rank correlation. ``first`` and ``total`` are Sobol indices with half-widths. They are
        NaN for other designs, for axes without a distribution, and if rows failed.
    """
    found = []
    for names, chosen in list_combinations(columns):
        for measure, values in list_metrics(plan, columns, chosen):
            sobol = _sobol_indices(plan, columns, chosen, values)
            rows = []
            for axis in list_numeric_axes(plan, columns):
                row: Dict[str, Any] = {**names, "measure": measure, "axis": axis}
                row.update(zip(_PAWN, compute_pawn(columns[axis][chosen], values)))
                row["rank"] = _rank_correlation(columns[axis][chosen], values)
                row.update(sobol.get(axis, dict.fromkeys(_INDICES, math.nan)))
                if not (math.isnan(row["rank"]) and math.isnan(row["total"])):
                    rows.append(row)
            found += sorted(rows, key=measure_effect, reverse=True)
    return found


def measure_effect(row: Mapping[str, Any]) -> float:
    """Return the effect size that ranks the axes: total Sobol index, else PAWN, else |rank|."""
    sizes = row["total"], row["pawn"], abs(row["rank"])
    return next((float(size) for size in sizes if not math.isnan(size)), 0.0)


def list_combinations(columns: Columns) -> Iterator[Tuple[Dict[str, str], np.ndarray]]:
    """Yield the names of each combination, and the indices of its rows."""
    shared = [name for name in COMBINATION if name in columns]
    count = len(columns["row"])
    if not shared:
        yield {}, np.arange(count)
        return
    keys = list(zip(*(columns[name].tolist() for name in shared)))
    for key in dict.fromkeys(keys):
        where = np.flatnonzero([other == key for other in keys])
        yield dict(zip(shared, map(str, key))), where


def list_metrics(
    plan: AnyPlan, columns: Columns, chosen: np.ndarray
) -> Iterator[Tuple[str, np.ndarray]]:
    """Yield the metrics of some rows, and `FAILED` if only some of them failed."""
    failed = (columns["failure"][chosen] != "").astype(float)
    for name in plan.measures:
        values = columns[name][chosen].astype(float)
        if np.isfinite(values).any():
            yield name, values
    if 0 < failed.sum() < len(failed):
        yield FAILED, failed


def list_numeric_axes(plan: AnyPlan, columns: Columns) -> List[str]:
    """List the axes with more than one numeric value."""
    return [
        name
        for name in plan.design.names
        if columns[name].dtype.kind == "f" and len(np.unique(columns[name])) > 1
    ]


def _rank_correlation(axis: np.ndarray, values: np.ndarray) -> float:
    """Compute the rank correlation of finite values; NaN for fewer than three values."""
    known = np.isfinite(values)
    if known.sum() < 3:
        return math.nan
    a, b = (rank_values(each[known]) for each in (axis, values))
    a, b = a - a.mean(), b - b.mean()
    size = math.sqrt(float((a @ a) * (b @ b)))
    return float(a @ b) / size if size > 0 else math.nan


def _sobol_indices(
    plan: AnyPlan, columns: Columns, chosen: np.ndarray, values: np.ndarray
) -> Dict[str, Dict[str, float]]:
    """Compute the Sobol indices of each axis with a distribution; empty for other designs."""
    design = plan.design
    if design.kind != "saltelli" or not design.drawn or not np.isfinite(values).all():
        return {}
    points = len(design.blocks[-1].rows)
    seeds = len(np.unique(columns["seed"])) if "seed" in columns else 1
    whole = len(values) == len(design) * seeds
    if not whole or len(design) != points or np.ptp(values) == 0:
        return {}
    with require_package("Sobol indices", "SALib", "sweep"):
        from SALib.analyze import sobol

    names = list(design.drawn)
    indices = sobol.analyze(
        make_unit_problem(len(names)),
        values.reshape(points, seeds).mean(axis=1),
        calc_second_order=False,
        seed=0,
    )
    parts = zip(*(indices[key].tolist() for key in ("S1", "S1_conf", "ST", "ST_conf")))
    return {name: dict(zip(_INDICES, part)) for name, part in zip(names, parts)}
