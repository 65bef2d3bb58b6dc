"""Table of the measured loops, for the terminal, the page and JSON."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Sequence

from ..table import format_number

HEADINGS = {
    "controller": "controller",
    "engine": "engine",
    "model": "model",
    "axis": "axis",
    "crossover": "crossover (rad/s)",
    "phase_margin": "phase margin (deg)",
    "gain": "gain",
    "delay_margin": "delay (s)",
    "linear_delay_margin": "linear delay (s)",
    "rejection_band": "rejection up to (rad/s)",
    "rejection_peak": "max S",
}
"""Heading of each column."""


def choose_headings(loops: Sequence[Mapping[str, Any]]) -> Dict[str, str]:
    """Return the headings to show; engine and model are omitted if all rows share them."""
    return {
        name: heading
        for name, heading in HEADINGS.items()
        if name not in ("engine", "model") or len({row[name] for row in loops}) > 1
    }


def format_loops(loops: Sequence[Mapping[str, Any]]) -> List[Dict[str, str]]:
    """Format the rows of `measure_loops`; a failed row shows its reason, not the crossover."""
    return [_format(row) for row in loops]


def _format(row: Mapping[str, Any]) -> Dict[str, str]:
    names = {name: str(row[name]) for name in ("controller", "engine", "model", "axis")}
    if row["failure"]:
        return {**dict.fromkeys(HEADINGS, ""), **names, "crossover": row["failure"]}
    numbers = {name: _write(row[name]) for name in list(HEADINGS)[4:] if name != "gain"}
    numbers["phase_margin"] = _write(math.degrees(row["phase_margin"]))
    ends = (_write(row["gain_low"]) or "0", _write(row["gain_high"]) or "inf")
    return {**names, **numbers, "gain": " to ".join(ends)}


def _write(value: float) -> str:
    """Format a number; "" if it is infinite or NaN."""
    return format_number(value) if math.isfinite(value) else ""


def make_plain(row: Mapping[str, Any]) -> Dict[str, Any]:
    """Replace infinity and NaN, which JSON cannot represent, by None."""
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in row.items()
    }
