"""Overview of an evaluation: a sentence for each cell, and a table with a column per controller."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple

from .best_controllers import CELL
from .summary_table import format_error

_SENTENCES = 3


class Overview(NamedTuple):
    """Table with a row for each cell of the study and a column for each controller."""

    names: List[str]
    """Names that differ between cells, or only the reference."""
    controllers: List[str]
    rows: List[Tuple[List[str], List[Tuple[str, bool]]]]
    """Names of each cell; RMS tracking error and whether it is best, for each controller."""


def make_overview(groups: Sequence[Mapping[str, Any]]) -> Overview:
    """Arrange the rows of `Evaluation.groups` by cell and controller."""
    names = [name for name in CELL if len({str(group[name]) for group in groups}) > 1]
    names = names or ["reference"]
    controllers = list(dict.fromkeys(str(group["controller"]) for group in groups))
    cells: Dict[Tuple[str, ...], Dict[str, Tuple[str, bool]]] = {}
    for group in groups:
        error = _describe_failures(group) or format_error(group["mean_rms_position"])
        cell = cells.setdefault(tuple(str(group[name]) for name in names), {})
        cell[str(group["controller"])] = error, bool(group["is_best"])
    rows = [
        (list(cell), [found.get(controller, ("", False)) for controller in controllers])
        for cell, found in cells.items()
    ]
    return Overview(names, controllers, rows)


def _describe_failures(group: Mapping[str, Any]) -> str:
    """Count the failed flights of a group; "" without failures."""
    if not group["failure_rate"] > 0:  # NaN if no flight ran
        return ""
    return f"{round(group['failure_rate'] * group['flights'])} of {group['flights']} failed"


def describe_best(groups: Sequence[Mapping[str, Any]]) -> List[str]:
    """Name the best controllers of each of the first cells in a sentence."""
    overview = make_overview(groups)
    if len(overview.controllers) < 2:
        return []
    sentences = []
    for cell, found in overview.rows[:_SENTENCES]:
        best = [name for name, (_, is_best) in zip(overview.controllers, found) if is_best]
        names = (name if name != "reference" else "" for name in overview.names)
        where = ", ".join(f"{name} {value}".strip() for name, value in zip(names, cell))
        where = f"On {where}" if overview.names[0] == "reference" else f"With {where}"
        if not best:
            if any(text for text, _ in found):  # otherwise no flight of the cell ran
                sentences.append(f"{where}, no controller completed all flights.")
        elif len(best) == len(overview.controllers):
            sentences.append(f"{where}, no controller is significantly better than the others.")
        else:
            verb = "has" if len(best) == 1 else "have"
            sentences.append(f"{where}, {' and '.join(best)} {verb} the lowest final error.")
    if len(overview.rows) > _SENTENCES:
        sentences.append(f"The table shows {len(overview.rows) - _SENTENCES} more combinations.")
    return sentences
