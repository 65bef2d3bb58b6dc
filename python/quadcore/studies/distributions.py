"""Distributions of axes, and sets of sample points."""

from __future__ import annotations

import inspect
import math
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .._core import InputError, parse_number
from ..support.optional_packages import require_package

DIGITS = 12
"""Significant digits of samples, few enough for all machines to write the same text."""


class Distribution(NamedTuple):
    """A distribution that the command line supports."""

    arguments: Tuple[str, ...]
    meaning: str
    make: Callable[..., Any]
    """Returns a frozen distribution of ``scipy.stats``."""


def _import_stats() -> Any:
    from scipy import stats  # slow to import

    return stats


KNOWN: Dict[str, Distribution] = {
    "uniform": Distribution(
        ("LOW", "HIGH"),
        "constant density",
        lambda low, high: _import_stats().uniform(low, high - low),
    ),
    "loguniform": Distribution(
        ("LOW", "HIGH"),
        "constant density of the logarithm",
        lambda low, high: _import_stats().loguniform(low, high),
    ),
    "normal": Distribution(
        ("MEAN", "DEVIATION"), "", lambda mean, deviation: _import_stats().norm(mean, deviation)
    ),
    "truncnormal": Distribution(
        ("MEAN", "DEVIATION", "LOW", "HIGH"),
        "normal within bounds",
        lambda mean, deviation, low, high: _import_stats().truncnorm(
            (low - mean) / deviation, (high - mean) / deviation, mean, deviation
        ),
    ),
    "lognormal": Distribution(
        ("MEDIAN", "DEVIATION"),
        "natural logarithm is normal with this deviation",
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
    """List the formats of the distributions."""
    return [":".join((name, *known.arguments)) for name, known in KNOWN.items()]


def parse(name: str, text: str) -> Optional[Any]:
    """Parse ``NAME:NUMBER:...``; return None if NAME is not a distribution.

    Raises
    ------
    InputError
        If the arguments are invalid.
    """
    kind, *given = text.split(":")
    known = KNOWN.get(kind.strip())
    if known is None:
        return None
    numbers = [parse_number(part) for part in given]
    form = ":".join((kind.strip(), *known.arguments))
    if None in numbers or len(numbers) != len(known.arguments):
        raise InputError(f"vary {name}: '{text}' is not a distribution. Write {form} with numbers.")
    with np.errstate(all="ignore"):
        try:
            made = known.make(*numbers)
            ends = made.ppf([0.25, 0.75])
        except (ValueError, ZeroDivisionError):
            ends = np.array([math.nan])
    if not (np.isfinite(ends).all() and ends[0] < ends[-1]):
        raise InputError(f"vary {name}: the numbers of {text} are invalid. Write {form}.")
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
        raise InputError("samples is 1, but the design saltelli requires more. Give at least 2.")
    with require_package("design saltelli", "SALib", "sweep"):
        from SALib.sample import sobol
    points: np.ndarray = sobol.sample(
        make_unit_problem(dimensions), count, calc_second_order=False, seed=seed
    )
    return points


DESIGNS: Dict[str, Tuple[str, Callable[[int, int, int], np.ndarray]]] = {
    "latin": ("a Latin hypercube", _draw_latin),
    "sobol": ("a scrambled Sobol sequence", _draw_sobol),
    "random": ("independent points", _draw_random),
    "saltelli": (
        "sample for Sobol indices (Saltelli): samples x (axes + 2) flights",
        _draw_saltelli,
    ),
}
"""For each design, its description and a function that draws points in the unit cube."""


def make_unit_problem(dimensions: int) -> Dict[str, Any]:
    """Describe the axes of the unit cube for SALib."""
    return {
        "num_vars": dimensions,
        "names": [str(i) for i in range(dimensions)],
        "bounds": [[0.0, 1.0]] * dimensions,
    }


def draw_points(
    names: Sequence[str], distributions: Sequence[Any], design: str, samples: int, seed: int
) -> List[List[str]]:
    """Draw sample points of several axes.

    Parameters
    ----------
    names, distributions
        Names of the axes, and their distributions with a method ``ppf``.
    design
        One of `DESIGNS`.
    samples
        Number of samples; the design "saltelli" has more points.
    seed
        Seed of the random numbers.

    Returns
    -------
    list of list of str
        Values of the axes at each point.

    Raises
    ------
    InputError
        If the design does not exist or does not support the number of samples, or a value is not
        finite.
    """
    if design not in DESIGNS:
        raise InputError(f"design '{design}' does not exist. Use one of {', '.join(DESIGNS)}.")
    cube = DESIGNS[design][1](len(names), samples, seed)
    columns = []
    for name, distribution, part in zip(names, distributions, cube.T):
        values = np.asarray(distribution.ppf(part), dtype=float)
        if values.shape != part.shape or not np.isfinite(values).all():
            raise InputError(f"vary {name}: a sample is not finite. Use a bounded distribution.")
        columns.append([f"{value:.{DIGITS}g}" for value in values])
    return [list(row) for row in zip(*columns)]


def _check_power(design: str, count: int) -> None:
    if count & (count - 1):
        below = 1 << (count.bit_length() - 1)
        raise InputError(
            f"samples is {count}, but design {design} requires a power of two. Give {below} or "
            f"{2 * below}."
        )


def _import_qmc() -> Any:
    with require_package("this design", "scipy, from 1.7 on,", "sweep"):
        from scipy.stats import qmc
    return qmc


def _seed_argument(engine: Any, seed: int) -> Dict[str, Any]:
    """Return the seed as a keyword argument, named as this version of SciPy requires."""
    named = "rng" if "rng" in inspect.signature(engine.__init__).parameters else "seed"
    return {named: np.random.default_rng(seed)}
