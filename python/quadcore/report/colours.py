"""Colours and line styles of curves, the same in plots and in the player."""

from __future__ import annotations

from typing import Any, Dict

# Six colours of Okabe and Ito, violet and brown: legible on light and dark, and with colour
# blindness. Grey and black mark everything that is not a flight: references, limits, events.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8e6bbf", "#b07050")

DASHES = ("-", (0, (6, 2)), (0, (1.5, 1.5)), (0, (6, 1.5, 1.5, 1.5)))
"""Line styles, in matplotlib's notation."""


def curve_style(number: int) -> Dict[str, Any]:
    """Return colour and line style of a curve; those of the first 32 differ."""
    dashes = DASHES[number // len(PALETTE) % len(DASHES)]
    return {"color": PALETTE[number % len(PALETTE)], "linestyle": dashes}
