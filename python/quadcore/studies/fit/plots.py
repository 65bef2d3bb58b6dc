"""Plots of predictions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Mapping, Sequence, Tuple

import numpy as np

from ...report.colours import curve_style
from ...report.drawing import Drawing
from ...report.plots import finish, panels
from ..flight_differences import compute_differences
from .windows import CHANNELS, INSTANTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...simulation.log import Log
    from .judgement import Judgement


def draw(judgement: Judgement) -> Dict[str, Drawing]:
    """Draw the errors of all models; return a `Drawing` by name."""
    return {"errors": finish(_draw_errors(judgement.errors))}


def draw_differences(motion: Sequence[Tuple[str, Log]]) -> Dict[str, Drawing]:
    """Draw the difference of each model from the measured motion; return a `Drawing` by name."""
    (_, measured), *models = motion
    figure, grid = panels("Difference from the measured motion", 2, height=1.8, above=0.75)
    for number, (name, log) in enumerate(models, start=1):
        apart = compute_differences(measured, log)
        for axes, values in zip(grid[:, 0], (apart[:, 0], np.degrees(apart[:, 1]))):
            axes.plot(log.time, values, label=name, linewidth=1, **curve_style(number))
    for axes, label in zip(grid[:, 0], ("position (m)", "attitude (deg)")):
        axes.set_ylabel(label)
    _add_legend(figure, grid[0, 0])
    return {"residuals": finish(figure)}


def _draw_errors(errors: Mapping[str, Mapping[str, np.ndarray]]) -> Figure:
    channels = list(next(iter(errors.values())))
    figure, grid = panels("RMS error of the predictions", len(channels), height=1.5, above=0.75)
    for axes, channel in zip(grid[:, 0], channels):
        for number, (model, of_channels) in enumerate(errors.items()):
            axes.semilogy(
                INSTANTS, of_channels[channel], marker="o", markersize=3, label=model,
                **curve_style(number),
            )  # fmt: skip
        axes.set_ylabel(f"{channel} ({CHANNELS[channel]})")
    grid[-1, 0].set_xlabel("time after the measured state (s)")
    _add_legend(figure, grid[0, 0])
    return figure


def _add_legend(figure: Figure, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="upper left", bbox_to_anchor=(0, 1 - 0.25 / figure.get_figheight()),
        ncol=3, frameon=False,
    )  # fmt: skip
