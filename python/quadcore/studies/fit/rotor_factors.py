"""Thrust of each rotor of a damaged vehicle, relative to the undamaged vehicle."""

from __future__ import annotations

from typing import List, NamedTuple, Optional, Sequence

import numpy as np

from ..._core import InputError
from ...formats.recordings import Recording
from .cleaning import clean_recording
from .prepared import find_span

_BLOCK = 0.5  # s; commands within a block are correlated
_DRAWS = 500
_CERTAIN = 3.0  # standard deviations of a significant loss


class RotorFactors(NamedTuple):
    """Thrust and torque factors of the rotors.

    Attributes
    ----------
    factors, deviations : ndarray (rotors,)
        Factor of each rotor, scaled to a median of 1, and its standard deviation.
    """

    factors: np.ndarray
    deviations: np.ndarray

    @property
    def damaged(self) -> Optional[int]:
        """Index of the rotor with a significant loss, or None."""
        worst = int(np.argmin(self.factors))
        loss = 1 - self.factors[worst]
        return worst if loss > _CERTAIN * self.deviations[worst] else None


def find_rotor_factors(
    damaged: Sequence[Recording], sound: Sequence[Recording], seed: int = 0
) -> RotorFactors:
    """Compare the mean squared commands of damaged and sound flights.

    On average over a flight, the thrusts f_i k u_i^2 balance the weight and the torques, as they do
    with sound rotors. Therefore the factor f_i is the ratio of the mean squared commands, sound to
    damaged. The battery adds a common factor, which division by the median removes. The deviations
    come from a bootstrap over blocks of 0.5 s.

    Raises
    ------
    InputError
        If a flight has no commands, or the number of rotors differs between flights.
    """
    blocks = [[_list_blocks(recording) for recording in group] for group in (sound, damaged)]
    widths = {block.shape[1] for group in blocks for block in group}
    if len(widths) != 1:
        raise InputError("the recordings have different numbers of rotors. Compare one vehicle.")
    whole = _compute_factors([[np.mean(each, axis=0) for each in group] for group in blocks])
    random = np.random.default_rng(seed)
    drawn = [
        _compute_factors(
            [
                [each[random.integers(len(each), size=len(each))].mean(axis=0) for each in group]
                for group in blocks
            ]
        )
        for _ in range(_DRAWS)
    ]
    # Flights of the same vehicle differ in trim and battery.
    between = [
        _compute_factors([[np.mean(one, axis=0)], [np.mean(other, axis=0)]])
        for group in blocks
        for i, one in enumerate(group)
        for other in group[i + 1 :]
    ]
    spread = np.std(drawn, axis=0)
    if between:
        spread = np.hypot(spread, np.sqrt(np.mean((np.array(between) - 1) ** 2, axis=0)))
    return RotorFactors(whole, spread)


def _compute_factors(groups: Sequence[List[np.ndarray]]) -> np.ndarray:
    sound, damaged = (
        np.mean([squares / squares.mean() for squares in group], axis=0) for group in groups
    )
    ratio = sound / damaged
    factors: np.ndarray = ratio / np.median(ratio)
    return factors


def _list_blocks(recording: Recording) -> np.ndarray:
    """Return the mean squared commands of each block in the air, shape (blocks, rotors)."""
    if "commands" not in recording.quantities:
        raise InputError(f"{recording.where}: the recording has no commands. Log them.")
    recording, _ = clean_recording(recording)
    begin, end = find_span(recording)
    series = recording.quantities["commands"]
    inside = (series.time >= begin) & (series.time <= end)
    number = ((series.time[inside] - begin) // _BLOCK).astype(int)
    squares = series.values[inside] ** 2
    return np.array([squares[number == n].mean(axis=0) for n in np.unique(number)])
