"""Identifiability of parameters: standard deviations, and identifiable combinations.

The analysis uses the singular values of the derivative with columns scaled to unit length. A
near-zero singular value marks an unidentifiable combination.
"""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence

import numpy as np

_SAME = 1e-3
"""Relative singular value below which a direction is unidentifiable."""

_NOTHING = 1e-9
"""Relative length of a column below which the parameter has no effect."""

_INVOLVED = 0.05


class Combination(NamedTuple):
    """Parameters of which only a weighted sum is identifiable."""

    factors: Dict[str, float]
    """Weight of each parameter; the first weight is 1."""
    value: float
    deviation: float

    def __str__(self) -> str:
        parts = [
            name if abs(factor - 1) < 1e-3 else f"{factor:.4g} {name}"
            for name, factor in self.factors.items()
        ]
        return " + ".join(parts)


class Identifiability(NamedTuple):
    """Identifiability of the fitted parameters."""

    deviations: Dict[str, float]
    """Standard deviation of each parameter; NaN if it is not identifiable."""
    covariance: np.ndarray
    """Covariance matrix, with zeros in unidentifiable directions."""
    singular_values: List[float]
    """Singular values of the derivative with unit columns; near 1 for independent parameters."""
    combinations: List[Combination]
    """Identifiable sums of parameters."""
    without_effect: List[str]


def analyse(
    names: Sequence[str],
    values: np.ndarray,
    sizes: np.ndarray,
    derivative: np.ndarray,
    left: np.ndarray,
    freedom: int,
) -> Identifiability:
    """Analyse the identifiability of parameters.

    Parameters
    ----------
    names, values
        Names and fitted values of the parameters.
    sizes
        Typical magnitudes of the parameters.
    derivative, left
        Derivative of the weighted residuals, and the weighted residuals.
    freedom
        Degrees of freedom: the number of residuals minus the number of fitted values.
    """
    lengths = np.linalg.norm(derivative, axis=0)
    acts = lengths * sizes > _NOTHING * np.max(lengths * sizes, initial=0)
    acts &= lengths > 0
    active = np.flatnonzero(acts)
    unit = derivative[:, active] / lengths[active]
    _, singular, rows = np.linalg.svd(unit, full_matrices=False)
    identified = singular > _SAME * max(1.0, singular.max(initial=0))
    variance = float(left @ left) / max(1, freedom)
    inverse = (rows[identified].T / singular[identified] ** 2) @ rows[identified] * variance
    covariance = np.zeros((len(names), len(names)))
    covariance[np.ix_(active, active)] = inverse / np.outer(lengths[active], lengths[active])
    unidentified = rows[~identified]
    groups = _group_parameters(unidentified)
    combinations = []
    deviations = dict(zip(names, np.sqrt(np.diag(covariance)).tolist()))
    for group in groups:
        of = active[group]
        for i in of:
            deviations[names[i]] = float("nan")
        if np.linalg.matrix_rank(unit[:, group], tol=_SAME) != 1:
            continue
        first = derivative[:, of[0]]
        factors = first @ derivative[:, of] / (first @ first)
        deviation = float(np.sqrt(factors @ covariance[np.ix_(of, of)] @ factors))
        # For a sum of rank one, the pseudoinverse is exact.
        named = {names[i]: float(factor) for i, factor in zip(of, factors)}
        combinations.append(Combination(named, float(factors @ values[of]), deviation))
    without = [name for name, is_active in zip(names, acts) if not is_active]
    deviations.update(dict.fromkeys(without, float("nan")))
    return Identifiability(deviations, covariance, singular.tolist(), combinations, without)


def _group_parameters(directions: np.ndarray) -> List[List[int]]:
    """Group parameters that occur in the same unidentifiable direction."""
    groups: List[List[int]] = []
    for direction in np.abs(directions) > _INVOLVED:
        joined = set(np.flatnonzero(direction).tolist())
        apart = []
        for group in groups:
            if joined & set(group):
                joined |= set(group)
            else:
                apart.append(group)
        groups = [*apart, sorted(joined)]
    return groups
