"""Files of an evaluation: tables, plots, page."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence

import numpy as np

from ... import __version__
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
from .plan import Plan
from .plots import draw, group_flights, is_plot, make_label, name_group
from .poles import gains_of
from .poles import text as poles_text
from .robustness import BOX, ENDS, margin_text
from .shown_rows import NAMES, columns_to_read, error_text, rows_to_read

ROWS_OF_PAGE = 200

_SWITCHES = ("feed_forward", "drag", "gyroscopic", "flat_rates", "integral", "lead")


FILES = ("table.csv", "evaluation.json", "timing.csv", "report.html")


def write(evaluation: Evaluation, plan: Plan, folder: Path, plots: bool) -> List[Path]:
    """Write `FILES` and plots, and remove the plots of an earlier evaluation.

    Parameters
    ----------
    evaluation, plan
        Results and their plan.
    folder
        Existing folder.
    plots
        Whether to draw.
    """
    from ...report.page import write_page  # jinja2 is slow to import

    remove_pictures(folder, "evaluation.json", is_plot)
    # Results first: drawing is slow and can fail.
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
    animations = _make_animations(evaluation) if plots else []
    values = _page_values(evaluation, plan, images)
    settings = _list_settings(plan)
    write_page(page, "evaluate.html", **values, animations=animations, settings=settings)
    return [*written, page]


def _make_animations(evaluation: Evaluation) -> List[Dict[str, Any]]:
    """Make an animation of the flights along each reference in each scenario."""
    from ...report.player import PlayerFlight, make_section

    return [
        {
            "name": name_group(evaluation, reference, scenario),
            "player": make_section(
                [
                    PlayerFlight(label, outcome.log, outcome.rotors)
                    for label, outcome in flights
                    if outcome.log is not None
                ]
            ),
        }
        for (reference, scenario), flights in group_flights(evaluation).items()
    ]


def _describe_omitted_flights(evaluation: Evaluation) -> str:
    """State how many combinations the plots and animations show, unless they show all."""
    shown, count = len(evaluation.drawn), len(evaluation.groups)
    if shown in (0, count):
        return ""
    return f"Plots and animations show {shown} of {count} combinations."


def _list_settings(plan: Plan) -> List[Dict[str, str]]:
    """List the settings of each built-in controller for the page."""
    rows = []
    for names, flight in plan.controllers_flown():
        gains = gains_of(flight.controller)
        shown = {part: f"{gains[part]:g}" if part in gains else "" for part in _SWITCHES}
        timing = {part: f"{getattr(flight.controller, part):g}" for part in ("rate", "delay")}
        rows.append({**names, **timing, **shown})
    return rows


def _list_controllers(plan: Plan) -> List[Dict[str, Any]]:
    """List all parameters of each built-in controller."""
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


def summarise(evaluation: Evaluation) -> str:
    """Return the numbers of successful and failed flights in one line."""
    return flown_and_failed([row["failure"] for row in evaluation.table])


def list_unstable_axes(evaluation: Evaluation) -> List[str]:
    """List the unstable axes of cascaded controllers with pole and cause."""
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
        "laws": _list_controllers(plan),
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
    """Replace infinite errors, which JSON cannot represent."""
    return {name: "lost" if value == math.inf else value for name, value in row.items()}


def format_margins(evaluation: Evaluation) -> List[Dict[str, str]]:
    """Format the rows of the margins for the terminal and the page."""
    return [
        {
            name: value if isinstance(value, str) else margin_text(row, name, error_text)
            for name, value in row.items()
        }
        for row in evaluation.margins
    ]


def _page_values(evaluation: Evaluation, plan: Plan, images: Mapping[str, bytes]) -> Dict[str, Any]:
    failures = [
        {
            "label": f"{make_label(row, evaluation.table)}, seed {row['seed']}",
            "failure": row["failure"],
        }
        for row in evaluation.table
        if row["failure"] not in ("", NOT_FLOWN)
    ]
    lines = rows_to_read(evaluation)
    return {
        "title": "Evaluation of controllers",
        "summary": summarise(evaluation),
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
        "margins": format_margins(evaluation),
        "omitted_margins": plan.unsearched,
        "omitted_flights": _describe_omitted_flights(evaluation),
        "causes": list_unstable_axes(evaluation),
        "poles": [
            {
                **row,
                "poles": poles_text(row),
                "zero": "" if math.isinf(row["zero"]) else f"{row['zero']:.3g}",
            }
            for row in evaluation.poles
        ],
        "plots": [{"name": name, "data": data} for name, data in images.items()],
    }
