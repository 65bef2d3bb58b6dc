"""Files of an evaluation: tables, plots and page."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List, Mapping, Sequence

import numpy as np

from ... import __version__
from ...report.drawing import Drawing
from ...support.output_files import encode_text
from ..figures import draw_figures
from ..flight_folder import DOCUMENT, remove_flights
from ..output_folder import remove_plots, save_plots
from ..table import (
    NOT_FLOWN,
    count_outcomes,
    describe_conditions,
    format_settings,
    make_csv,
    make_json,
    save_files,
)
from .animations import make_animations, write_drawn_flights
from .best_controllers import describe_seeds
from .computation_times import summarise_computation_times
from .evaluate import Evaluation
from .failure_causes import explain_failures
from .intervals import CONFIDENCE
from .loop_table import choose_headings, format_loops, make_plain
from .margins import BOX, ENDS, format_margin
from .overview import describe_best, make_overview
from .paper_tables import make_latex, make_rows
from .plan import Plan
from .plots import group_flights, is_plot, list_figures, make_label, name_group
from .poles import format_poles as poles_text
from .poles import read_gains
from .ranks import describe_ranks, rank_controllers
from .scenario_effects import compute_scenario_effects
from .step_error import measure_step_error
from .summary_table import NAMES, choose_columns, format_error, format_rows

ROWS_OF_PAGE = 200

_SWITCHES = ("feed_forward", "drag", "gyroscopic", "flat_rates", "integral", "lead")


FILES = (
    "table.csv", "evaluation.json", "timing.csv", "comparison.csv", "comparison.tex", DOCUMENT,
    "report.html",
)  # fmt: skip


def write(evaluation: Evaluation, plan: Plan, folder: Path, plots: bool) -> List[Path]:
    """Write `FILES` and plots, and remove the plots of an earlier evaluation.

    Parameters
    ----------
    evaluation, plan
        Results, and the plan of the flights.
    folder
        Existing folder.
    plots
        Whether to draw plots.
    """
    from ...report.page import write_page  # jinja2 is slow to import

    remove_plots(folder, "evaluation.json", is_plot)
    remove_flights(folder)
    # The tables come first, because additional flights and drawing are slow and can fail.
    content = {**_make_content(evaluation, plan), "step_error": None}
    tables = {
        "table.csv": make_csv(_table_rows(evaluation.table)),
        "evaluation.json": make_json(content),
        "timing.csv": make_csv(_timing_rows(evaluation, plan)),
        "comparison.csv": make_csv(make_rows(evaluation.groups, evaluation.units)),
        "comparison.tex": encode_text(make_latex(evaluation.groups)),
    }
    written = save_files(folder, tables)
    written += write_drawn_flights(evaluation, plan, folder)
    is_whole = all(row["failure"] != NOT_FLOWN for row in evaluation.table)
    step_error = measure_step_error(plan) if is_whole else None
    content["step_error"] = None if step_error is None else step_error._asdict()
    figures = list_figures(evaluation, plan.list_events()) if plots else {}
    images = draw_figures(figures, plan.options.processes)
    written += save_plots(folder, "evaluation.json", content, images)
    page = folder / "report.html"
    animations = make_animations(evaluation, plan) if plots else []
    values = _page_values(evaluation, plan, images)
    values["notes"] += explain_failures(evaluation, plan)
    if step_error is not None:
        values["notes"].append(step_error.describe())
    settings = _list_settings(plan)
    write_page(page, "evaluate.html", **values, animations=animations, settings=settings)
    return [*written, page]


def _describe_omitted_flights(evaluation: Evaluation) -> str:
    """Describe which plots are omitted; "" if every reference and scenario is shown."""
    shown = group_flights(evaluation)
    every = dict.fromkeys((row["reference"], row["scenario"]) for row in evaluation.table)
    missing = [name_group(evaluation, *pair) for pair in every if pair not in shown]
    if not shown or not missing:
        return ""
    return (
        f"Plots and animations show {len(shown)} of {len(every)} combinations of reference and "
        f"scenario, each with all controllers. Omitted: {'; '.join(missing)}."
    )


def _list_settings(plan: Plan) -> List[Dict[str, str]]:
    """List the settings of each built-in controller for the page."""
    rows = []
    for names, flight in plan.list_built_in_flights():
        gains = read_gains(flight.controller)
        shown = {part: f"{gains[part]:g}" if part in gains else "" for part in _SWITCHES}
        timing = {part: f"{getattr(flight.controller, part):g}" for part in ("rate", "delay")}
        rows.append({**names, **timing, **shown})
    return rows


def list_controllers(plan: Plan) -> List[Dict[str, Any]]:
    """List all parameters of each built-in controller."""
    return [
        {
            **names,
            "law": flight.controller.name,
            "rate": float(flight.controller.rate),
            "delay": float(flight.controller.delay),
            "spins": flight.controller.spins,
            "parameters": read_gains(flight.controller),
        }
        for names, flight in plan.list_built_in_flights()
    ]


def summarise(evaluation: Evaluation) -> str:
    """Return the numbers of successful and failed flights in one line."""
    return count_outcomes([row["failure"] for row in evaluation.table])


def list_notes(evaluation: Evaluation) -> List[str]:
    """Describe the limitations of the seeds and the ranks of the controllers, one line each."""
    ranks = describe_ranks(rank_controllers(evaluation.groups), CONFIDENCE)
    return [*describe_seeds(evaluation.groups), *ranks]


def _describe_ranks(evaluation: Evaluation) -> Dict[str, Any]:
    """Return the ranks as plain values."""
    ranks = rank_controllers(evaluation.groups)
    pairs = [[*pair, p_value] for pair, p_value in ranks.post_hoc.items()]
    return {**ranks._asdict(), "post_hoc": pairs}


def list_unstable_axes(evaluation: Evaluation) -> List[str]:
    """List the unstable axes of cascaded controllers, with pole and cause."""
    return [
        f"{row['controller']} ({row['engine']}), {row['axis']}: pole at {poles_text(row, 1)} 1/s"
        + (f"; cause: {row['because']}" if row["because"] else "")
        for row in evaluation.poles
        if not row["stable"]
    ]


def _table_rows(table: Sequence[Mapping[str, Any]]) -> List[List[Any]]:
    return [list(table[0]), *(list(row.values()) for row in table)]


def _timing_rows(evaluation: Evaluation, plan: Plan) -> List[List[Any]]:
    measured = ("seconds", "real_time_factor", "updates", "update_median", "update_p99")
    rows: List[List[Any]] = [[*NAMES, "seed", *measured]]
    for row, outcome in zip(evaluation.table, evaluation.outcomes):
        names = [row[name] for name in (*NAMES, "seed")]
        factor = plan.options.duration / outcome.seconds
        calls = outcome.updates, outcome.call, outcome.slow_call
        rows.append([*names, outcome.seconds, factor, *calls])
    return rows


def _make_content(evaluation: Evaluation, plan: Plan) -> Dict[str, Any]:
    return {
        "quadcore": __version__,
        "numpy": np.__version__,
        "plan": plan.describe(),
        "laws": list_controllers(plan),
        "units": plan.criteria.units,
        "meanings": plan.criteria.meanings,
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
        "losses": [_replace_infinity(row) for row in compute_scenario_effects(evaluation.groups)],
        "ranks": _describe_ranks(evaluation),
        "combinations": [_replace_infinity(group) for group in evaluation.groups],
        "margins": [_replace_infinity(row) for row in evaluation.margins],
        "searched": {**ENDS, "box": BOX},
        "unsearched": plan.omitted_margins if evaluation.margins else "",
        **({"loops": list(map(make_plain, evaluation.loops))} if evaluation.loops else {}),
        "poles": [
            {
                **row,
                "poles": [[pole.real, pole.imag] for pole in row["poles"]],
                **{
                    name: row[name] if math.isfinite(row[name]) else None
                    for name in ("zero", "delay_margin")
                },
            }
            for row in evaluation.poles
        ],
    }


def _replace_infinity(row: Mapping[str, Any]) -> Dict[str, Any]:
    """Replace infinite errors, which JSON cannot represent."""
    return {name: "lost" if value == math.inf else value for name, value in row.items()}


def format_margins(evaluation: Evaluation) -> List[Dict[str, str]]:
    """Format the margins of each controller for the terminal and the page."""
    return [
        {
            name: value if isinstance(value, str) else format_margin(row, name, format_error)
            for name, value in row.items()
        }
        for row in evaluation.margins
    ]


def _page_values(
    evaluation: Evaluation, plan: Plan, images: Mapping[str, Drawing]
) -> Dict[str, Any]:
    failures = [
        {
            "label": f"{make_label(row, evaluation.table)}, seed {row['seed']}",
            "failure": row["failure"],
        }
        for row in evaluation.table
        if row["failure"] not in ("", NOT_FLOWN)
    ]
    lines = format_rows(evaluation)
    return {
        "title": plan.title,
        "summary": summarise(evaluation),
        "conditions": describe_conditions(plan.describe()),
        "verdicts": describe_best(evaluation.groups),
        "overview": make_overview(evaluation.groups),
        "flight": format_settings(plan.describe()),
        "shown": choose_columns(lines, evaluation.units),
        "lines": lines[:ROWS_OF_PAGE],
        "more": max(0, len(evaluation.groups) - ROWS_OF_PAGE),
        "notes": [*plan.notes, *list_notes(evaluation)],
        "failures": failures[:ROWS_OF_PAGE],
        "confidence": f"{100 * CONFIDENCE:g} %",
        "meanings": plan.criteria.meanings,
        "units": plan.criteria.units,
        "losses": [
            {
                name: value if isinstance(value, str) else format_error(value)
                for name, value in row.items()
            }
            for row in compute_scenario_effects(evaluation.groups)
        ],
        "margins": format_margins(evaluation),
        "computation_times": summarise_computation_times(evaluation, plan),
        "loops": format_loops(evaluation.loops),
        "loop_headings": choose_headings(evaluation.loops),
        "omitted_margins": plan.omitted_margins,
        "omitted_flights": _describe_omitted_flights(evaluation),
        "causes": list_unstable_axes(evaluation),
        "poles": [
            {
                **row,
                "poles": poles_text(row),
                **{
                    name: f"{row[name]:.3g}" if math.isfinite(row[name]) else ""
                    for name in ("zero", "delay_margin")
                },
            }
            for row in evaluation.poles
        ],
        "plots": [{"name": name, "data": data} for name, data in images.items()],
    }
