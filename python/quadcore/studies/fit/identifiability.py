"""What a flight says of each parameter: deviations, and which combinations alone are known.

Columns of the derivative, each made one long, are decomposed by singular values: parameters that do
nothing, and directions in which nothing changes, cannot be told from the flight.
"""

from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence

import numpy as np

_SAME = 1e-3
"""Singular value, of columns one long, below which a direction counts as one that nothing tells."""

_NOTHING = 1e-9
"""Length of a column, of the longest in its own unit, below which a parameter does nothing."""

_INVOLVED = 0.05


class Combination(NamedTuple):
    """Parameters of which only a sum is known."""

    factors: Dict[str, float]
    """By name; that of the first is 1."""
    value: float
    deviation: float

    def __str__(self) -> str:
        parts = [
            name if abs(factor - 1) < 1e-3 else f"{factor:.4g} {name}"
            for name, factor in self.factors.items()
        ]
        return " + ".join(parts)


class Identifiability(NamedTuple):
    """What is known of parameters."""

    deviations: Dict[str, float]
    """Standard deviation of each, NaN where the flight does not tell it."""
    covariance: np.ndarray
    """Of all, with zeros in directions that are not told."""
    singular_values: List[float]
    """Of the derivative with columns one long; near 1: each is told by itself."""
    combinations: List[Combination]
    """Of which only the sum is told."""
    without_effect: List[str]


def analyse(
    names: Sequence[str],
    values: np.ndarray,
    sizes: np.ndarray,
    derivative: np.ndarray,
    left: np.ndarray,
    freedom: int,
) -> Identifiability:
    """Look at the derivative of what is left over.

    Parameters
    ----------
    names, values
        Of the parameters.
    sizes
        Typical ones of them.
    derivative, left
        Of what is left over in its noise, and that.
    freedom
        Numbers that were compared, less those that were fitted.
    """
    lengths = np.linalg.norm(derivative, axis=0)
    acts = lengths * sizes > _NOTHING * np.max(lengths * sizes, initial=0)
    acts &= lengths > 0
    active = np.flatnonzero(acts)
    unit = derivative[:, active] / lengths[active]
    _, singular, rows = np.linalg.svd(unit, full_matrices=False)
    told = singular > _SAME * max(1.0, singular.max(initial=0))
    variance = float(left @ left) / max(1, freedom)
    inverse = (rows[told].T / singular[told] ** 2) @ rows[told] * variance
    covariance = np.zeros((len(names), len(names)))
    covariance[np.ix_(active, active)] = inverse / np.outer(lengths[active], lengths[active])
    untold = rows[~told]
    groups = _group_parameters(untold)
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
        # Of a sum of rank one the pseudoinverse is exact.
        named = {names[i]: float(factor) for i, factor in zip(of, factors)}
        combinations.append(Combination(named, float(factors @ values[of]), deviation))
    without = [name for name, is_active in zip(names, acts) if not is_active]
    deviations.update(dict.fromkeys(without, float("nan")))
    return Identifiability(deviations, covariance, singular.tolist(), combinations, without)


def _group_parameters(directions: np.ndarray) -> List[List[int]]:
    """Join parameters that some direction that nothing tells involves."""
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
