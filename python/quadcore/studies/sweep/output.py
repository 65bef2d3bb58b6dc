"""Files of a sweep in addition to its rows: summary, plots and page."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence

import numpy as np

from ... import __version__
from ..._core import InputError
from ..figures import draw_figures
from ..flight_folder import DOCUMENT, remove_flights
from ..output_folder import remove_plots, save_plots
from ..step_error import compute_step_error
from ..table import (
    describe_conditions,
    format_number,
    format_settings,
    make_json,
    save_files,
)
from . import plots as sweep_plots
from .plan import AnyPlan
from .repeat_command import write_command
from .sensitivity import compute_sensitivities, list_combinations
from .sweep import PARQUET, TABLE
from .watched_rows import WatchedRow, make_player, watch_rows, write_watched_rows

FILES = (TABLE, "sweep.json", DOCUMENT, "report.html")

WORST = 10
"""Number of rows with the highest metric, and of failed rows, listed with their command."""

Columns = Mapping[str, np.ndarray]


def choose_metric(plan: AnyPlan, asked: Optional[str] = None) -> str:
    """Return the metric to draw and rank; raise `InputError` if it does not exist."""
    if asked is not None and asked not in plan.measures:
        raise InputError(f"metric '{asked}' does not exist. Use one of {', '.join(plan.measures)}.")
    return asked or plan.measures[0]


def write(
    plan: AnyPlan,
    columns: Columns,
    folder: Path,
    measure: str,
    plots: bool,
    processes: Optional[int] = None,
) -> List[Path]:
    """Write `FILES`, except the table, which already exists, and the plots.

    Parameters
    ----------
    plan, columns
        Plan and results.
    folder
        Existing folder.
    measure
        Metric to draw and rank.
    plots
        Whether to draw plots.
    processes
        Number of processes that draw. None: one per usable core.
    """
    from ...report.page import write_page  # jinja2 is slow to import

    found = compute_sensitivities(plan, columns)
    content = {
        "quadcore": __version__,
        "numpy": np.__version__,
        "plan": plan.describe(),
        "units": plan.units,
        "meanings": plan.meanings,
        "rows": len(columns["row"]),
        "summary": summarise_rows(plan, columns),
        "sensitivities": found,
        "measure": measure,
        "worst": list_worst(plan, columns, measure),
    }
    remove_plots(folder, "sweep.json", sweep_plots.NAMES.__contains__)
    remove_flights(folder)
    written = save_files(folder, {"sweep.json": make_json(content)})
    watched = watch_rows(plan, columns, measure)
    written += write_watched_rows(watched, folder)
    figures = sweep_plots.list_figures(plan, columns, found, measure) if plots else {}
    images = draw_figures(figures, processes)
    written += save_plots(folder, "sweep.json", content, images)
    page = folder / "report.html"
    write_page(
        page,
        "sweep.html",
        title="Sweep",
        conditions=describe_conditions(plan.describe()),
        summary=count_rows(plan, columns),
        flight=format_settings(plan.describe(), 20),
        lines=[_format(row) for row in summarise_rows(plan, columns)],
        sensitivities=_drop_repeated([_format(row) for row in found if row["measure"] == measure]),
        measure=measure,
        player=make_player(watched) if plots else "",
        step_error=_describe_step_error(watched),
        worst=[_format(row) for row in list_worst(plan, columns, measure)],
        meanings=plan.meanings,
        units=plan.units,
        plots=[{"name": name, "data": data} for name, data in images.items()],
    )
    return [folder / TABLE, *written, page]


def _describe_step_error(watched: Sequence[WatchedRow]) -> str:
    """Describe the numerical error of the plant in the first of these rows; "" without rows."""
    for row in watched:
        flight = row.flight
        error = compute_step_error(row.name, flight.plan, flight.limit)
        return "" if error is None else error.describe()
    return ""


def remove_sweep(folder: Path) -> None:
    """Remove the files of an earlier complete sweep; an incomplete sweep is kept."""
    if not (folder / "sweep.json").exists():
        return
    remove_plots(folder, "sweep.json", sweep_plots.NAMES.__contains__)
    remove_flights(folder)
    for name in (*FILES, PARQUET):
        with contextlib.suppress(OSError):
            (folder / name).unlink()


def count_rows(plan: AnyPlan, columns: Columns) -> str:
    """Return the numbers of successful and failed rows in one line."""
    failed = int((columns["failure"] != "").sum())
    there = len(columns["row"])
    missing = len(plan) - there
    text = f"{len(plan)} rows: {there - failed} flown, {failed} failed"
    return text + (f", {missing} not flown" if missing else "")


def summarise_rows(plan: AnyPlan, columns: Columns) -> List[Dict[str, Any]]:
    """Return quantiles of each metric for each combination (see `list_combinations`)."""
    rows = []
    for names, chosen in list_combinations(columns):
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


def list_worst(plan: AnyPlan, columns: Columns, measure: str) -> List[Dict[str, Any]]:
    """List failed rows and the rows with the highest metric, with the command to repeat them."""
    values = columns[measure].astype(float)
    failed = np.flatnonzero(columns["failure"] != "")[:WORST]
    order = np.argsort(-np.where(np.isfinite(values), values, -np.inf), kind="stable")
    largest = [i for i in order[:WORST] if np.isfinite(values[i])]
    return [
        {
            "row": int(columns["row"][i]),
            "failure": str(columns["failure"][i]),
            measure: float(values[i]),
            "again": write_command(plan, int(columns["row"][i])),
        }
        for i in [*failed, *largest]
    ]


def _drop_repeated(rows: Sequence[Dict[str, str]]) -> List[Dict[str, str]]:
    """Drop the leading columns that have the same value in all rows."""
    if not rows:
        return []
    names = list(rows[0])
    context = names[: names.index("axis")]
    same = {name for name in context if len({row[name] for row in rows}) == 1}
    return [{name: text for name, text in row.items() if name not in same} for row in rows]


def _format(row: Mapping[str, Any]) -> Dict[str, str]:
    """Format the values of a row."""
    return {
        name: format_number(value)
        if isinstance(value, float)
        else str("" if value is None else value)
        for name, value in row.items()
    }
