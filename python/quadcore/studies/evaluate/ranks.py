"""Ranks of controllers over all cells of a study: Friedman's test, post-hoc test, effect size.

A cell is a combination of reference, engine, model and scenario. Friedman's test shows whether the
controllers differ over the cells, and Nemenyi's test shows which ones differ (Demsar, Journal of
Machine Learning Research 7, 2006). Both tests rank the mean error of each cell, so all cells have
equal weight.
"""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from ..ranking import rank_values
from ..tracking_metrics import EQUAL
from .best_controllers import CELL, RANKED


class Ranks(NamedTuple):
    """Ranks of controllers. Controllers with a failed flight rank last in that cell.

    Attributes
    ----------
    controllers : list of str
        Controllers in the order of their mean rank.
    mean_ranks : list of float
        Mean rank of each controller, where 1 is best.
    cells : int
        Number of cells in which all controllers have flights.
    p_value : float
        p-value of Friedman's test; NaN for fewer than three controllers or two cells.
    agreement : float
        Kendall's W, the effect size: 0 for random ranks, 1 for identical ranks in all cells.
    post_hoc : dict
        p-value of Nemenyi's test for each pair of controllers; empty without `p_value`.
    """

    controllers: List[str]
    mean_ranks: List[float]
    cells: int
    p_value: float
    agreement: float
    post_hoc: Dict[Tuple[str, str], float]


def rank_controllers(groups: Sequence[Mapping[str, Any]]) -> Ranks:
    """Rank the controllers of an evaluation by `RANKED`.

    Parameters
    ----------
    groups
        Rows of `Evaluation.groups`.
    """
    names = list(dict.fromkeys(group["controller"] for group in groups))
    cells: Dict[Any, Dict[str, float]] = {}
    for group in groups:
        if group["flights"]:
            key = tuple(group[name] for name in CELL)
            # Errors that differ by rounding noise are ties.
            units = math.inf if group["failure_rate"] else round(group[f"mean_{RANKED}"] / EQUAL)
            cells.setdefault(key, {})[group["controller"]] = units
    errors = [[cell[name] for name in names] for cell in cells.values() if len(cell) == len(names)]
    if not errors:
        return Ranks(names, [math.nan] * len(names), 0, math.nan, math.nan, {})
    ranks = np.array([rank_values(row) for row in errors])
    means = ranks.mean(axis=0)
    p_value, agreement = _test_friedman(ranks)
    order = np.argsort(means, kind="stable")
    return Ranks(
        [names[i] for i in order],
        means[order].tolist(),
        len(errors),
        p_value,
        agreement,
        {} if math.isnan(p_value) else _test_nemenyi(names, means, len(errors)),
    )


def _test_friedman(ranks: np.ndarray) -> Tuple[float, float]:
    """Return p-value and Kendall's W of ranks (cells, controllers), corrected for ties."""
    from scipy.special import chdtrc

    cells, count = ranks.shape
    if cells < 2 or count < 3:
        return math.nan, math.nan
    repeats = [np.unique(row, return_counts=True)[1] for row in ranks]
    ties = sum(int((each**3 - each).sum()) for each in repeats)
    spread = 12 * float(((ranks.sum(axis=0) - cells * (count + 1) / 2) ** 2).sum())
    whole = cells * (cells * (count**3 - count) - ties)
    if whole == 0:  # all ranks of every cell are tied
        return 1.0, 0.0
    agreement = spread / whole
    return float(chdtrc(count - 1, cells * (count - 1) * agreement)), agreement


def _test_nemenyi(
    names: Sequence[str], means: np.ndarray, cells: int
) -> Dict[Tuple[str, str], float]:
    count = len(names)
    scale = math.sqrt(count * (count + 1) / (12 * cells))
    return {
        (names[i], names[j]): _exceed_range(abs(means[i] - means[j]) / scale, count)
        for i in range(count)
        for j in range(i + 1, count)
    }


def _exceed_range(width: float, count: int) -> float:
    """Return the probability that the range of normal samples exceeds a width.

    This is the studentized range with infinite degrees of freedom (Lund and Lund, Applied
    Statistics 32, 1983). The module scipy.stats would take 0.3 s to import.

    Parameters
    ----------
    width
        Width in standard deviations.
    count
        Number of samples.
    """
    from scipy.special import ndtr

    highest = np.linspace(-8.5, 8.5, 401)  # the density beyond is below 1e-16
    density = np.exp(-(highest**2) / 2) / math.sqrt(2 * math.pi)
    others = (ndtr(highest) - ndtr(highest - width)) ** (count - 1)
    within = count * float(highest[1] - highest[0]) * float(density @ others)
    return max(0.0, 1 - within)


def describe_ranks(ranks: Ranks, confidence: float) -> List[str]:
    """Describe ranks in a few lines; empty for one controller or fewer than two cells."""
    if len(ranks.controllers) < 2 or ranks.cells < 2:
        return []
    order = ", ".join(f"{n} {r:.3g}" for n, r in zip(ranks.controllers, ranks.mean_ranks))
    lines = [f"Mean ranks over {ranks.cells} cells: {order}."]
    if math.isnan(ranks.p_value):
        return [*lines, "Friedman's test needs three controllers."]
    lines.append(f"Friedman's test: p = {ranks.p_value:.2g}, Kendall's W = {ranks.agreement:.2g}.")
    apart = [" and ".join(pair) for pair, p in ranks.post_hoc.items() if p < 1 - confidence]
    lines.append(
        f"Nemenyi's test at {100 * confidence:g} %: {', '.join(apart) or 'no'} pair differs."
    )
    return lines
