"""Plot of the measured frequency responses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence

import numpy as np

from ...report.colours import curve_style
from ...report.plots import REFERENCE, panels
from .loop_responses import AXES

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_loops(
    loops: Sequence[Mapping[str, Any]],
    label: Callable[[Mapping[str, Any]], str],
    styles: Mapping[str, int],
    above: float,
) -> Figure:
    """Draw gain and phase of the loops, with a row of panels for each axis.

    Parameters
    ----------
    loops
        Rows as returned by `measure_loops`.
    label
        Function that returns the label of a row.
    styles
        Index of the `curve_style` for each label.
    above
        Height of the space for title and legend, inches.
    """
    figure, grid = panels("Measured loop gain in hover", len(AXES), 2, above=above)
    for (gain, phase), axis in zip(grid, AXES):
        for row in loops:
            if row["axis"] == axis and not row["failure"]:
                name = label(row)
                style = {"label": name, "linewidth": 1.2, **curve_style(styles[name])}
                frequencies = row["frequencies"]
                gain.semilogx(frequencies, 20 * np.log10(row["gain"]), **style)
                phase.semilogx(frequencies, np.degrees(_center(row["phase"])), **style)
        gain.axhline(0, **{**REFERENCE, "label": ""})
        phase.axhline(-180, **{**REFERENCE, "label": ""})
        gain.set_ylabel(f"{axis}: gain (dB)")
        phase.set_ylabel("phase (deg)")
    for axes in grid[-1]:
        axes.set_xlabel("frequency (rad/s)")
    return figure


def _center(phases: Sequence[float]) -> np.ndarray:
    """Shift phases by multiples of 360 degrees, so that their median is near -180 degrees."""
    median = float(np.median(phases))
    turns = np.round((median + np.pi) / (2 * np.pi))
    centered: np.ndarray = np.asarray(phases) - 2 * np.pi * turns
    return centered
