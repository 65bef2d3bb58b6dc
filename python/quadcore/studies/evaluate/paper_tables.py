"""Tables for papers, with controllers as columns, as CSV and LaTeX."""

from __future__ import annotations

import math
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Tuple

from ..tracking_metrics import MEANINGS, UNITS
from .best_controllers import CELL

Groups = Sequence[Mapping[str, Any]]

_PRINTED = ("rms_position", "max_position", "final_position")
"""Metrics of the LaTeX table."""

_SPECIAL = {**{c: f"\\{c}" for c in "&%$#_{}"}, "~": r"\textasciitilde{}",
            "^": r"\textasciicircum{}", "\\": r"\textbackslash{}"}  # fmt: skip


def make_rows(groups: Groups, units: Mapping[str, str] = UNITS) -> List[List[Any]]:
    """Make a header and rows: metric, cell, and the mean with interval of each controller.

    The mean excludes failed flights. The column ``failed`` contains the number of failed flights.
    """
    names = _list_controllers(groups)
    header = [
        column
        for name in names
        for column in (name, f"{name} low", f"{name} high", f"{name} failed")
    ]
    rows: List[List[Any]] = [["metric", "unit", *CELL, *header]]
    for metric in units:
        for cell, row in _list_cells(groups):
            values: List[Any] = []
            for name in names:
                group = row.get(name)
                if group is None:
                    values += [math.nan] * 4
                    continue
                values += [group[f"{part}_{metric}"] for part in ("mean", "low", "high")]
                values.append(_count_failures(group))
            rows.append([metric, units[metric], *cell, *values])
    return rows


def make_latex(groups: Groups) -> str:
    """Make LaTeX tables of the position errors (package booktabs); the best values are bold."""
    names = _list_controllers(groups)
    used = [i for i, part in enumerate(CELL) if len({group[part] for group in groups}) > 1]
    parts = []
    for metric in _PRINTED:
        head = [*(CELL[i] for i in used), *names]
        lines = [
            f"% {MEANINGS[metric]}, {UNITS[metric]}: mean and half-width of the 95 % interval",
            rf"\begin{{tabular}}{{{'l' * len(used)}{'r' * len(names)}}}",
            r"\toprule",
            " & ".join(map(_escape, head)) + r" \\",
            r"\midrule",
        ]
        for cell, row in _list_cells(groups):
            cells = [_escape(str(cell[i])) for i in used]
            cells += [_format_mean(row.get(name), metric) for name in names]
            lines.append(" & ".join(cells) + r" \\")
        parts.append("\n".join([*lines, r"\bottomrule", r"\end{tabular}", ""]))
    return "\n".join(parts)


def _list_controllers(groups: Groups) -> List[str]:
    return list(dict.fromkeys(group["controller"] for group in groups))


def _list_cells(groups: Groups) -> Iterator[Tuple[Tuple[Any, ...], Dict[str, Mapping[str, Any]]]]:
    """Yield each cell with its statistics by controller."""
    found: Dict[Tuple[Any, ...], Dict[str, Mapping[str, Any]]] = {}
    for group in groups:
        found.setdefault(tuple(group[name] for name in CELL), {})[group["controller"]] = group
    yield from found.items()


def _count_failures(group: Mapping[str, Any]) -> int:
    return round(group["failure_rate"] * group["flights"]) if group["flights"] else 0


def _format_mean(group: Any, metric: str) -> str:
    if group is None or not group["flights"]:
        return "--"
    failed = _count_failures(group)
    if failed:
        return f"{failed} of {group['flights']} failed"
    mean, low, high = (group[f"{part}_{metric}"] for part in ("mean", "low", "high"))
    text = _format_number(mean)
    if not math.isnan(low):
        text += rf" \pm {_format_number((high - low) / 2, 2)}"
    if metric == "final_position" and group["is_best"]:
        return rf"$\mathbf{{{text}}}$"
    return f"${text}$"


def _format_number(value: float, digits: int = 3) -> str:
    """Format a number for LaTeX, with a power of ten instead of an exponent."""
    number, _, exponent = f"{value:.{digits}g}".partition("e")
    return rf"{number} \cdot 10^{{{int(exponent)}}}" if exponent else number


def _escape(text: str) -> str:
    return "".join(_SPECIAL.get(character, character) for character in text)
