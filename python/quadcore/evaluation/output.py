"""What an evaluation leaves behind: tables, pictures, page."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence

from ..study.table import csv_bytes, flown_and_failed, json_bytes, number_text, save
from .evaluate import JUDGED, Evaluation
from .intervals import CONFIDENCE
from .measures import MEANINGS, UNITS
from .pictures import by_reference, draw, label
from .plan import Plan
from .poles import gains_of
from .poles import text as poles_text

ROWS_OF_PAGE = 200

_PLAYERS, _PLAYED = 4, 8  # references, flights of each
_SWITCHES = ("feed_forward", "drag", "gyroscopic", "flat_rates", "integral", "lead")

_NAMES = ("controller", "reference", "engine", "model", "scenario")


def write(
    evaluation: Evaluation, plan: Plan, flight: Mapping[str, str], folder: Path, plots: bool
) -> List[Path]:
    """Write ``table.csv``, ``evaluation.json``, ``timing.csv``, ``report.html`` and pictures.

    Parameters
    ----------
    evaluation, plan
        What was flown.
    flight
        What all flights share, for the page.
    folder
        Where to.
    plots
        Whether to draw.
    """
    from ..report import write_page  # not every command should pay for jinja2

    # What was flown comes first: pictures can fail, and take their time.
    tables = {
        "table.csv": csv_bytes(_csv(evaluation.table)),
        "evaluation.json": json_bytes(_content(evaluation, flight)),
        "timing.csv": csv_bytes(_timing(evaluation, plan)),
    }
    written = save(folder, tables)
    images = draw(evaluation) if plots else {}
    written += save(folder, {f"{name}.png": data for name, data in images.items()})
    page = folder / "report.html"
    players = _players(evaluation) if plots else []
    values = _page(evaluation, flight, images)
    write_page(page, "evaluate.html", **values, players=players, known=_known(plan))
    return [*written, page]


def _players(evaluation: Evaluation) -> List[Dict[str, Any]]:
    """Make a player of the flights along each of the first references."""
    from ..player import PlayerFlight, fragment

    players = []
    for reference, flights in list(by_reference(evaluation).items())[:_PLAYERS]:
        shown = [
            PlayerFlight(named, outcome.log, outcome.rotors)
            for named, outcome in flights[:_PLAYED]
            if outcome.log is not None
        ]
        players.append({"reference": reference, "player": fragment(shown)})
    return players


def _known(plan: Plan) -> List[Dict[str, str]]:
    """Tell what each law of quadcore flew with: only alike can be compared."""
    rows = []
    for name, engines, flight in plan.laws():
        gains = gains_of(flight.controller)
        shown = {part: f"{gains[part]:g}" if part in gains else "" for part in _SWITCHES}
        timing = {part: f"{getattr(flight.controller, part):g}" for part in ("rate", "delay")}
        rows.append({"controller": name, "engine": engines, **timing, **shown})
    return rows


def summary(evaluation: Evaluation) -> str:
    """How many flew, in one line."""
    return flown_and_failed([row["failure"] for row in evaluation.table])


def rows_to_read(evaluation: Evaluation) -> List[Dict[str, str]]:
    """Lines of the table for people: a combination each, the best of each reference marked."""
    best: Dict[Any, float] = {}
    for group in evaluation.groups:
        key = tuple(group[name] for name in _NAMES[1:])
        value = group["mean_tail_position"]
        if group["failure_rate"] == 0 and not math.isnan(value):
            best[key] = min(value, best.get(key, math.inf))
    lines = []
    for group in evaluation.groups:
        failed = round(group["failure_rate"] * group["flights"])
        line = {name: str(group[name]) for name in _NAMES}
        line["flown"] = f"{group['flights'] - failed} of {group['flights']}"
        for name in JUDGED:
            line[name] = error_text(group[f"mean_{name}"])
        line["tail_position"] += _interval(group, "", 3)
        line["cvar"] = error_text(group["cvar_tail_position"])
        line["difference"] = error_text(group["difference_tail_position"])
        line["difference"] += _interval(group, "difference_", 2)
        key = tuple(group[name] for name in _NAMES[1:])
        is_best = failed == 0 and group["mean_tail_position"] == best.get(key)
        line["best"] = "*" if is_best else ""
        lines.append(line)
    return lines


def _interval(group: Mapping[str, Any], of: str, digits: int) -> str:
    low, high = group[f"{of}low_tail_position"], group[f"{of}high_tail_position"]
    return "" if math.isnan(low) else f" [{low:.{digits}g}, {high:.{digits}g}]"


def error_text(value: float) -> str:
    """Write a number for a table that is read; an infinite error is that of a lost vehicle."""
    return "lost" if math.isinf(value) else number_text(value)


def _csv(table: Sequence[Mapping[str, Any]]) -> List[List[Any]]:
    return [list(table[0]), *(list(row.values()) for row in table)]


def _timing(evaluation: Evaluation, plan: Plan) -> List[List[Any]]:
    rows: List[List[Any]] = [[*_NAMES, "seed", "seconds", "real_time_factor", "updates"]]
    flights = zip(evaluation.table, evaluation.seconds, evaluation.updates)
    for row, seconds, updates in flights:
        names = [row[name] for name in (*_NAMES, "seed")]
        rows.append([*names, seconds, plan.duration / seconds, updates])
    return rows


def _content(evaluation: Evaluation, flight: Mapping[str, str]) -> Dict[str, Any]:
    return {
        "flight": dict(flight),
        "units": UNITS,
        "meanings": MEANINGS,
        "confidence": CONFIDENCE,
        "flights": [
            {**row, "warnings": list(warned)}
            for row, warned in zip(evaluation.table, evaluation.warnings)
        ],
        "combinations": evaluation.groups,
        "margins": [
            {name: value if value != math.inf else "lost" for name, value in row.items()}
            for row in evaluation.margins
        ],
        "poles": [
            {
                **row,
                "poles": [[pole.real, pole.imag] for pole in row["poles"]],
                "zero": None if math.isinf(row["zero"]) else row["zero"],
            }
            for row in evaluation.poles
        ],
    }


def _page(
    evaluation: Evaluation, flight: Mapping[str, str], images: Mapping[str, bytes]
) -> Dict[str, Any]:
    failures = [
        {
            "label": f"{label(row, evaluation.table)}, {row['reference']}, seed {row['seed']}",
            "failure": row["failure"],
        }
        for row in evaluation.table
        if row["failure"]
    ]
    return {
        "title": "Evaluation of controllers",
        "summary": summary(evaluation),
        "flight": flight,
        "lines": rows_to_read(evaluation)[:ROWS_OF_PAGE],
        "more": max(0, len(evaluation.groups) - ROWS_OF_PAGE),
        "failures": failures[:ROWS_OF_PAGE],
        "confidence": f"{100 * CONFIDENCE:g} %",
        "meanings": MEANINGS,
        "units": UNITS,
        "margins": [
            {
                name: value if isinstance(value, str) else error_text(value)
                for name, value in row.items()
            }
            for row in evaluation.margins
        ],
        "poles": [
            {
                **row,
                "poles": poles_text(row),
                "zero": "" if math.isinf(row["zero"]) else f"{row['zero']:.3g}",
            }
            for row in evaluation.poles
        ],
        "pictures": [{"name": name, "data": data} for name, data in images.items()],
    }
