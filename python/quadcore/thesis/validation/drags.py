"""Drags of the thesis, and their tags in libaerodynamic_plugin."""

from __future__ import annotations

from typing import Mapping, Tuple

DRAGS: Mapping[str, Tuple[str, ...]] = {
    "profile": ("profileDragCoeff",),
    "parasitic": ("parasiticDragCoeff",),
    "translational": ("translationalDragCoeff",),
    "induced": ("inducedDragCoeff",),
    "flapping": ("flappingA1c", "flappingA1s", "flappingB1", "flappingB2"),
}
"""Tags of each drag, in the order of chapter 6."""
