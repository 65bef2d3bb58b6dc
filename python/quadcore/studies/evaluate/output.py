"""What an evaluation leaves behind: tables, pictures, page."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence

import numpy as np

from ... import __version__
from ...report.thinning import pick_evenly
from ..folder import remove_pictures, save_pictures
from ..measures import MEANINGS, UNITS
from ..table import (
    NOT_FLOWN,
    csv_bytes,
    flown_and_failed,
    json_bytes,
    save,
    setting_texts,
)
from .evaluate import Evaluation
from .intervals import CONFIDENCE
from .losses import losses
from .pictures import by_reference, draw, is_picture, label
from .plan import Plan
from .poles import gains_of
from .poles import text as poles_text
from .robustness import BOX, ENDS, margin_text
from .shown_rows import NAMES, columns_to_read, error_text, rows_to_read

ROWS_OF_PAGE = 200

_PLAYERS, _PLAYED = 4, 8  # references, flights of each
_SWITCHES = ("feed_forward", "drag", "gyroscopic", "flat_rates", "integral", "lead")


FILES = ("table.csv", "evaluation.json", "timing.csv", "report.html")


def write(evaluation: Evaluation, plan: Plan, folder: Path, plots: bool) -> List[Path]:
    """Write `FILES` and pictures, and remove the pictures of an earlier evaluation.

    Parameters
    ----------
    evaluation, plan
        What was flown.
    folder
        Where to.
    plots
        Whether to draw.
    """
    from ...report.page import write_page  # not every command should pay for jinja2

    remove_pictures(folder, "evaluation.json", is_picture)
    # What was flown comes first: pictures can fail, and take their time.
    content = _content(evaluation, plan)
    tables = {
        "table.csv": csv_bytes(_csv(evaluation.table)),
        "evaluation.json": json_bytes(content),
        "timing.csv": csv_bytes(_timing(evaluation, plan)),
    }
    written = save(folder, tables)
    images = draw(evaluation, plan.events()) if plots else {}
    written += save_pictures(folder, "evaluation.json", content, images)
    page = folder / "report.html"
    players = _players(evaluation) if plots else []
    values = _page(evaluation, plan, images)
    write_page(page, "evaluate.html", **values, players=players, known=_known(plan))
    return [*written, page]


def _players(evaluation: Evaluation) -> List[Dict[str, Any]]:
    """Make a player of the flights along each of the first references."""
    from ...report.player import PlayerFlight, fragment

    players = []
    for reference, flights in list(by_reference(evaluation).items())[:_PLAYERS]:
        picked = [flights[i] for i in pick_evenly(len(flights), _PLAYED)]
        shown = [
            PlayerFlight(named, outcome.log, outcome.rotors)
            for named, outcome in picked
            if outcome.log is not None
        ]
        players.append({"reference": reference, "player": fragment(shown)})
    return players


def _known(plan: Plan) -> List[Dict[str, str]]:
    """Tell what each law of quadcore flew with: only alike can be compared."""
    rows = []
    for names, flight in plan.controllers_flown():
        gains = gains_of(flight.controller)
        shown = {part: f"{gains[part]:g}" if part in gains else "" for part in _SWITCHES}
        timing = {part: f"{getattr(flight.controller, part):g}" for part in ("rate", "delay")}
        rows.append({**names, **timing, **shown})
    return rows


def _laws(plan: Plan) -> List[Dict[str, Any]]:
    """Tell all that a law of quadcore flew with."""
    return [
        {
            **names,
            "law": flight.controller.name,
            "rate": float(flight.controller.rate),
            "delay": float(flight.controller.delay),
            "spins": flight.controller.spins,
            "parameters": gains_of(flight.controller),
        }
        for names, flight in plan.controllers_flown()
    ]


def summary(evaluation: Evaluation) -> str:
    """How many flew, in one line."""
    return flown_and_failed([row["failure"] for row in evaluation.table])


def causes(evaluation: Evaluation) -> List[str]:
    """Say why cascades do not hold the vehicle, a line for each axis that is unstable."""
    return [
        f"{row['controller']} ({row['engine']}), {row['axis']}: pole at {poles_text(row, 1)} 1/s"
        + (f"; cause: {row['because']}" if row["because"] else "")
        for row in evaluation.poles
        if not row["stable"]
    ]


def _csv(table: Sequence[Mapping[str, Any]]) -> List[List[Any]]:
    return [list(table[0]), *(list(row.values()) for row in table)]


def _timing(evaluation: Evaluation, plan: Plan) -> List[List[Any]]:
    measured = ("seconds", "real_time_factor", "updates", "update_median", "update_p99")
    rows: List[List[Any]] = [[*NAMES, "seed", *measured]]
    for row, outcome in zip(evaluation.table, evaluation.outcomes):
        names = [row[name] for name in (*NAMES, "seed")]
        factor = plan.options.duration / outcome.seconds
        calls = outcome.updates, outcome.call, outcome.slow_call
        rows.append([*names, outcome.seconds, factor, *calls])
    return rows


def _content(evaluation: Evaluation, plan: Plan) -> Dict[str, Any]:
    return {
        "quadcore": __version__,
        "numpy": np.__version__,
        "plan": plan.told(),
        "laws": _laws(plan),
        "units": UNITS,
        "meanings": MEANINGS,
        "confidence": CONFIDENCE,
        "flights": [
            {
                **row,
                "rate": outcome.rate,
                "delay": outcome.delay,
                "updates": outcome.updates,
                "warnings": list(outcome.warnings),
            }
            for row, outcome in zip(evaluation.table, evaluation.outcomes)
        ],
        "losses": [_finite(row) for row in losses(evaluation.groups)],
        "combinations": [_finite(group) for group in evaluation.groups],
        "margins": [_finite(row) for row in evaluation.margins],
        "searched": {**ENDS, "box": BOX},
        "unsearched": plan.unsearched if evaluation.margins else "",
        "poles": [
            {
                **row,
                "poles": [[pole.real, pole.imag] for pole in row["poles"]],
                "zero": None if math.isinf(row["zero"]) else row["zero"],
            }
            for row in evaluation.poles
        ],
    }


def _finite(row: Mapping[str, Any]) -> Dict[str, Any]:
    """Write an infinite error as what it means."""
    return {name: "lost" if value == math.inf else value for name, value in row.items()}


def margins_to_read(evaluation: Evaluation) -> List[Dict[str, str]]:
    """Rows of the margins for people."""
    return [
        {
            name: value if isinstance(value, str) else margin_text(row, name, error_text)
            for name, value in row.items()
        }
        for row in evaluation.margins
    ]


def _page(evaluation: Evaluation, plan: Plan, images: Mapping[str, bytes]) -> Dict[str, Any]:
    failures = [
        {
            "label": f"{label(row, evaluation.table)}, {row['reference']}, seed {row['seed']}",
            "failure": row["failure"],
        }
        for row in evaluation.table
        if row["failure"] not in ("", NOT_FLOWN)
    ]
    lines = rows_to_read(evaluation)
    return {
        "title": "Evaluation of controllers",
        "summary": summary(evaluation),
        "flight": setting_texts(plan.told()),
        "shown": columns_to_read(lines),
        "lines": lines[:ROWS_OF_PAGE],
        "more": max(0, len(evaluation.groups) - ROWS_OF_PAGE),
        "failures": failures[:ROWS_OF_PAGE],
        "confidence": f"{100 * CONFIDENCE:g} %",
        "meanings": MEANINGS,
        "units": UNITS,
        "losses": [
            {
                name: value if isinstance(value, str) else error_text(value)
                for name, value in row.items()
            }
            for row in losses(evaluation.groups)
        ],
        "margins": margins_to_read(evaluation),
        "unsearched": plan.unsearched,
        "causes": causes(evaluation),
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
