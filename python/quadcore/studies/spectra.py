"""Power spectral densities of a flight."""

from __future__ import annotations

from typing import NamedTuple, Optional

import numpy as np

from ..simulation.log import Log

_SEGMENT = 4.0  # s; length of a segment, the reciprocal of the resolution
_FEWEST = 16  # minimum number of rows


class Spectra(NamedTuple):
    """One-sided power spectral densities; their integral over the frequency is the variance."""

    frequencies: np.ndarray
    """Frequencies from 0 to half the rate of the rows, Hz; shape (n,)."""
    rates: np.ndarray
    """Sum over the components of the angular velocity, (rad/s)^2/Hz; shape (n,)."""
    commands: np.ndarray
    """Mean over the commanded rotor speeds, (rad/s)^2/Hz; shape (n,)."""


def compute_spectra(log: Log, commands: str) -> Optional[Spectra]:
    """Compute the densities by Welch's method, with Hann windows of 4 s and 50 % overlap.

    Reference: P. D. Welch, The use of fast Fourier transform for the estimation of power spectra,
    IEEE Transactions on Audio and Electroacoustics 15 (1967), 70-73.

    Parameters
    ----------
    log
        Evenly spaced log.
    commands
        Name of the command topic.

    Returns
    -------
    Spectra or None
        Densities; None if the flight is too short.
    """
    from scipy.signal import welch  # slow to import

    fields = log.topics[commands]
    speeds = np.column_stack([fields[name] for name in fields if name != "stamp"])
    begin = int(np.argmax(np.isfinite(speeds).all(axis=1)))  # no command before the first call
    time, speeds, rates = log.time[begin:], speeds[begin:], log.angular_velocity[begin:]
    if len(time) < _FEWEST or not np.isfinite(speeds).all():
        return None
    rate = (len(time) - 1) / (time[-1] - time[0])
    size = min(len(time), round(_SEGMENT * rate))
    frequencies, of_rates = welch(rates, rate, nperseg=size, axis=0)
    _, of_commands = welch(speeds, rate, nperseg=size, axis=0)
    return Spectra(frequencies, of_rates.sum(axis=1), of_commands.mean(axis=1))
