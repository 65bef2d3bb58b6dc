"""Search for the parameters that minimise the residuals."""

from __future__ import annotations

from typing import Any, Callable, Optional, Tuple

import numpy as np

from .problem import Problem, list_bounds

_ROUNDS = 12
"""Maximum number of rounds. Each round fits the parameters, then updates starts and noise."""

_TRIALS, _LATER = 12, 3  # maximum number of evaluations in the first and in later rounds

_STILL = 0.03
"""Change relative to the standard deviation below which the search ends."""

Progress = Callable[[int, int], None]


def search(
    problem: Problem, rounds: int = _ROUNDS, progress: Optional[Progress] = None
) -> np.ndarray:
    """Find the parameters that minimise the residuals, and update starts and noise of `problem`.

    Parameters
    ----------
    problem
        Problem to solve.
    rounds
        Maximum number of rounds.
    progress
        Called as progress(done, total).

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C. The attribute `values` is the result of the last round.
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
    """Run a round; return the values and whether they have converged."""
    from scipy.optimize import least_squares

    if done:  # the first round uses the measured initial states
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
