"""Plot of a gain search."""

from __future__ import annotations

from typing import TYPE_CHECKING, Sequence

import numpy as np

from ...report.colours import PALETTE
from ...report.plots import panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_search(errors: Sequence[float]) -> Figure:
    """Draw the objective of each gain set, and the lowest value so far."""
    figure, grid = panels("Mean RMS tracking error of each gain set", 1, height=2.8, above=0.4)
    axes = grid[0, 0]
    numbers = np.arange(1, 1 + len(errors))
    axes.semilogy(numbers, errors, ".", color="0.6", markersize=4, label="gain set")
    lowest = np.minimum.accumulate(errors)
    axes.step(numbers, lowest, where="post", color=PALETTE[0], label="lowest so far")
    axes.set_xlabel("gain set")
    axes.set_ylabel("RMS tracking error (m)")
    axes.legend(loc="upper right", frameon=False)
    return figure
