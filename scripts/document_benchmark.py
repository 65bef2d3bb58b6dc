#!/usr/bin/env python3
"""Run the benchmark with all built-in controllers; keep its results and write their table.

The results go to config/benchmark/VERSION/results/built_in.csv, the table of scores into
docs/benchmark.md. ``scripts/document`` runs it; it takes some minutes.
"""

from __future__ import annotations

import re
from pathlib import Path

from markdown_table import table

import quadcore as qc
from quadcore.studies.benchmark.output import make_results
from quadcore.studies.benchmark.scores import make_score_table

PAGE = Path(__file__).resolve().parents[1] / "docs" / "benchmark.md"


def main() -> None:
    """Run it, and write both files."""
    found = qc.benchmark()
    results = found.definition.results
    results.parent.mkdir(exist_ok=True)
    results.write_bytes(make_results(found))
    categories, rows = make_score_table(found.scores)
    written = table(["controller", *categories], [[f"`{name}`", *cells] for name, cells in rows])
    text = PAGE.read_text(encoding="utf-8")
    text = re.sub(r"\| controller \| slow.*?\n(?!\|)", lambda _: written, text, flags=re.DOTALL)
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
