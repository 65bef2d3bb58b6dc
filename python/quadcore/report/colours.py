"""Colours and line styles of curves, the same in plots and in the player."""

from __future__ import annotations

from typing import Any, Dict, List

# Six colours of Okabe and Ito, violet and brown: legible on light and dark, and with colour
# blindness. Grey and black mark everything that is not a flight: references, limits, events.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8e6bbf", "#b07050")

DASHES = (
    "-",
    (0, (6, 2)),
    (0, (1.5, 1.5)),
    (0, (6, 1.5, 1.5, 1.5)),
    (0, (10, 3)),
    (0, (3, 1.5, 1, 1.5, 1, 1.5)),
)
"""Line styles, in matplotlib's notation."""


def curve_style(number: int) -> Dict[str, Any]:
    """Return colour and line style of a curve; those of the first 48 differ."""
    return {"color": choose_colour(number), "linestyle": _choose_style(number)}


def choose_colour(number: int) -> str:
    """Return the colour of a curve."""
    return PALETTE[number % len(PALETTE)]


def choose_dashes(number: int) -> List[float]:
    """Return the lengths of dashes and gaps of a curve; none for a solid line."""
    style = _choose_style(number)
    return [] if isinstance(style, str) else list(style[1])


def _choose_style(number: int) -> Any:
    return DASHES[number // len(PALETTE) % len(DASHES)]
