"""Summary table of an evaluation for the terminal, the page and notebooks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Sequence

from ..table import format_number
from ..tracking_metrics import EQUAL, UNITS
from .best_controllers import CELL

if TYPE_CHECKING:
    from .evaluate import Evaluation

NAMES = ("controller", *CELL)
_SHOWN = ("rms_position", "max_position", "final_position")


def format_rows(evaluation: Evaluation) -> List[Dict[str, str]]:
    """Format a row per combination; the best controllers of each cell are marked."""
    lines = []
    for group in evaluation.groups:
        flown = round((1 - group["failure_rate"]) * group["flights"]) if group["flights"] else 0
        line = {name: str(group[name]) for name in NAMES}
        line["flown"] = f"{flown} of {group['flights']}"
        line["flown"] += f", {group['not_flown']} not" * (group["not_flown"] > 0)
        for name in _SHOWN:
            line[name] = format_error(group[f"mean_{name}"]) + _format_interval(group, name, flown)
        for name in [name for name in evaluation.units if name not in UNITS]:
            line[name] = format_number(group[f"mean_{name}"]) + _format_interval(group, name, flown)
        line["cvar"] = format_error(group["cvar_final_position"])
        line["difference"] = _format_difference(group)
        line["best"] = "*" if group["is_best"] else ""
        lines.append(line)
    return lines


def choose_columns(
    lines: Sequence[Mapping[str, str]], units: Mapping[str, str] = UNITS
) -> Dict[str, str]:
    """Return the headings of the columns to show; names that all rows share are omitted."""
    names = (name for name in NAMES if len({line[name] for line in lines}) > 1)
    shown = {"controller": "controller", **{name: name for name in names}, "flown": "flown"}
    shown.update(rms_position="RMS (m)", max_position="max (m)")
    shown.update(final_position="last 10 s (m)", cvar="CVaR 10 % (m)")
    if any(line["difference"] for line in lines):
        shown["difference"] = "vs. first controller (m)"
    for name in units:
        if name not in UNITS:
            shown[name] = f"{name} ({units[name]})" if units[name] else name
    return shown


def _format_difference(group: Mapping[str, Any]) -> str:
    """Format the difference from the first controller; "equal" if it is below `EQUAL`."""
    value = group["difference_final_position"]
    if abs(value) < EQUAL:
        return "equal"
    interval = _format_interval(group, "final_position", group["pairs"], "difference_")
    return format_error(value) + interval


def _format_interval(group: Mapping[str, Any], name: str, seeds: int, of: str = "") -> str:
    """Format an interval with its number of seeds; "" without an interval."""
    low, high = group[f"{of}low_{name}"], group[f"{of}high_{name}"]
    return "" if math.isnan(low) else f" [{low:.3g}, {high:.3g}] n={seeds}"


def format_error(value: float) -> str:
    """Format an error; infinity marks a failed flight."""
    return "failed" if math.isinf(value) else format_number(value)
