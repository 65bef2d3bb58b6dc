"""What a sweep leaves behind besides its rows: sums, pictures, page."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional

import numpy as np

from ... import __version__
from ..._core import InputError
from ..folder import remove_pictures, save_pictures
from ..table import json_bytes, number_text, save, setting_texts
from . import pictures
from .again import command
from .plan import AnyPlan
from .sensitivity import combinations, sensitivities
from .sweep import TABLE

FILES = (TABLE, "sweep.json", "report.html")

WORST = 10
"""Rows that are told with their command line, and as many of those that failed."""

Columns = Mapping[str, np.ndarray]


def main_measure(plan: AnyPlan, asked: Optional[str] = None) -> str:
    """Choose what is drawn, and what "worst" means; raises `InputError` if it is no measure."""
    if asked is not None and asked not in plan.measures:
        raise InputError(f"there is no measure '{asked}'; give one of {', '.join(plan.measures)}")
    return asked or plan.measures[0]


def write(plan: AnyPlan, columns: Columns, folder: Path, measure: str, plots: bool) -> List[Path]:
    """Write `FILES` but the table, which is there, and pictures.

    Parameters
    ----------
    plan, columns
        What was flown, and what came of it.
    folder
        Where to.
    measure
        What is drawn, and what "worst" means.
    plots
        Whether to draw.
    """
    from ...report.page import write_page  # not every command should pay for jinja2

    found = sensitivities(plan, columns)
    content = {
        "quadcore": __version__,
        "numpy": np.__version__,
        "plan": plan.told(),
        "units": plan.units,
        "meanings": plan.meanings,
        "rows": len(columns["row"]),
        "summary": summaries(plan, columns),
        "sensitivities": found,
        "measure": measure,
        "worst": worst(plan, columns, measure),
    }
    remove_pictures(folder, "sweep.json", pictures.NAMES.__contains__)
    written = save(folder, {"sweep.json": json_bytes(content)})
    images = pictures.draw(plan, columns, found, measure) if plots else {}
    written += save_pictures(folder, "sweep.json", content, images)
    page = folder / "report.html"
    write_page(
        page,
        "sweep.html",
        title="Sweep",
        summary=told(plan, columns),
        flight=setting_texts(plan.told(), 20),
        lines=[_line(row) for row in summaries(plan, columns)],
        sensitivities=[_line(row) for row in found if row["measure"] == measure],
        measure=measure,
        worst=[_line(row) for row in worst(plan, columns, measure)],
        meanings=plan.meanings,
        units=plan.units,
        pictures=[{"name": name, "data": data} for name, data in images.items()],
    )
    return [folder / TABLE, *written, page]


def told(plan: AnyPlan, columns: Columns) -> str:
    """Say how many flew, in one line."""
    failed = int((columns["failure"] != "").sum())
    there = len(columns["row"])
    missing = len(plan) - there
    text = f"{len(plan)} rows: {there - failed} flown, {failed} failed"
    return text + (f", {missing} not flown" if missing else "")


def summaries(plan: AnyPlan, columns: Columns) -> List[Dict[str, Any]]:
    """Tell quantiles of each measure for each combination of what flies."""
    rows = []
    for names, chosen in combinations(columns):
        failed = int((columns["failure"][chosen] != "").sum())
        for measure in plan.measures:
            values = columns[measure][chosen].astype(float)
            values = values[np.isfinite(values)]
            if len(values):
                low, middle, high = np.quantile(values, [0.05, 0.5, 0.95]).tolist()
                row = {**names, "rows": len(chosen), "failed": failed, "measure": measure}
                row.update(zip(("median", "low", "high"), (middle, low, high)))
                rows.append({**row, "min": float(values.min()), "max": float(values.max())})
    return rows


def worst(plan: AnyPlan, columns: Columns, measure: str) -> List[Dict[str, Any]]:
    """Tell rows that failed, and those with the largest measure, with what flies them again."""
    values = columns[measure].astype(float)
    failed = np.flatnonzero(columns["failure"] != "")[:WORST]
    order = np.argsort(-np.where(np.isfinite(values), values, -np.inf), kind="stable")
    largest = [i for i in order[:WORST] if np.isfinite(values[i])]
    return [
        {
            "row": int(columns["row"][i]),
            "failure": str(columns["failure"][i]),
            measure: float(values[i]),
            "again": command(plan, int(columns["row"][i])),
        }
        for i in [*failed, *largest]
    ]


def _line(row: Mapping[str, Any]) -> Dict[str, str]:
    """Write a row for people."""
    return {
        name: number_text(value)
        if isinstance(value, float)
        else str("" if value is None else value)
        for name, value in row.items()
    }
