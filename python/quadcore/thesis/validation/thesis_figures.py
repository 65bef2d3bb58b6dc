"""Figures in chapter 6.1 of the thesis, and the corresponding figures here."""

from __future__ import annotations

from typing import Mapping, NamedTuple, Sequence, Tuple

import numpy as np

# Slowdowns: the text states 1, 8 and 18; the captions of the figures state 1, 8 and 10.
SIM_SLOW = (1.0, 8.0, 10.0, 18.0)


class FigureKind(NamedTuple):
    """Kind of figure that section 6.1 of the thesis shows for each drag."""

    title: str
    columns: slice
    """Columns of the states to draw."""
    labels: Tuple[str, str, str]
    scale: float
    error: bool
    least: float
    """Minimum range of the axis in its unit; smaller ranges would show only rounding errors."""


_ANGLES = (r"$\phi$ (deg)", r"$\theta$ (deg)", r"$\psi$ (deg)")
_RATES = (r"$\dot\phi$ (deg/s)", r"$\dot\theta$ (deg/s)", r"$\dot\psi$ (deg/s)")
_SPEEDS = (r"$\dot x$ (m/s)", r"$\dot y$ (m/s)", r"$\dot z$ (m/s)")
_ERRORS = ("$e_x$ (m)", "$e_y$ (m)", "$e_z$ (m)")
_DEGREES = float(np.degrees(1))

# In the order of the thesis.
KINDS: Mapping[str, FigureKind] = {
    "position": FigureKind("Position", slice(0, 3), ("x (m)", "y (m)", "z (m)"), 1, False, 1e-3),
    "error": FigureKind("Distance from the model", slice(0, 3), _ERRORS, 1, True, 1e-8),
    "attitude": FigureKind("Attitude", slice(3, 6), _ANGLES, _DEGREES, False, 1e-3),
    "velocity": FigureKind("Velocity", slice(6, 9), _SPEEDS, 1, False, 1e-3),
    "rates": FigureKind("Rates of the attitude", slice(9, 12), _RATES, _DEGREES, False, 1e-3),
}
# There are five figures for each drag, starting at 6.1. The thesis does not state the slowdown of
# figures with a single drag.
_ALONE = ("profile", "parasitic", "translational", "induced")
_TOGETHER = SIM_SLOW[:3]


def thesis_figures(drag: str, kind: str, sim_slow: Sequence[float]) -> str:
    """Return the numbers of the corresponding figures in the thesis; "" without any.

    >>> thesis_figures("profile", "error", [1])
    '6.2'
    >>> thesis_figures("all", "position", [1, 10, 18])
    '6.21, 6.31'
    """
    if drag in _ALONE:
        sets = [_ALONE.index(drag)]
    elif drag == "all":
        sets = [len(_ALONE) + _TOGETHER.index(n) for n in sim_slow if n in _TOGETHER]
    else:
        sets = []
    return ", ".join(f"6.{5 * number + 1 + list(KINDS).index(kind)}" for number in sets)
