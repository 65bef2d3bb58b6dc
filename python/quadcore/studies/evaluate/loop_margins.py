"""Stability margins of a loop from its frequency response."""

from __future__ import annotations

import math
from typing import Iterator, NamedTuple, Tuple

import numpy as np


class LoopMargins(NamedTuple):
    """Margins of a stable loop; infinite or 0 where the measured response contains no limit."""

    crossover: float
    """Frequency of the crossover with the smallest delay margin, rad/s; NaN without a crossover."""
    phase_margin: float
    """Smallest phase margin of all crossovers, rad."""
    delay_margin: float
    """Smallest delay that makes the loop unstable, s."""
    gain_low: float
    """Maximum gain factor below 1 that makes the loop unstable."""
    gain_high: float
    """Smallest gain factor above 1 that makes the loop unstable."""


def find_margins(frequencies: np.ndarray, response: np.ndarray) -> LoopMargins:
    """Find the margins of a loop gain L, with the characteristic equation 1 + L = 0.

    Parameters
    ----------
    frequencies : ndarray (n,)
        Frequencies in ascending order, rad/s.
    response : ndarray (n,)
        Complex loop gain at these frequencies.
    """
    found = list(find_crossovers(frequencies, response))
    delays = [(phase + math.pi) % (2 * math.pi) / frequency for frequency, phase in found]
    margins = [abs((phase + 2 * math.pi) % (2 * math.pi) - math.pi) for _, phase in found]
    factors = list(_find_factors(response))
    return LoopMargins(
        found[int(np.argmin(delays))][0] if found else math.nan,
        min(margins, default=math.inf),
        min(delays, default=math.inf),
        max((factor for factor in factors if factor < 1), default=0.0),
        min((factor for factor in factors if factor > 1), default=math.inf),
    )


def find_crossovers(frequencies: np.ndarray, response: np.ndarray) -> Iterator[Tuple[float, float]]:
    """Yield frequency (rad/s) and phase (rad) at each unit gain, by linear interpolation."""
    sizes, phases = np.log(np.abs(response)), np.unwrap(np.angle(response))
    for i in np.flatnonzero(sizes[:-1] * sizes[1:] < 0):
        part = sizes[i] / (sizes[i] - sizes[i + 1])
        frequency = frequencies[i] + part * (frequencies[i + 1] - frequencies[i])
        yield float(frequency), float(phases[i] + part * (phases[i + 1] - phases[i]))


def _find_factors(response: np.ndarray) -> Iterator[float]:
    """Yield the gain factors that move a crossing of the negative real axis to -1."""
    imaginary, sizes = response.imag, np.log(np.abs(response))
    for i in np.flatnonzero(imaginary[:-1] * imaginary[1:] < 0):
        part = imaginary[i] / (imaginary[i] - imaginary[i + 1])
        if response.real[i] + part * (response.real[i + 1] - response.real[i]) < 0:
            yield math.exp(-(sizes[i] + part * (sizes[i + 1] - sizes[i])))
