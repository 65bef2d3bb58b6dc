"""Files of a benchmark: results, record and page."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List

from ...support.output_files import encode_text
from ..evaluate.intervals import CONFIDENCE
from ..evaluate.output import ROWS_OF_PAGE
from ..evaluate.overview import make_overview
from ..evaluate.paper_tables import make_latex
from ..evaluate.ranks import describe_ranks, rank_controllers
from ..evaluate.step_error import measure_step_error
from ..table import NOT_FLOWN, count_outcomes, make_csv, make_json, save_files
from .flights import Benchmark
from .record import make_record
from .scores import DIGITS, make_cells, make_score_table

FILES = (
    "results.csv",
    "flights.csv",
    "scores.csv",
    "comparison.tex",
    "benchmark.json",
    "report.html",
)


def write(found: Benchmark, folder: Path) -> List[Path]:
    """Write `FILES` into an existing folder."""
    from ...report.page import write_page  # jinja2 is slow to import

    record = make_record(found)
    rows = [list(found.table[0]), *(list(row.values()) for row in found.table)]
    content = {**record, "scores": [_make_plain(score) for score in found.scores]}
    written = save_files(
        folder,
        {
            "results.csv": make_results(found),
            "flights.csv": make_csv(rows),
            "scores.csv": make_csv(_list_scores(found)),
            "comparison.tex": encode_text(make_latex(found.groups)),
            "benchmark.json": make_json(content),
        },
    )
    page = folder / "report.html"
    write_page(page, "benchmark.html", **_make_page_values(found, record))
    return [*written, page]


def make_results(found: Benchmark) -> bytes:
    """Write a row of results for each combination, with a fixed number of digits."""
    rows = make_cells(found.groups)
    written = [
        [_round(value) if isinstance(value, float) else value for value in row.values()]
        for row in rows
    ]
    return make_csv([list(rows[0]), *written])


def list_results_notes(found: Benchmark) -> List[str]:
    """Describe the limitations of the results and the ranks of the controllers, one line each."""
    notes = [] if found.is_complete else [_describe_missing(found)]
    return notes + describe_ranks(rank_controllers(found.groups), CONFIDENCE)


def summarise(found: Benchmark) -> str:
    """Return the numbers of successful and failed flights in one line."""
    return count_outcomes([row["failure"] for row in found.table])


def _describe_missing(found: Benchmark) -> str:
    left = sum(1 for row in found.table if row["failure"] == NOT_FLOWN)
    which = (
        f"{left} flights are missing" if left else "not all vehicles and categories are selected"
    )
    return f"This is a part of {found.definition.version}: {which}."


def _describe_step_error(found: Benchmark) -> List[str]:
    """Describe the numerical error of the first flight; empty if flights are missing."""
    if any(row["failure"] == NOT_FLOWN for row in found.table):
        return []
    error = measure_step_error(found.parts[0].plan)
    return [] if error is None else [error.describe()]


def _round(value: float) -> Any:
    return value if math.isnan(value) else f"{value:.{DIGITS}g}"


def _make_plain(score: Any) -> Dict[str, Any]:
    return {**score._asdict(), "error": score.error if math.isfinite(score.error) else None}


def _list_scores(found: Benchmark) -> List[List[Any]]:
    categories, rows = make_score_table(found.scores)
    return [["controller", *categories], *([name, *cells] for name, cells in rows)]


def _make_page_values(found: Benchmark, record: Dict[str, Any]) -> Dict[str, Any]:
    categories, rows = make_score_table(found.scores)
    failures = [row for row in found.table if row["failure"] not in ("", NOT_FLOWN)]
    return {
        "title": f"Benchmark of controllers, {found.definition.version}",
        "summary": summarise(found),
        "categories": categories,
        "scores": rows,
        "notes": [*list_results_notes(found), *_describe_step_error(found)],
        "overview": make_overview(found.groups),
        "failures": failures[:ROWS_OF_PAGE],
        "hidden_failures": max(0, len(failures) - ROWS_OF_PAGE),
        "record": record,
    }
