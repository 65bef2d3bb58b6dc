"""What an axis is drawn from: distributions by name, and sets of points that fill a box."""

from __future__ import annotations

import inspect
import math
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .._core import InputError, parse_number
from ..support.optional_packages import require_package

DIGITS = 12
"""Of what is drawn, as text: fewer than a double has, so that every machine writes the same."""


class Distribution(NamedTuple):
    """One that the command line knows."""

    arguments: Tuple[str, ...]
    meaning: str
    make: Callable[..., Any]
    """Makes one of scipy.stats, frozen."""


def _import_stats() -> Any:
    from scipy import stats  # slow to import

    return stats


KNOWN: Dict[str, Distribution] = {
    "uniform": Distribution(
        ("LOW", "HIGH"), "all alike", lambda low, high: _import_stats().uniform(low, high - low)
    ),
    "loguniform": Distribution(
        ("LOW", "HIGH"),
        "all magnitudes alike",
        lambda low, high: _import_stats().loguniform(low, high),
    ),
    "normal": Distribution(
        ("MEAN", "DEVIATION"), "", lambda mean, deviation: _import_stats().norm(mean, deviation)
    ),
    "truncnormal": Distribution(
        ("MEAN", "DEVIATION", "LOW", "HIGH"),
        "the same within bounds",
        lambda mean, deviation, low, high: _import_stats().truncnorm(
            (low - mean) / deviation, (high - mean) / deviation, mean, deviation
        ),
    ),
    "lognormal": Distribution(
        ("MEDIAN", "DEVIATION"),
        "whose natural logarithm is normal, with this deviation",
        lambda median, deviation: _import_stats().lognorm(deviation, scale=median),
    ),
    "triangular": Distribution(
        ("LOW", "MODE", "HIGH"),
        "",
        lambda low, mode, high: _import_stats().triang(
            (mode - low) / (high - low), low, high - low
        ),
    ),
}


def list_forms() -> List[str]:
    """Write how each is asked for."""
    return [":".join((name, *known.arguments)) for name, known in KNOWN.items()]


def parse(name: str, text: str) -> Optional[Any]:
    """Read ``NAME:NUMBER:...``; None if no distribution is meant.

    Raises
    ------
    InputError
        Other arguments than it takes.
    """
    kind, *given = text.split(":")
    known = KNOWN.get(kind.strip())
    if known is None:
        return None
    numbers = [parse_number(part) for part in given]
    form = ":".join((kind.strip(), *known.arguments))
    if None in numbers or len(numbers) != len(known.arguments):
        raise InputError(f"vary {name}: '{text}' is no distribution; write {form}, all numbers")
    with np.errstate(all="ignore"):
        try:
            made = known.make(*numbers)
            ends = made.ppf([0.25, 0.75])
        except (ValueError, ZeroDivisionError):
            ends = np.array([math.nan])
    if not (np.isfinite(ends).all() and ends[0] < ends[-1]):
        raise InputError(f"vary {name}: there is no {text}; {form} needs others")
    return made


def _draw_random(dimensions: int, count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).random((count, dimensions))


def _draw_latin(dimensions: int, count: int, seed: int) -> np.ndarray:
    made = _import_qmc().LatinHypercube(
        dimensions, **_seed_argument(_import_qmc().LatinHypercube, seed)
    )
    points: np.ndarray = made.random(count)
    return points


def _draw_sobol(dimensions: int, count: int, seed: int) -> np.ndarray:
    _check_power("sobol", count)
    points: np.ndarray = (
        _import_qmc()
        .Sobol(dimensions, **_seed_argument(_import_qmc().Sobol, seed))
        .random_base2(count.bit_length() - 1)
    )
    return points


def _draw_saltelli(dimensions: int, count: int, seed: int) -> np.ndarray:
    _check_power("saltelli", count)
    if count < 2:
        raise InputError("samples is 1; design saltelli tells nothing of one; give at least 2")
    with require_package("design saltelli", "SALib", "sweep"):
        from SALib.sample import sobol
    points: np.ndarray = sobol.sample(
        make_unit_problem(dimensions), count, calc_second_order=False, seed=seed
    )
    return points


DESIGNS: Dict[str, Tuple[str, Callable[[int, int, int], np.ndarray]]] = {
    "latin": ("a Latin hypercube", _draw_latin),
    "sobol": ("a scrambled Sobol set", _draw_sobol),
    "random": ("independent points", _draw_random),
    "saltelli": (
        "the sets of Saltelli, for Sobol indices: samples x (axes + 2) flights",
        _draw_saltelli,
    ),
}
"""Sets of points in the unit cube, by name, with what they are."""


def make_unit_problem(dimensions: int) -> Dict[str, Any]:
    """Tell SALib of axes that are drawn from the unit cube."""
    return {
        "num_vars": dimensions,
        "names": [str(i) for i in range(dimensions)],
        "bounds": [[0.0, 1.0]] * dimensions,
    }


def draw_points(
    names: Sequence[str], distributions: Sequence[Any], design: str, samples: int, seed: int
) -> List[List[str]]:
    """Draw values of several axes.

    Parameters
    ----------
    names, distributions
        Of the axes; of scipy.stats, or whatever has a method ppf.
    design
        One of `DESIGNS`.
    samples
        How many; "saltelli" makes more of them.
    seed
        The same gives the same.

    Returns
    -------
    list of list of str
        A row for each point.

    Raises
    ------
    InputError
        No such design, a number of samples that it cannot have, or a value that is not finite.
    """
    if design not in DESIGNS:
        raise InputError(f"there is no design '{design}'; give one of {', '.join(DESIGNS)}")
    cube = DESIGNS[design][1](len(names), samples, seed)
    columns = []
    for name, distribution, part in zip(names, distributions, cube.T):
        values = np.asarray(distribution.ppf(part), dtype=float)
        if values.shape != part.shape or not np.isfinite(values).all():
            raise InputError(f"vary {name}: a value that was drawn is not finite; bound it")
        columns.append([f"{value:.{DIGITS}g}" for value in values])
    return [list(row) for row in zip(*columns)]


def _check_power(design: str, count: int) -> None:
    if count & (count - 1):
        below = 1 << (count.bit_length() - 1)
        raise InputError(
            f"samples is {count}; design {design} takes a power of two: {below} or {2 * below}"
        )


def _import_qmc() -> Any:
    with require_package("this design", "scipy, from 1.7 on,", "sweep"):
        from scipy.stats import qmc
    return qmc


def _seed_argument(engine: Any, seed: int) -> Dict[str, Any]:
    """Name the seed as this release of scipy does."""
    named = "rng" if "rng" in inspect.signature(engine.__init__).parameters else "seed"
    return {named: np.random.default_rng(seed)}
