"""Estimates without the bias from noisy measurements, and their standard deviations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

if TYPE_CHECKING:
    from .window_search import Search

_ROUNDS = 12
_RELEASED = 3
"""Number of initial rounds in which coordinates may leave their bounds."""
_STILL = 0.03
"""Change relative to the standard deviation below which the search ends."""
_LONGEST_STEP = 0.5
"""Maximum change of a coordinate per round, relative to the deviation of the prior."""
_RUNAWAY = 2.0
"""Distance from the start, in deviations of the prior, that marks a failed least-squares fit."""
_BLOCKS = 12
"""Maximum number of blocks of windows per fit; each has at least `_SHORTEST` windows."""
_SHORTEST = 4
"""Minimum number of windows in a block: 1 s, longer than the overlap of windows."""
_CLOSE = 1e-4
"""Distance of a coordinate from its bound below which the bound is active."""
_UNKNOWN = 1e-9
"""Relative eigenvalue below which a direction has no effect."""
_RELIABLE = 0.2
"""Fraction of a squared derivative that is not noise; below it, a direction is ignored."""
_LEVERAGE = 0.9
"""Maximum leverage of one block on a direction."""
_LEARNT = 0.5
"""Deviation relative to that of the prior above which a parameter is not identifiable."""
_VAGUE = 0.4
"""Relative deviation of a positive parameter above which it is not identifiable."""
_POSITIVE = (".ixx", ".iyy", ".izz", ".mass")
_NORMAL = 1.959964
"""97.5 % quantile of the normal distribution, for 95 % intervals."""


class Half(NamedTuple):
    """Half of the samples.

    Attributes
    ----------
    search : Search
        Search that computes the errors.
    smooth : Search
        Search with smoothed samples that computes the instruments; smoothing does not bias them.
    """

    search: Search
    smooth: Search


class _Equations(NamedTuple):
    """Estimating equations in coordinates that whiten the squared derivatives.

    Attributes
    ----------
    moving : ndarray (coordinates,) of bool
        Coordinates that the equations include.
    white : ndarray (moving coordinates, k)
        Matrix from whitened to moving coordinates.
    score : ndarray (k,)
        Derivatives of one half times the errors of the other half, summed over the windows.
    slope : ndarray (k, k)
        Derivative of the score: 1 without noise, 0 for a direction that contains only noise.
    covariance : ndarray (k, k)
        Covariance of the score.
    blocks : int
        Number of blocks of windows.
    """

    moving: np.ndarray
    white: np.ndarray
    score: np.ndarray
    slope: np.ndarray
    covariance: np.ndarray
    blocks: int


def estimate(
    halves: Sequence[Half], start: np.ndarray, x: np.ndarray, free: np.ndarray
) -> Optional[np.ndarray]:
    """Estimate coordinates from two halves of the samples, without the bias from noisy inputs.

    Least squares are biased if inputs or initial states are noisy, because the noise then occurs in
    both the derivatives and the errors. The derivatives from one half of the samples are
    instruments for the errors of the other half, because their noise is independent. See O.
    Reiersol, "Confluence analysis by means of instrumental sets of variables", 1945, and T.
    Soderstrom, "Errors-in-variables methods in system identification", Automatica 43, 2007. In
    directions that the flights do not identify, a weak prior keeps the estimate near the start.

    Parameters
    ----------
    halves
        Searches with the even and with the odd samples.
    start
        Start values.
    x
        Least-squares estimate.
    free
        Coordinates to estimate.

    Returns
    -------
    ndarray
        Estimated coordinates. If the search does not converge, the result is the least-squares
        estimate, or None if that estimate is too far from the start.
    """
    low, high = halves[0].search.find_bounds(len(x))
    prior = halves[0].search.find_prior(len(x))
    is_runaway = (np.abs(x - start) > _RUNAWAY * prior).any()
    found = (start if is_runaway else x).copy()
    for done in range(_ROUNDS):
        moving = free & ((done < _RELEASED) | _list_inner(found, low, high))
        step, spread = _solve(_make_equations(halves, found, moving), found - start, prior)
        longest = _LONGEST_STEP * prior
        after = np.clip(found + np.clip(step, -longest, longest), low, high)
        moved = np.abs(after - found)[moving]
        found[moving] = after[moving]
        if done >= _RELEASED and (moved < _STILL * np.sqrt(np.diag(spread))[moving]).all():
            return found
    return None if is_runaway else x


def compute_deviations(
    halves: Sequence[Half], start: np.ndarray, x: np.ndarray, free: np.ndarray
) -> Dict[str, float]:
    """Compute the standard deviation of each parameter; NaN if it is not identifiable.

    The deviations come from a sandwich estimator. Its clusters are blocks of consecutive windows,
    because these share samples and model errors. The estimator corrects for the leverage of each
    block, similar to a jackknife (R. M. Bell and D. F. McCaffrey, Survey Methodology 28, 2002). The
    deviations are scaled so that a factor of 1.96 gives the 95 % range of the t distribution.

    Parameters
    ----------
    halves
        Searches with the even and odd samples, or one with all samples.
    start, free
        As for `estimate`.
    x
        Estimated coordinates.
    """
    from scipy.special import stdtrit  # scipy.stats is slow to import

    search = halves[0].search
    moving = free & _list_inner(x, *search.find_bounds(len(x)))
    prior = search.find_prior(len(x))
    equations = _make_equations(halves, x, moving)
    covariance = _solve(equations, x - start, prior)[1]
    covariance *= (stdtrit(equations.blocks - 1, 0.975) / _NORMAL) ** 2
    return _name_deviations(search, x, free, covariance, prior)


def _list_inner(x: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return whether each coordinate lies strictly between its bounds."""
    inner: np.ndarray = (x - low > _CLOSE) & (high - x > _CLOSE)
    return inner


def _make_equations(halves: Sequence[Half], x: np.ndarray, moving: np.ndarray) -> _Equations:
    blocks = _list_blocks(halves[0].search.predictor.windows.flight)
    linear = []
    for half in halves:
        errors = half.search.compute(x)
        slope = half.smooth.linearise(x)[1][:, :, moving]
        linear.append((errors, slope, 1 / np.sqrt(1 + errors**2)))  # soft_l1
    size = (len(errors), int(moving.sum()))
    scores, slopes, squares = np.zeros(size), np.zeros((*size, size[1])), np.zeros((*size, size[1]))
    for (errors, slope, weight), (_, instrument, _) in zip(linear, linear[::-1]):
        weighted = slope * weight[:, :, None]
        scores += np.einsum("nek,ne->nk", instrument, errors * weight)
        slopes += np.swapaxes(instrument, 1, 2) @ weighted
        squares += np.swapaxes(slope, 1, 2) @ weighted
    white = _whiten(squares.sum(axis=0))
    slope = white.T @ slopes.sum(axis=0) @ white
    covariance = np.zeros_like(slope)
    for block in blocks:
        leverage, axes = np.linalg.eigh(white.T @ squares[block].sum(axis=0) @ white)
        score = axes.T @ (white.T @ scores[block].sum(axis=0))
        adjusted = axes @ (score / (1 - np.minimum(leverage, _LEVERAGE)))
        covariance += np.outer(adjusted, adjusted)
    score = white.T @ scores.sum(axis=0)
    covariance *= (len(blocks) - 1) / len(blocks)
    slope = _drop_noise((slope + slope.T) / 2)
    return _Equations(moving, white, score, slope, covariance, len(blocks))


def _drop_noise(slope: np.ndarray) -> np.ndarray:
    """Set the slope to zero in directions that contain little more than noise."""
    reliability, axes = np.linalg.eigh(slope)
    dropped: np.ndarray = (axes * np.where(reliability > _RELIABLE, reliability, 0)) @ axes.T
    return dropped


def _whiten(squares: np.ndarray) -> np.ndarray:
    """Return W with W^T squares W = 1; directions without effect are omitted."""
    scale = np.sqrt(np.maximum(np.diag(squares), 1e-300))
    values, vectors = np.linalg.eigh(squares / np.outer(scale, scale))
    acts = values > _UNKNOWN * values.max(initial=0)
    white: np.ndarray = vectors[:, acts] / np.sqrt(values[acts]) / scale[:, None]
    return white


def _solve(
    equations: _Equations, away: np.ndarray, prior: np.ndarray
) -> Tuple[np.ndarray, np.ndarray]:
    """Return the step to the estimate, and the covariance of the estimate.

    The estimate minimises a sum of two terms: the squared score, weighted by the inverse of its
    mean variance, and the squared distance from the start, weighted by the inverse variance of the
    prior.
    """
    moving, white, score, slope, spread, _ = equations
    weight = np.diag(prior[moving] ** -2)
    variance = float(np.trace(spread)) / len(score) + 1e-300
    effect = slope @ np.linalg.pinv(white)
    gain = effect.T / variance
    inverse = np.linalg.inv(gain @ effect + weight)
    step, covariance = np.zeros(len(away)), np.diag(prior**2)
    step[moving] = -inverse @ (gain @ score + weight @ away[moving])
    covariance[np.ix_(moving, moving)] = inverse @ (gain @ spread @ gain.T + weight) @ inverse
    return step, covariance


def _name_deviations(
    search: Search, x: np.ndarray, free: np.ndarray, covariance: np.ndarray, prior: np.ndarray
) -> Dict[str, float]:
    shared = search.parameters
    through = search.coordinates.decode_derivative(x[:shared])
    spreads = np.sqrt(np.diag(through @ covariance[:shared, :shared] @ through.T))
    priors = np.sqrt(np.diag(through @ np.diag(prior[:shared] ** 2) @ through.T))
    values = search.coordinates.decode(x[:shared])
    deviations = {}
    for k, name in enumerate(search.coordinates.names):
        is_vague = name.endswith(_POSITIVE) and spreads[k] > _VAGUE * values[k]
        is_unknown = is_vague or spreads[k] > _LEARNT * priors[k]
        deviations[name] = (float("nan") if is_unknown else float(spreads[k])) if free[k] else 0.0
    return deviations


def _list_blocks(flight: np.ndarray) -> List[np.ndarray]:
    """Return boolean masks of blocks of consecutive windows; each block belongs to one flight."""
    length = max(_SHORTEST, -(-len(flight) // _BLOCKS))
    blocks = []
    for number in np.unique(flight):
        own = np.flatnonzero(flight == number)
        for part in np.array_split(own, max(1, round(len(own) / length))):
            block = np.zeros(len(flight), bool)
            block[part] = True
            blocks.append(block)
    return blocks
