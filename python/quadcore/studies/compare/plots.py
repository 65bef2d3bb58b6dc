"""Plots of several flights in shared axes."""

from __future__ import annotations

from functools import partial
from typing import Any, Dict, List, NamedTuple, Sequence, Tuple

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from ...report.colours import PALETTE
from ...report.plots import NOTHING, WHOLE, add_unslowed_axis, flatten, make_figure, panels, space
from ...simulation.log import Log
from ...support.rotation import unwrap_angles
from ..figures import Figures
from ..flight_differences import compute_differences

_LABELS = 6  # maximum number of labels in the legend of many flights
_NO_DIFFERENCE = 1e-9  # in m, deg, m/s and rad/s; smaller differences are drawn flat


class Curve(NamedTuple):
    """Labelled log of a flight in a plot."""

    label: str
    log: Log


def list_figures(curves: Sequence[Curve], against: Log, name: str) -> Figures:
    """List the figures of the flights and of their differences from a baseline.

    Parameters
    ----------
    curves
        At least one flight.
    against
        Log of the baseline, decimated like the others.
    name
        Name of the baseline, for the title.
    """
    styles = _curve_styles(curves)
    return {
        "path": partial(_draw_path, curves, styles),
        "position": partial(_draw_position, curves, styles),
        "attitude": partial(_draw_attitude, curves, styles),
        "rates": partial(_draw_rates, curves, styles),
        "rotors": partial(_draw_rotors, curves, styles),
        "differences": partial(_draw_differences, curves, styles, against, name),
    }


def _curve_styles(curves: Sequence[Curve]) -> List[Dict[str, Any]]:
    count = len(curves)
    viridis = ScalarMappable(cmap="viridis")
    viridis.set_clim(0, 1.05 * count)  # omit the palest colours
    shades = viridis.to_rgba(np.arange(count))
    named = set(np.linspace(0, count - 1, min(count, _LABELS)).round().astype(int))
    styles = []
    for i, curve in enumerate(curves):
        few = count <= len(PALETTE)
        styles.append(
            {
                "color": PALETTE[i] if few else shades[i],
                # Earlier curves are wider, so that later curves do not hide them.
                "linewidth": 1.2 + (1.6 * (1 - i / count) if few else 0),
                "label": curve.label if few or i in named else None,
            }
        )
    return styles


def _draw_path(curves: Sequence[Curve], styles: Sequence[Dict[str, Any]]) -> Figure:
    figure = make_figure("Paths of the frame", 6, 6)
    axes, _ = space(figure, WHOLE, [curve.log.position for curve in curves])
    for curve, style in zip(curves, styles):
        axes.plot(*curve.log.position.T, **style)
    axes.legend(loc="upper right", frameon=False)
    return figure


def _draw_position(curves: Sequence[Curve], styles: Sequence[Dict[str, Any]]) -> Figure:
    values = [curve.log.position for curve in curves]
    return _draw_panels("Position", curves, styles, [(values, [f"{a} (m)" for a in "xyz"])])


def _draw_attitude(curves: Sequence[Curve], styles: Sequence[Dict[str, Any]]) -> Figure:
    values = [np.degrees(unwrap_angles(curve.log.rpy)) for curve in curves]
    labels = [f"{angle} (deg)" for angle in ("roll", "pitch", "yaw")]
    return _draw_panels("Attitude", curves, styles, [(values, labels)])


def _draw_rates(curves: Sequence[Curve], styles: Sequence[Dict[str, Any]]) -> Figure:
    linear = [curve.log.linear_velocity for curve in curves]
    angular = [curve.log.angular_velocity for curve in curves]
    sides = [
        (linear, [f"$v_{axis}$ (m/s)" for axis in "xyz"]),
        (angular, [rf"$\omega_{axis}$ (rad/s)" for axis in "xyz"]),
    ]
    return _draw_panels("Linear (world) and angular (body) velocity", curves, styles, sides)


def _draw_rotors(curves: Sequence[Curve], styles: Sequence[Dict[str, Any]]) -> Figure:
    count = max(curve.log.rotor_velocity.shape[1] for curve in curves)
    values = [np.abs(curve.log.rotor_velocity) for curve in curves]
    labels = [f"rotor {i} (rad/s)" for i in range(1, 1 + count)]
    title = "Speed of the rotor joints"
    sizes = {curve.log.per_command for curve in curves}
    if len(sizes) == 1 and curves[0].log.is_slow:
        figure = _draw_panels(title, curves, styles, [(values, labels)], right=0.8)
        for axes in figure.axes:
            add_unslowed_axis(axes, curves[0].log.per_command)
        return figure
    return _draw_panels(title, curves, styles, [(values, labels)])


def _draw_differences(
    curves: Sequence[Curve], styles: Sequence[Dict[str, Any]], against: Log, name: str
) -> Figure:
    scale = np.array([1, 180 / np.pi, 1, 1])
    values = [compute_differences(against, curve.log)[:, :4] * scale for curve in curves]
    labels = ["position (m)", "attitude (deg)", "velocity (m/s)", "rates (rad/s)"]
    title = f"Difference from {name}"
    return _draw_panels(title, curves, styles, [(values, labels)], _NO_DIFFERENCE)


def _draw_panels(
    title: str,
    curves: Sequence[Curve],
    styles: Sequence[Dict[str, Any]],
    sides: Sequence[Tuple[Sequence[np.ndarray], Sequence[str]]],
    least: float = NOTHING,
    right: float = 0.1,
) -> Figure:
    """Make a column of panels for each side.

    Parameters
    ----------
    sides
        For each side, the values of each flight and the labels of the columns.
    least
        Minimum range of the values; smaller variations are drawn flat.
    right
        Width of the right margin, inches.
    """
    named = [style["label"] for style in styles if style["label"]]
    # A character is at most 0.1 inches wide, and a line sample in the legend 0.7 inches.
    columns = max(1, int((8 if len(sides) > 1 else 7) * 10 / (7 + max(map(len, named)))))
    lines = 1 + (len(named) - 1) // columns
    above = 0.45 + 0.22 * lines
    figure, grid = panels(title, len(sides[0][1]), len(sides), above=above, right=right)
    for column, (values, labels) in zip(grid.T, sides):
        for curve, style, table in zip(curves, styles, values):
            # Differences end with the shorter of both flights.
            for axes, state in zip(column, table.T):
                axes.plot(curve.log.time[: len(state)], state, **style)
        for axes, label in zip(column, labels):
            axes.set_ylabel(label)
            flatten(axes, least)
    figure.legend(
        *grid[0, 0].get_legend_handles_labels(),
        loc="upper left",
        bbox_to_anchor=(0, 1 - 0.25 / figure.get_figheight()),
        ncol=min(columns, len(named)),
        frameon=False,
    )
    return figure
