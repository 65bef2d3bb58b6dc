"""The search for the parameters that leave least over."""

from __future__ import annotations

from typing import Any, Callable, Optional, Tuple

import numpy as np

from .problem import Problem, list_bounds

_ROUNDS = 12
"""In each, parameters are sought from given starts and noise, and these are corrected then."""

_TRIALS, _LATER = 12, 3  # in the first round, from far; in others

_STILL = 0.03
"""Change of a round, of what the noise leaves open, with which the search ends."""

Progress = Callable[[int, int], None]


def search(
    problem: Problem, rounds: int = _ROUNDS, progress: Optional[Progress] = None
) -> np.ndarray:
    """Find the parameters; starts and noise of the problem are those that go with them.

    Parameters
    ----------
    problem
        What is free.
    rounds
        At most.
    progress
        Called as progress(rounds done, at most).

    Raises
    ------
    KeyboardInterrupt
        Its attribute `values` has what the last round ended with.
    """
    values = np.array([p.start for p in problem.parameters])
    try:
        for done in range(rounds):
            values, is_still = _run_round(problem, values, done)
            if progress is not None:
                progress(done + 1, rounds)
            if is_still:
                break
    except KeyboardInterrupt as stop:
        stop.values = values  # type: ignore[attr-defined]
        raise
    return values


def _run_round(problem: Problem, values: np.ndarray, done: int) -> Tuple[np.ndarray, bool]:
    """Seek once more, and tell whether that still moved anything."""
    from scipy.optimize import least_squares

    if done:  # first with the starts as measured: far from the parameters others mislead
        problem.linearise_starts(values)
    else:
        problem.learn_noise(values)
    found: Any = least_squares(
        problem.compute_residuals,
        values,
        problem.compute_derivative,
        bounds=list_bounds(problem.parameters),
        x_scale=np.array([p.size for p in problem.parameters]),
        xtol=1e-9,
        max_nfev=_LATER if done else _TRIALS,
    )
    if done:
        problem.correct_starts(found.x)
    problem.learn_noise(found.x)
    moved = np.linalg.norm(found.jac @ (found.x - values))
    return found.x, bool(done > 1 and moved < _STILL)
